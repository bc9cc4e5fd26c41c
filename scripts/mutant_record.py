"""The shipped record of mutants: each with what the first run that asked it found, so that a score
is that of mutants which nobody has mended anything for. Of scripts/mutate.
"""

import collections
import json
import time
from pathlib import Path

from mutant_trials import Judgement, Mutant, read_explained, score_interval
from mutants import ROOT, Unusable, write_at_once

RECORD = ROOT / "verification/faults/mutants.json"
ASKED = ("killed", "SURVIVED", "equivalent")


def key_of_row(row: dict) -> tuple[str, str, str]:
    return row["file"], row["before"], row["after"]


def read_record(path: Path = RECORD) -> list[dict]:
    try:
        return json.loads(path.read_text(encoding="utf-8"))["mutants"] if path.is_file() else []
    except (ValueError, KeyError) as error:
        raise Unusable(f"{path}: {error!r}") from error


def not_recorded(mutants: list[Mutant], rows: list[dict]) -> list[Mutant]:
    known = {key_of_row(row) for row in rows}
    return [one for one in mutants if (one.file, one.before, one.after) not in known]


def with_outcomes(
    rows: list[dict], room: str, judged: list[Judgement], seed: int, commit: str
) -> list[dict]:
    """The rows, and behind them those of the outcomes that are not among them."""
    known, today = {key_of_row(row) for row in rows}, time.strftime("%Y-%m-%d", time.gmtime())
    added = []
    for one in judged:
        mutant = one.mutant
        if one.outcome in ASKED and (mutant.file, mutant.before, mutant.after) not in known:
            added.append({
                "room": room, "file": mutant.file, "line": mutant.line, "before": mutant.before,
                "after": mutant.after, "outcome": one.outcome, "by": one.by or one.what,
                "seed": seed, "commit": commit, "date": today
            })
    return rows + added


def write_record(rows: list[dict], path: Path = RECORD) -> None:
    lines = [f" {json.dumps(row, ensure_ascii=False)}" for row in rows]
    write_at_once(path, '{"mutants": [\n' + ",\n".join(lines) + "\n]}\n")


def scores(rows: list[dict], explained: set[tuple[str, str, str]]) -> dict[str, dict]:
    """By room, and of all: how many were killed, survived, or are explained; the share of the first
    in the first two, and its interval."""
    counts: dict[str, collections.Counter] = collections.defaultdict(collections.Counter)
    for row in rows:
        outcome = "equivalent" if key_of_row(row) in explained else row["outcome"]
        for room in (row["room"], "all"):
            counts[room][outcome] += 1
    table = {}
    for room in sorted(counts, key=lambda name: (name == "all", name)):
        killed, survived = counts[room]["killed"], counts[room]["SURVIVED"]
        low, high = score_interval(killed, killed + survived)
        table[room] = {
            "killed": killed, "survived": survived, "equivalent": counts[room]["equivalent"],
            "score": killed / (killed + survived) if killed + survived else None,
            "low": low, "high": high
        }
    return table


def print_record() -> None:
    rows, explained = read_record(), read_explained()
    print(f"{'':32}{'killed':>9}{'survived':>10}{'equivalent':>12}{'score':>22}")
    for room, row in scores(rows, explained).items():
        share = "-"
        if row["score"] is not None:
            score, low, high = (100 * row[key] for key in ("score", "low", "high"))
            share = f"{score:.1f} ({low:.0f} to {high:.0f}) %"
        print(f"{room:32}{row['killed']:>9}{row['survived']:>10}{row['equivalent']:>12}{share:>22}")
    for row in rows:
        if row["outcome"] == "SURVIVED" and key_of_row(row) not in explained:
            print(f"{row['file']}:{row['line']} at {row['commit'][:8]}\n    - {row['before']}\n"
                  f"    + {row['after']}")
