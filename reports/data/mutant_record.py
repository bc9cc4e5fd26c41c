"""Random slips and who noticed them, as `scripts/mutate --record` keeps them: each with what the
first run that asked it at a commit found, so that the score of a sample is that of slips for which
nobody has mended anything."""
from __future__ import annotations

import json
import math
import tomllib
from collections import Counter, defaultdict
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from data.unreadable import reading

FAULTS = Path(__file__).resolve().parents[2] / "verification" / "faults"
RECORD = FAULTS / "mutants.json"
EXPLAINED = FAULTS / "equivalent_mutants.toml"
EXPLAINED_ASKED = FAULTS / "explained_mutants.json"

Row = dict[str, Any]
Key = tuple[str, str, str]  # file, line, and what the line becomes


@dataclass
class Score:
    """What became of the mutants of one folder, or of all."""
    room: str
    killed: int
    survived: int
    equivalent: int
    noticed_since: int    # of those that survived
    share: float | None   # of the killed in those that are not equivalent; None of none
    low: float | None     # what 95 % of such samples leave possible
    high: float | None


@dataclass
class Sample:
    """The mutants that were drawn at one commit."""
    commit: str
    date: str              # of the latest
    scores: list[Score]    # by folder, of all last


@dataclass
class Part:
    """The samples of the method, or of what judges it."""
    title: str
    newest: Sample
    earlier: list[Sample]  # the latest first


@dataclass
class MutantRecord:
    """The record as a page shows it."""
    parts: list[Part]
    survivors: list[Row]   # of all samples, that are not explained
    explained: list[Row]   # with the reason
    all_explained: int     # edits with a reason, drawn or not
    explained_asked: list[Row]  # put to all checks and unit tests that reach them

    @property
    def explained_noticed(self) -> int:
        """Of those asked: their reasons were wrong, and are gone."""
        return sum(row["outcome"] == "killed" for row in self.explained_asked)

    @property
    def asked(self) -> int:
        """How many the newest samples have."""
        scores = [part.newest.scores[-1] for part in self.parts]
        return sum(row.killed + row.survived + row.equivalent for row in scores)


def key_of_row(row: Row) -> Key:
    """What tells a mutant from others."""
    return row["file"], row["before"], row["after"]


def read_rows(path: Path = RECORD) -> list[Row]:
    """The mutants of a record, none if there is no such file; Unreadable for another file."""
    if not path.is_file():
        return []
    with reading(path):
        rows: list[Row] = json.loads(path.read_text(encoding="utf-8"))["mutants"]
        return rows


def load_mutant_record(
    record: Path = RECORD, explained: Path = EXPLAINED, asked: Path = EXPLAINED_ASKED
) -> MutantRecord | None:
    """The record for a page; None of an empty one. Throws Unreadable if a file is damaged."""
    rows = read_rows(record)
    if not rows:
        return None
    with reading(explained):
        said = tomllib.loads(explained.read_text(encoding="utf-8"))["mutant"]
        reasons = {(row["file"], row["line"], row["becomes"]): row["reason"] for row in said}
    with reading(record):
        return MutantRecord(
            parts_of(rows, set(reasons)),
            [
                row for row in rows
                if row["outcome"] == "SURVIVED" and key_of_row(row) not in reasons
            ],
            [
                {**row, "reason": reasons[key_of_row(row)]} for row in rows
                if key_of_row(row) in reasons
            ],
            len(reasons), read_rows(asked),
        )


def parts_of(rows: list[Row], explained: set[Key]) -> list[Part]:
    """The method first; none without rows."""
    parts = []
    for title, is_method in (("The method", True), ("What judges it", False)):
        of_part = [row for row in rows if row["room"].startswith("reference/") == is_method]
        if of_part:
            *earlier, newest = samples_of(of_part, explained)
            parts.append(Part(title, newest, earlier[::-1]))
    return parts


def samples_of(rows: list[Row], explained: set[Key]) -> list[Sample]:
    """By commit, in the order of their dates."""
    by_commit: dict[str, list[Row]] = defaultdict(list)
    for row in rows:
        by_commit[row["commit"]].append(row)
    samples = [
        Sample(commit, max(row["date"] for row in drawn), scores_by_room(drawn, explained))
        for commit, drawn in by_commit.items()
    ]
    return sorted(samples, key=lambda sample: sample.date)


def scores_by_room(rows: list[Row], explained: set[Key]) -> list[Score]:
    """One score a folder, then one of all. A mutant with a reason counts as equivalent."""
    counts: dict[str, Counter[str]] = defaultdict(Counter)
    for row in rows:
        outcome = "equivalent" if key_of_row(row) in explained else row["outcome"]
        for room in (row["room"], "all"):
            counts[room][outcome] += 1
            counts[room]["since"] += outcome == "SURVIVED" and bool(row.get("noticed_by"))
    rooms = sorted(counts, key=lambda name: (name == "all", name))
    return [_score(room, counts[room]) for room in rooms]


def _score(room: str, count: Counter[str]) -> Score:
    killed, survived = count["killed"], count["SURVIVED"]
    of = killed + survived
    low, high = score_interval(killed, of)
    return Score(
        room, killed, survived, count["equivalent"], count["since"], killed / of if of else None,
        low, high
    )


def score_interval(hits: int, of: int) -> tuple[float | None, float | None]:
    """What share 95 % of such samples leave possible: Wilson's interval (Wilson, J. Am. Stat.
    Assoc. 22, 1927)."""
    if not of:
        return None, None
    z, share = 1.959964, hits / of
    middle = (share + z * z / (2 * of)) / (1 + z * z / of)
    half = z * math.sqrt(share * (1 - share) / of + z * z / (4 * of * of)) / (1 + z * z / of)
    return middle - half, middle + half
