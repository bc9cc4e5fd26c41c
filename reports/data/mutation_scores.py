"""Scores of random slips, as `scripts/mutate --record` keeps them: for each commit that was sampled
and each folder, how many of its slips the checks and tests noticed when they were first put to
them. The score of a sample is that of slips for which nobody has mended anything."""
from __future__ import annotations

import itertools
import math
import re
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from data.records import record
from data.unreadable import read_json, reading

FAULTS = Path(__file__).resolve().parents[2] / "verification" / "faults"
SCORES = FAULTS / "scores.json"
EXPLAINED = FAULTS / "equivalent_mutants.txt"
EXPLAINED_ASKED = FAULTS / "explained_mutants.json"
PLANTED = FAULTS.parent / "subjects" / "planted_sets.json"

Row = dict[str, Any]
Key = tuple[str, str, str]  # file, line, and what the line becomes


@dataclass(frozen=True)
class Score:
    """Counts of the mutants of one folder, or of all."""
    folder: str
    noticed: int
    missed: int
    noticed_since: int    # of the missed
    equivalent: int       # declared to change nothing; in no score

    @property
    def ratio(self) -> float | None:
        """Noticed over noticed and missed; None without either."""
        of = self.noticed + self.missed
        return self.noticed / of if of else None

    @property
    def interval(self) -> tuple[float | None, float | None]:
        """The ratios that 95 % of such samples leave possible."""
        return score_interval(self.noticed, self.noticed + self.missed)


@dataclass(frozen=True)
class Sample:
    """The mutants that were drawn at one commit, by folder."""
    commit: str
    date: str
    folders: list[Score]

    @property
    def all(self) -> Score:
        counts = ("noticed", "missed", "noticed_since", "equivalent")
        return Score("all", *(sum(getattr(one, name) for one in self.folders) for name in counts))


@dataclass
class Scores:
    """The file of scores."""
    samples: list[Sample] = field(default_factory=list)  # the oldest first
    # missed and not noticed since: folder, file, line, before, after, commit
    open: list[Row] = field(default_factory=list)


@dataclass(frozen=True)
class Part:
    """The samples of the method, or of the code that judges it."""
    title: str
    newest: Sample
    earlier: list[Sample]  # the latest first


@dataclass(frozen=True)
class MutationPage:
    """The scores as a page shows them."""
    parts: list[Part]
    open: list[Row]
    explained: int             # edits with a reason
    explained_asked: int       # put to all checks and unit tests that reach them
    explained_noticed: int     # of those asked: their reasons were wrong, and are gone

    @property
    def asked(self) -> int:
        """How many mutants the newest samples have."""
        newest = [part.newest.all for part in self.parts]
        return sum(row.noticed + row.missed + row.equivalent for row in newest)


def read_scores(path: Path = SCORES) -> Scores:
    """Throws Unreadable if the file is damaged; without a file, no scores."""
    def scores(stored: dict[str, Any]) -> Scores:
        samples = [
            record(Sample, row, folders=[Score(**folder) for folder in row["folders"]])
            for row in stored["samples"]
        ]
        return Scores(samples, stored["open"])
    return read_json(path, scores) or Scores()


def read_answers(path: Path = EXPLAINED_ASKED) -> list[Row]:
    """Of edits that were explained when they were put to the checks; none without a file."""
    return read_json(path, lambda said: said["mutants"]) or []


def key_of_row(row: Row) -> Key:
    return row["file"], row["before"], row["after"]


class Explained(NamedTuple):
    """An edit with a reason why it changes no answer."""
    file: str
    line: str
    becomes: str
    times: int  # how often the line must stand in the file


