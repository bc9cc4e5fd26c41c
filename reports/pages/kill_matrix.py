"""Which checks notice which faults: the rows that scripts/faults wrote, arranged for the page."""
from __future__ import annotations

from dataclasses import dataclass

from data.results import Fault, FaultCheck
from pages.counts import faults_by_file


@dataclass
class Cell:
    """Results of one group of checks on one fault."""
    failing: int
    margin: float        # the largest measured/bound of those that fail; NaN where none is known
    named: list[FaultCheck]


@dataclass
class KillRow:
    """One fault: what each of the file's groups of checks says of
    it; None where it was not asked."""
    fault: Fault
    cells: list[Cell | None]


@dataclass
class KillTable:
    """The faults of one file against the groups of checks that were asked about one of them."""
    file: str
    groups: list[str]
    rows: list[KillRow]


def kill_tables(faults: list[Fault]) -> list[KillTable]:
    """One table for each file, in the order of the faults; none where no
    outcomes with checks are known."""
    by_file = faults_by_file(fault for fault in faults if fault.checks)
    return [_table(file, of_file) for file, of_file in by_file.items()]


def _table(file: str, faults: list[Fault]) -> KillTable:
    groups = sorted({_group(check) for fault in faults for check in fault.checks})
    return KillTable(
        file, groups,
        [KillRow(fault, [_cell(fault, group) for group in groups]) for fault in faults]
    )


def _group(check: FaultCheck) -> str:
    """The part of a check's name before the first dot; names of tests are
    sentences, or begin with test_."""
    return (
        "tests" if " " in check.name or check.name.startswith("test_") else check.name.split(".")[0]
    )


def _cell(fault: Fault, group: str) -> Cell | None:
    named = [check for check in fault.checks if _group(check) == group]
    if not named:
        return None
    margins = [
        check.margin for check in named if check.outcome == "fails" and check.margin == check.margin
    ]
    return Cell(
        sum(check.outcome == "fails" for check in named), max(margins, default=float("nan")), named
    )
