"""Outcomes of seeded faults that are shipped, as `scripts/faults --record` keeps them: by commit
and outcome, the digests of the edits. An outcome counts for as long as the fault makes the same
edit and names the same findings and tests."""
from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from data.edit_digest import edit_digest
from data.results import Fault
from data.unreadable import read_json

RECORD = Path(__file__).resolve().parents[2] / "verification" / "faults" / "outcomes.json"


class Known(NamedTuple):
    """An outcome, and the commit at which it was found."""
    outcome: str
    commit: str


def known_outcomes(stored: list[str]) -> dict[str, Known]:
    """By the digest of the edit. A line has the commit, the outcome and the digests."""
    rows = [line.split() for line in stored]
    return {edit: Known(outcome, commit) for commit, outcome, *edits in rows for edit in edits}


def with_record(faults: list[Fault], record: Path = RECORD) -> list[Fault]:
    """The faults; those that were not run with the results as they are recorded. Throws Unreadable
    if the record is damaged."""
    known = read_json(record, known_outcomes) or {}
    return [_recorded(fault, known.get(edit_digest(fault))) for fault in faults]


def _recorded(fault: Fault, known: Known | None) -> Fault:
    if fault.outcome not in ("", "not run") or known is None:
        return fault
    return replace(fault, outcome=known.outcome, commit=known.commit)


def commits_of(faults: Iterable[Fault]) -> list[tuple[str, int]]:
    """Commit and number of the faults whose outcomes are recorded, the most first."""
    return Counter(fault.commit for fault in faults if fault.commit).most_common()
