"""The answer to which integrator is cheapest, from the tables of a study. Arranges what the program
wrote; decides nothing."""
from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from math import isnan

from data.results import Column, Study, Table

NEEDED = ("scene", "error wanted", "by", "cheapest method")
# Columns that name a method, or None for scheme C, and the column of the factor that it costs more.
OTHERS = (
    ("next best", "it costs this many times as much"),
    (None, "C costs this many times as much"),
)


@dataclass
class Choice:
    """The cheapest method for one motion and one error, and others with
    the factor that they cost more."""
    method: str
    others: list[tuple[str, float]]             # NaN: does not reach that error
    # methods that the tried steps do not tell from it
    alike: list[str] = field(default_factory=list)
    # "B by seconds", where another measure has another winner beyond its ties
    disagrees: str = ""


@dataclass
class Cheapest:
    """Which method is cheapest: a row for each motion, a column for each error that is wanted."""
    by: str                                     # "counted work", ...
    errors: list[float]
    unit: str                                   # of the errors
    rows: list[tuple[str, list[Choice | None]]]


def cheapest_of(studies: Iterable[Study]) -> Cheapest | None:
    """From the first table that has the columns NEEDED; by the measure that it
    names first. None if there is none."""
    for study in studies:
        for table in study.tables:
            rows = _rows(table)
            if rows and all(key in rows[0] for key in NEEDED):
                unit = next(
                    column.unit for column in table.columns if _name(column) == "error wanted"
                )
                return _arrange(rows, unit)
    return None


def _rows(table: Table) -> list[dict[str, object]]:
    names = [_name(column) for column in table.columns]
    return [
        dict(zip(names, values)) for values in zip(*(column.values for column in table.columns))
    ]


def _name(column: Column) -> str:
    return column.name.replace("_", " ")


def _arrange(rows: list[dict[str, object]], unit: str) -> Cheapest:
    by = str(rows[0]["by"])
    errors = list(dict.fromkeys(float(row["error wanted"]) for row in rows if row["by"] == by))
    scenes = list(dict.fromkeys(str(row["scene"]) for row in rows if row["by"] == by))
    found = {_place(row): _choice(row) for row in rows if row["by"] == by}
    for row in rows:
        if (choice := found.get(_place(row))) and row["by"] != by:
            _compare(choice, row)
    return Cheapest(
        by, errors, unit,
        [(scene, [found.get((scene, error)) for error in errors]) for scene in scenes]
    )


def _place(row: dict[str, object]) -> tuple[str, float]:
    return str(row["scene"]), float(row["error wanted"])


def _compare(choice: Choice, other: dict[str, object]) -> None:
    """Notes another measure's winner where neither is among the other's ties."""
    winner = str(other["cheapest method"])
    if not {choice.method, *choice.alike} & {winner, *_alike(other)}:
        choice.disagrees = f"{winner} by {other['by']}"


def _alike(row: dict[str, object]) -> list[str]:
    return [name for name in str(row.get("alike", "")).split(", ") if name]


def _choice(row: dict[str, object]) -> Choice:
    method, alike, others = str(row["cheapest method"]), _alike(row), []
    for named, factor in OTHERS:
        other = str(row.get(named, "C")) if named else "C"
        costs = float(row.get(factor, float("nan")))
        if other not in (method, *alike, *(name for name, _ in others)) and not (
            named and isnan(costs)
        ):
            others.append((other, costs))
    return Choice(method, others, alike)
