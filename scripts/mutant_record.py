"""The shipped record of mutants: what is added to it, and which survivors are asked again. Of
scripts/mutate; reports/data/mutant_record.py says what it is.
"""

import json
import sys
import time
from pathlib import Path

from edits import Change
from mutant_questions import FOLDER
from mutant_trials import Judgement, Mutant, read_explained
from mutants import ROOT, write_at_once

sys.path.insert(0, str(ROOT / "reports"))
from data.mutant_record import (  # noqa: E402
    RECORD,
    Row,
    key_of_row,
    parts_of,
    read_rows,
)

ASKED = ("killed", "SURVIVED", "equivalent")
ASKED_LOG = FOLDER / "asked.jsonl"


def not_recorded(mutants: list[Mutant], rows: list[Row], commit: str) -> list[Mutant]:
    """Those that the sample of this commit does not have."""
    known = {key_of_row(row) for row in rows if row["commit"] == commit}
    return [one for one in mutants if (one.file, one.before, one.after) not in known]


def rows_of(room: str, judged: list[Judgement], seed: int, commit: str) -> list[Row]:
    """One row for each mutant that was asked; others are left out."""
    today = time.strftime("%Y-%m-%d", time.gmtime())
    return [
        {
            "room": room, "file": one.mutant.file, "line": one.mutant.line,
            "before": one.mutant.before, "after": one.mutant.after, "outcome": one.outcome,
            "by": one.by or one.what, "seed": seed, "commit": commit, "date": today
        }
        for one in judged if one.outcome in ASKED
    ]


def with_new(rows: list[Row], more: list[Row]) -> list[Row]:
    """The rows, and behind them those of mutants that the sample of their commit does not have."""
    known = {(*key_of_row(row), row["commit"]) for row in rows}
    added = []
    for row in more:
        if (key := (*key_of_row(row), row["commit"])) not in known:
            known.add(key)
            added.append(row)
    return rows + added


# ---- the log of all mutants that were asked in this tree -----------------------------------------


def log_asked(rows: list[Row], path: Path = ASKED_LOG) -> None:
    """Appends a line for each row; several runs of a campaign may append at once."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("a", encoding="utf-8") as log:
        log.write("".join(f"{json.dumps(row, ensure_ascii=False)}\n" for row in rows))


def read_asked(commit: str, path: Path = ASKED_LOG) -> list[Row]:
    """The rows of this commit. Skips lines that a killed run left unfinished."""
    rows = []
    for line in path.read_text(encoding="utf-8").splitlines() if path.is_file() else []:
        try:
            rows.append(json.loads(line))
        except ValueError:
            continue
    return [row for row in rows if row["commit"] == commit]


def write_record(rows: list[Row], path: Path = RECORD) -> None:
    lines = [f" {json.dumps(row, ensure_ascii=False)}" for row in rows]
    write_at_once(path, '{"mutants": [\n' + ",\n".join(lines) + "\n]}\n")


# ---- survivors, asked again ----------------------------------------------------------------------


def open_survivors(rows: list[Row], explained: set[tuple[str, str, str]]) -> list[Mutant]:
    """Those that nothing has noticed since and no sentence explains, as edits of the files of
    today; one whose line is gone cannot be asked."""
    found = []
    for number, row in enumerate(rows):
        is_open = row["outcome"] == "SURVIVED" and "noticed_by" not in row
        if is_open and key_of_row(row) not in explained:
            text = (ROOT / row["file"]).read_text(encoding="utf-8")
            place = nearest_line(text, row["before"], row["line"])
            if place is not None:
                line, at = place
                change = Change(at, row["before"], row["after"], "recorded")
                found.append(
                    Mutant(row["file"], number, change, line, row["before"], row["after"])
                )
    return found


def nearest_line(text: str, line: str, to: int) -> tuple[int, int] | None:
    """Number and place of the line that reads so, without its margin, next to the number `to`."""
    places, at = [], 0
    for number, each in enumerate(text.splitlines(keepends=True), start=1):
        if each.strip() == line:
            places.append((abs(number - to), number, at + len(each) - len(each.lstrip())))
        at += len(each)
    return min(places)[1:] if places else None


def with_noticed(rows: list[Row], judged: list[Judgement], commit: str) -> list[Row]:
    """The rows; those of mutants that are killed now say by what, and since when it is known."""
    noticed = {one.mutant.number: one for one in judged if one.outcome == "killed"}
    return [
        {**row, "noticed_by": noticed[k].by or noticed[k].what, "noticed_at": commit}
        if k in noticed else row for k, row in enumerate(rows)
    ]


# ---- what is said of it --------------------------------------------------------------------------


def print_record() -> None:
    """Sample by sample, the newest last, then the survivors of all."""
    rows, explained = read_rows(), read_explained()
    for title, sample in (
        (part.title, sample) for part in parts_of(rows, explained)
        for sample in [*part.earlier[::-1], part.newest]
    ):
        print(f"{title}: {sample.date}, {sample.commit[:10]}\n"
              f"{'':32}{'killed':>9}{'survived':>10}{'equivalent':>12}{'score':>22}{'open':>7}")
        for row in sample.scores:
            share = "-"
            if row.share is not None:
                share = f"{100 * row.share:.1f} ({100 * row.low:.0f} to {100 * row.high:.0f}) %"
            print(f"{row.room:32}{row.killed:>9}{row.survived:>10}{row.equivalent:>12}{share:>22}"
                  f"{row.survived - row.noticed_since:>7}")
    for row in rows:
        if row["outcome"] == "SURVIVED" and key_of_row(row) not in explained:
            since = f"\n    noticed since by {row['noticed_by']}" if "noticed_by" in row else ""
            print(f"{row['file']}:{row['line']} at {row['commit'][:8]}\n    - {row['before']}\n"
                  f"    + {row['after']}{since}")
