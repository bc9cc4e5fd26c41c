"""What came of mutants: the log of those that were asked in this tree, the scores that are shipped,
and the answers about edits that verification/faults/equivalent_mutants.txt explains. Of
scripts/mutate; reports/data/mutation_scores.py says what a score is.
"""

import json
import sys
import time
from collections import Counter, defaultdict
from dataclasses import asdict, replace
from pathlib import Path

from builds import ROOT, write_at_once
from edits import Change, sample
from mutant_questions import FOLDER
from mutant_trials import Judgement, Mutant, read_explained

sys.path.insert(0, str(ROOT / "reports"))
from data.mutation_scores import (  # noqa: E402
    EXPLAINED_ASKED, SCORES, Key, Row, Sample, Score, Scores, key_of_row
)

ASKED = ("killed", "SURVIVED", "equivalent")
ASKED_LOG = FOLDER / "asked.jsonl"


# ---- the log -------------------------------------------------------------------------------------


def rows_of(folder: str, judged: list[Judgement], seed: int, commit: str) -> list[Row]:
    """One row for each mutant that was asked; others are left out."""
    return [
        {
            "folder": folder, "file": one.mutant.file, "line": one.mutant.line,
            "before": one.mutant.before, "after": one.mutant.after, "outcome": one.outcome,
            "by": one.by or one.what, "seed": seed, "commit": commit
        }
        for one in judged if one.outcome in ASKED
    ]


def log_asked(rows: list[Row], path: Path = ASKED_LOG) -> None:
    """Appends a line for each row; several runs of a campaign may append at once."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("a", encoding="utf-8") as log:
        log.write("".join(f"{json.dumps(row, ensure_ascii=False)}\n" for row in rows))


def read_asked(commit: str, path: Path = ASKED_LOG) -> list[Row]:
    """The mutants of this commit, each as it was first found. Skips lines that a killed run left
    unfinished."""
    first: dict[Key, Row] = {}
    for line in path.read_text(encoding="utf-8").splitlines() if path.is_file() else []:
        try:
            row = json.loads(line)
        except ValueError:
            continue
        if row["commit"] == commit:
            first.setdefault(key_of_row(row), row)
    return list(first.values())


# ---- the scores ----------------------------------------------------------------------------------


def today() -> str:
    return time.strftime("%Y-%m-%d", time.gmtime())


def with_sample(scores: Scores, rows: list[Row], explained: set[Key]) -> Scores:
    """The scores with those of the rows, all of one commit, in place of any that it had. A mutant
    with a reason counts as equivalent."""
    commit = rows[0]["commit"][:10]
    counts: dict[str, Counter[str]] = defaultdict(Counter)
    missed = []
    for row in rows:
        outcome = "equivalent" if key_of_row(row) in explained else row["outcome"]
        counts[row["folder"]][outcome] += 1
        if outcome == "SURVIVED":
            edit = {name: row[name] for name in ("folder", "file", "line", "before", "after")}
            missed.append({**edit, "commit": commit})
    folders = [Score(name, count["killed"], count["SURVIVED"], 0, count["equivalent"])
               for name, count in sorted(counts.items())]
    others = [one for one in scores.samples if one.commit != commit]
    return Scores([*others, Sample(commit, today(), folders)],
                  [one for one in scores.open if one["commit"] != commit] + missed)


def write_scores(scores: Scores, path: Path = SCORES) -> None:
    """A line for each folder and each open mutant."""
    def lines(rows: list[Row], margin: str) -> str:
        return ",\n".join(margin + json.dumps(row, ensure_ascii=False) for row in rows)

    samples = [f' {{"commit": "{one.commit}", "date": "{one.date}", "folders": [\n'
               + lines(list(map(asdict, one.folders)), "  ") + "]}" for one in scores.samples]
    write_at_once(path, '{"samples": [\n' + ",\n".join(samples) + '],\n"open": [\n'
                  + lines(scores.open, " ") + "]}\n")


# ---- missed mutants, asked again -----------------------------------------------------------------


def open_mutants(rows: list[Row]) -> list[Mutant]:
    """Of the open rows, as edits of the files of today; a line that is gone cannot be asked."""
    found = []
    for number, row in enumerate(rows):
        text = (ROOT / row["file"]).read_text(encoding="utf-8")
        place = nearest_line(text, row["before"], row["line"])
        if place is not None:
            line, at = place
            change = Change(at, row["before"], row["after"], "recorded")
            found.append(Mutant(row["file"], number, change, line, row["before"], row["after"]))
    return found


def nearest_line(text: str, line: str, to: int) -> tuple[int, int] | None:
    """Number and place of the line that reads so, without its margin, next to the number `to`."""
    places, at = [], 0
    for number, each in enumerate(text.splitlines(keepends=True), start=1):
        if each.strip() == line:
            places.append((abs(number - to), number, at + len(each) - len(each.lstrip())))
        at += len(each)
    return min(places)[1:] if places else None


def with_noticed(scores: Scores, judged: list[Judgement]) -> Scores:
    """Open rows that are killed now are open no longer; their samples keep them as missed."""
    noticed = {one.mutant.number for one in judged if one.outcome == "killed"}
    since = Counter((row["commit"], row["folder"])
                    for k, row in enumerate(scores.open) if k in noticed)
    samples = [
        replace(sample, folders=[
            replace(one, noticed_since=one.noticed_since + since[sample.commit, one.folder])
            for one in sample.folders
        ])
        for sample in scores.samples
    ]
    return Scores(samples, [row for k, row in enumerate(scores.open) if k not in noticed])


# ---- explained edits -----------------------------------------------------------------------------


def not_asked(rows: list[Row], seed: int) -> list[Mutant]:
    """Explained edits that the rows do not have, in an order that the seed decides: those that are
    asked first are a random sample."""
    known = {key_of_row(row) for row in rows}
    return [edit_of(number, *key)
            for number, key in enumerate(sample(sorted(read_explained() - known), seed))]


def edit_of(number: int, file: str, line: str, becomes: str) -> Mutant:
    """Where the line stands first."""
    place = nearest_line((ROOT / file).read_text(encoding="utf-8"), line, 0)
    assert place is not None  # read_explained() has counted it
    return Mutant(file, number, Change(place[1], line, becomes, "explained"), place[0], line,
                  becomes)


def with_answers(rows: list[Row], judged: list[Judgement], commit: str) -> list[Row]:
    """The rows and those answered: what has no code of its own, or could not be asked, is left
    out."""
    return rows + [
        {
            "file": one.mutant.file, "before": one.mutant.before, "after": one.mutant.after,
            "outcome": one.outcome, "by": one.by or one.what, "commit": commit, "date": today()
        }
        for one in judged if one.outcome in ("killed", "SURVIVED")
    ]


def write_answers(rows: list[Row], path: Path = EXPLAINED_ASKED) -> None:
    """One line each, in a fixed order."""
    lines = sorted(json.dumps(row, ensure_ascii=False) for row in rows)
    write_at_once(path, '{"mutants": [\n' + ",\n".join(lines) + "\n]}\n")
