"""Outcomes of seeded faults that are shipped, as `scripts/faults --record` keeps them. An outcome
counts for as long as the fault makes the same edit and asks the same findings and tests."""
from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from data.edit_digest import edit_digest
from data.results import Fault
from data.unreadable import reading

RECORD = Path(__file__).resolve().parents[2] / "verification" / "faults" / "outcomes.json"


def with_record(faults: list[Fault], record: Path = RECORD) -> list[Fault]:
    """The faults; those that were not run with the results as they are recorded. Throws Unreadable
    if the record is damaged."""
    if not record.is_file():
        return faults
    with reading(record):
        rows = json.loads(record.read_text(encoding="utf-8"))["faults"]
        return [_recorded(fault, rows.get(fault.name)) for fault in faults]


def _recorded(fault: Fault, row: dict[str, str] | None) -> Fault:
    if fault.outcome not in ("", "not run") or row is None:
        return fault
    if row["edit"] != edit_digest(
        fault.file, fault.find, fault.replace, fault.caught_by, fault.caught_by_tests
    ):
        return fault
    return replace(fault, outcome=row["outcome"], commit=row["commit"], date=row["date"])


def commits_of(faults: Iterable[Fault]) -> list[tuple[str, str, int]]:
    """Commit, day and number of the faults whose outcomes are recorded, the most first."""
    counted = Counter((fault.commit, fault.date) for fault in faults if fault.commit)
    return [(commit, date, count) for (commit, date), count in counted.most_common()]