def read_explained_edits(path: Path = EXPLAINED) -> list[Explained]:
    """The edits of a file that is written as its first lines say. Throws Unreadable."""
    edits: list[Explained] = []
    with reading(path):
        for section in path.read_text(encoding="utf-8").split("\n\n")[1:]:
            file, *rows = section.splitlines()
            for row, equal in itertools.groupby(rows):
                times = len(list(equal))
                if row.startswith("- "):
                    edits += [Explained(file, *edit, times) for edit in edits_of(row[2:])]
                elif not row.startswith("  "):
                    raise ValueError(f"{file}: neither a reason nor a line with its edits: {row}")
    return edits


def edits_of(marked: str) -> list[tuple[str, str]]:
    """The line, and what it becomes, for each other text that a mark has; at least one."""
    parts = re.split("[«»]", marked)  # every second one is what a mark holds
    line = [part.split("¦")[0] for part in parts]
    edits = [("".join(line), "".join([*line[:k], other, *line[k + 1:]]))
             for k in range(1, len(parts), 2) for other in parts[k].split("¦")[1:]]
    if not edits or len(parts) % 2 == 0:
        raise ValueError(f"no edit: {marked}")
    return edits


def choices_of(name: str) -> list[str]:
    """A name for each of its alternatives: "fall.{x,y}" stands for "fall.x" and "fall.y"."""
    parts = re.split("[{}]", name)  # every second one is what braces hold
    choices = [part.split(",") if k % 2 else [part] for k, part in enumerate(parts)]
    return ["".join(chosen) for chosen in itertools.product(*choices)]


def fault_rows(path: Path) -> Iterator[Row]:
    """The rows of a list of seeded faults: one without a file has that of the row above, and what
    `edit` marks is its find and replace; `caught_by` is written out. Throws ValueError, or
    AttributeError for no rows."""
    file = {}
    for name, row in tomllib.loads(path.read_text(encoding="utf-8")).get("fault", {}).items():
        if "edit" in row:
            [(row["find"], row["replace"])] = edits_of(row.pop("edit"))
        if "caught_by" in row:
            row["caught_by"] = [one for name in row["caught_by"] for one in choices_of(name)]
        row = {"name": name, **file, **row}
        file = {"file": row["file"]} if "file" in row else {}
        yield row


def load_mutation_page(
    scores: Path = SCORES, explained: Path = EXPLAINED, asked: Path = EXPLAINED_ASKED
) -> MutationPage | None:
    """None without scores. Throws Unreadable if a file is damaged."""
    read = read_scores(scores)
    if not read.samples:
        return None
    answers = read_answers(asked)
    return MutationPage(
        parts_of(read.samples), read.open, len(read_explained_edits(explained)), len(answers),
        sum(row["outcome"] == "killed" for row in answers)
    )


def load_planted_sets(path: Path = PLANTED) -> list[Score]:
    """Sets of slips in a solver that holds every law, each judged before anything was mended for
    it; the newest last."""
    return [
        Score(row["set"], row["noticed"], row["missed"], noticed_since=0, equivalent=0)
        for row in read_json(path, list) or []
    ]


def parts_of(samples: list[Sample]) -> list[Part]:
    """The method first; a part without samples is left out."""
    parts = []
    for title, is_method in (("The method", True), ("The code that judges it", False)):
        of_part = []
        for sample in samples:
            folders = [
                one for one in sample.folders if one.folder.startswith("reference/") == is_method
            ]
            if folders:
                of_part.append(Sample(sample.commit, sample.date, folders))
        if of_part:
            *earlier, newest = of_part
            parts.append(Part(title, newest, earlier[::-1]))
    return parts


def score_interval(hits: int, of: int) -> tuple[float | None, float | None]:
    """The ratios that 95 % of such samples leave possible: Wilson's interval (Wilson, J. Am. Stat.
    Assoc. 22, 1927)."""
    if not of:
        return None, None
    z, ratio = 1.959964, hits / of
    middle = (ratio + z * z / (2 * of)) / (1 + z * z / of)
    half = z * math.sqrt(ratio * (1 - ratio) / of + z * z / (4 * of * of)) / (1 + z * z / of)
    return middle - half, middle + half
