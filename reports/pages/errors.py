"""How large the errors of each shipped case are: what `foldproof converge` and `precision` found,
as recorded with the cases. Reads; decides nothing."""
from __future__ import annotations

import json
from dataclasses import dataclass
from math import nan
from pathlib import Path
from typing import Any

from data.case_digest import case_digest, case_files
from data.unreadable import reading


@dataclass
class QuantityError:
    """One quantity of a case, over steps that are halved."""
    name: str
    unit: str
    value: float           # of the case as it is; NaN of positions
    finest: float          # with the shortest steps; NaN of positions
    bar: float             # of the finest; NaN: a level came to no end
    as_it_is: float        # error of the case as it is, bar included; NaN likewise
    order: float           # NaN: none
    reading: str           # asymptotic, not asymptotic or inconclusive
    because: str           # why it is not asymptotic; or ""


@dataclass
class Cheapest:
    """The method that pays least for a wanted error."""
    error: float           # over the motion [1]
    method: str            # "": no method reaches it, or the truth is not known well enough
    step: float            # s
    seconds: float         # of the processor
    tied: list[str]        # methods whose prices cannot be told from the cheapest one's


@dataclass
class CaseErrors:
    """A case and its errors; or the hours that it would take to find them."""
    name: str
    hours: float           # of the processor; NaN: it was asked
    method: str
    levels: int
    step: float            # mean, of the case as it is [s]
    part_of_time: str      # "first 1 of 3 s" where not the whole run was asked, else ""
    horizon: float         # s; NaN: predictable to the end
    predictable: str       # in words
    stopped: list[str]     # levels that came to no end, and why
    quantities: list[QuantityError]
    cheapest: list[Cheapest]
    commit: str            # of the program that was asked
    changed: bool          # the shipped case is another scene by now

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
    file = cases / "errors.json"
    if not file.is_file():
        return None
    with reading(file):
        return Errors(
            [_case(row, cases) for row in json.loads(file.read_text(encoding="utf-8"))["cases"]]
        )


def _case(row: dict[str, Any], cases: Path) -> CaseErrors:
    files = case_files(cases)
    changed = (
        row["case"] not in files
        or case_digest(files[row["case"]], lambda name: (cases / name).read_bytes())
        != row["digest"]
    )
    commit = row["program"]["commit"]
    if "not_asked_hours" in row:
        return CaseErrors(
            row["case"], row["not_asked_hours"], "", 0, nan, "", nan, "", [], [], [], commit,
            changed
        )
    part_of_time = (
        f"first {row['asked_end']:g} of {row['end']:g} s" if row["asked_end"] != row["end"] else ""
    )
    stopped = [f"level {level} came to no end: {why}" for level, why in row["stopped"].items()]
    cheapest = [
        Cheapest(
            found["error"], found["method"] or "", _number(found["step"]),
            _number(found["seconds"]), found["tied"]
        )
        for found in row.get("precision", {}).get("cheapest", [])
    ]
    return CaseErrors(
        row["case"], nan, row["method"], len(row["mean_step"]), row["mean_step"][0], part_of_time,
        _number(row["horizon"]), row["predictable"], stopped,
        [_quantity(found) for found in row["quantities"]], cheapest, commit, changed
    )


def _quantity(row: dict[str, Any]) -> QuantityError:
    return QuantityError(
        row["name"], row["unit"], _number(row["value"]), _number(row["finest"]),
        _number(row["error_bar"]), _number(row["error_as_it_is"]), _number(row["order"]),
        row["reading"], row["because"]
    )


def _number(value: float | None) -> float:
    return nan if value is None else float(value)
