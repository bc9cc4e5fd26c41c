"""How large the errors of each shipped case are: what `foldproof converge` and `precision` found,
as recorded with the cases. Reads; decides nothing."""
from __future__ import annotations

from dataclasses import dataclass, field
from math import nan
from pathlib import Path
from typing import Any

from data.case_digest import has_changed, part_of_time
from data.records import record
from data.unreadable import read_json
from pages.section import Section


@dataclass
class QuantityError:
    """One quantity of a case, over steps that are halved."""
    name: str
    unit: str
    value: float           # of the case as it is; NaN of positions
    finest: float          # with the shortest steps; NaN of positions
    error_bar: float       # of the finest; NaN: a level came to no end
    error_as_it_is: float  # error of the case as it is, bar included; NaN likewise
    order: float           # NaN: none
    reading: str           # asymptotic, not asymptotic or inconclusive
    because: str           # why it is not asymptotic; or ""


@dataclass
class Cheapest:
    """The method that pays least for a wanted error."""
    error: float           # over the motion [1]
    method: str | None     # None: no method reaches it, or the truth is not known well enough
    step: float            # s
    tied: list[str]        # methods whose prices cannot be told from the cheapest one's


@dataclass
class CaseErrors:
    """A case and its errors; or the hours that it would take to find them."""
    name: str
    commit: str            # of the program that was asked
    changed: bool          # the shipped case is another scene by now
    not_asked_hours: float = nan  # of the processor; NaN: it was asked
    method: str = ""
    mean_step: list[float] = field(default_factory=list)  # of each level, of the case first [s]
    part_of_time: str = ""  # "first 1 of 3 s" where not the whole run was asked, else ""
    horizon: float = nan   # s; NaN: predictable to the end
    predictable: str = ""  # in words
    stopped: list[str] = field(default_factory=list)  # levels that came to no end, and why
    quantities: list[QuantityError] = field(default_factory=list)
    cheapest: list[Cheapest] = field(default_factory=list)

    @property
    def positions(self) -> QuantityError:
        """The first quantity."""
        return self.quantities[0]

    @property
    def asked(self) -> bool:
        """False if only the hours are known."""
        return bool(self.quantities)


@dataclass
class Errors:
    """The record of all shipped cases."""
    cases: list[CaseErrors]

    def of(self, name: str) -> CaseErrors | None:
        """Of the case of that name; None if the record does not speak of it."""
        return next((case for case in self.cases if case.name == name), None)

    def commits(self) -> list[str]:
        """Of the programs that were asked, each once."""
        return list(dict.fromkeys(case.commit for case in self.cases if case.asked))

    def wanted(self) -> list[float]:
        """The errors whose price was asked, of any case, the largest first."""
        return sorted({found.error for case in self.cases for found in case.cheapest}, reverse=True)


def load_errors(cases: Path) -> Errors | None:
    """The record errors.json in the folder `cases`; None if there is none.
    Throws Unreadable for other files."""
    return read_json(
        cases / "errors.json", lambda said: Errors([_case(row, cases) for row in said["cases"]])
    )


def _case(row: dict[str, Any], cases: Path) -> CaseErrors:
    about = {
        "name": row["case"], "commit": row["program"]["commit"], "changed": has_changed(row, cases)
    }
    if "not_asked_hours" in row:
        return record(CaseErrors, row, **about)
    stopped = [f"level {level} came to no end: {why}" for level, why in row["stopped"].items()]
    cheapest = row.get("precision", {}).get("cheapest", [])
    return record(
        CaseErrors, row, **about, part_of_time=part_of_time(row), stopped=stopped,
        quantities=[record(QuantityError, found) for found in row["quantities"]],
        cheapest=[record(Cheapest, found) for found in cheapest]
    )


SECTION = Section(
    "errors", "How large the errors of scenes are", lambda page: page.parts["errors"], "Errors",
    lambda source: source.shipped and load_errors(source.shipped)
)
