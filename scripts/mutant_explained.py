"""Edits that verification/faults/equivalent_mutants.txt says change nothing, asked of all checks
and unit tests that reach them, and what came of it. Of scripts/mutate."""

import json
import sys
import time
from pathlib import Path

from edits import Change, sample
from mutant_scores import nearest_line
from mutant_trials import Judgement, Mutant, read_explained
from mutants import ROOT, write_at_once

sys.path.insert(0, str(ROOT / "reports"))
from data.mutation_scores import EXPLAINED_ASKED, Row, key_of_row  # noqa: E402


def not_asked(rows: list[Row], seed: int) -> list[Mutant]:
    """Explained edits that the rows do not have, in an order that the seed decides: those that are
    asked first are a random sample."""
    known = {key_of_row(row) for row in rows}
    open_edits = sorted(read_explained() - known)
    return [edit_of(number, *key) for number, key in enumerate(sample(open_edits, seed))]


def edit_of(number: int, file: str, line: str, becomes: str) -> Mutant:
    """Where the line stands first."""
    place = nearest_line((ROOT / file).read_text(encoding="utf-8"), line, 0)
    assert place is not None  # read_explained() has counted it
    return Mutant(file, number, Change(place[1], line, becomes, "explained"), place[0], line,
                  becomes)


def with_answers(rows: list[Row], judged: list[Judgement], commit: str) -> list[Row]:
    """The rows and those answered: what has no code of its own, or could not be asked, is left
    out."""
    today = time.strftime("%Y-%m-%d", time.gmtime())
    return rows + [
        {
            "file": one.mutant.file, "before": one.mutant.before, "after": one.mutant.after,
            "outcome": one.outcome, "by": one.by or one.what, "commit": commit, "date": today
        }
        for one in judged if one.outcome in ("killed", "SURVIVED")
    ]


def write_answers(rows: list[Row], path: Path = EXPLAINED_ASKED) -> None:
    """One line each, in a fixed order."""
    lines = sorted(json.dumps(row, ensure_ascii=False) for row in rows)
    write_at_once(path, '{"mutants": [\n' + ",\n".join(lines) + "\n]}\n")
