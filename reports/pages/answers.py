"""The answers to which integrator is cheapest and which step lasts, from the tables of studies.
Arranges what the program wrote; decides nothing."""
from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from math import isclose, isnan

from data.results import Column
from data.studies import Study, Table

NEEDED = ("scene", "error wanted", "by", "cheapest method")
# of every method's price, the cheapest of a scene and an error first
PRICED = ("scene", "error wanted", "method", "over the cheapest", "tied with it")
PER_ONE = {"1": 1, "%": 100}                   # units of errors
# the key of each number of a method that was asked how long its step may be
LASTING = {
    "method": "method", "step": "longest step that lasts", "over_limit": "over the elastic limit",
    "beyond": "the next step, twice as long", "over_c": "over those of C"
}
# Columns that name a method, or None for scheme C, and the column of the factor that it costs more.
OTHERS = (
    ("next best", "it costs this many times as much"), (None, "C costs this many times as much")
)


@dataclass
class Choice:
    """The cheapest method for one motion and one error, and others with
    the factor that they cost more."""
    method: str
    others: list[tuple[str, float]]             # NaN: does not reach that error
    # methods that the tried steps do not tell from it
    tied: list[str] = field(default_factory=list)
    # "B by seconds", where another measure has another winner beyond its ties
    disagrees: str = ""


@dataclass
class Cheapest:
    """Which method is cheapest: a row for each motion, a column for each error that is wanted."""
    by: str                                     # "counted work", ...
    errors: list[float]
    unit: str                                   # of the errors
    rows: list[tuple[str, list[Choice | None]]]
    # the same of small scenes, one a kind, which another study priced
    kinds: list[tuple[str, list[Choice | None]]] = field(default_factory=list)
    kinds_of: str = ""                          # that study's name


@dataclass
class LastingStep:
    """The longest step of a method that lasts on a scene."""
    method: str
    step: float                                 # s; 0: none of those tried
    over_limit: float                           # that step over the elastic limit [1]
    beyond: str                                 # what twice that step does
    over_c: float                               # work over that of scheme C; NaN: no step [1]


def cheapest_of(studies: Iterable[Study]) -> Cheapest | None:
    """From the first table that has the columns NEEDED, by the measure that it names first, and the
    first that has the columns PRICED. None if there is no table of the first kind."""
    studies = list(studies)
    found = _first_table(studies, NEEDED)
    if not found:
        return None
    _, table, rows = found
    cheapest = _arrange(rows, _error_unit(table))
    if priced := _first_table(studies, PRICED):
        cheapest.kinds_of, table, rows = priced
        scale = PER_ONE[cheapest.unit] / PER_ONE[_error_unit(table)]
        cheapest.kinds = _kinds(rows, [error / scale for error in cheapest.errors])
    return cheapest


def _error_unit(table: Table) -> str:
    return next(column.unit for column in table.columns if _name(column) == "error wanted")


def lasting_steps(studies: Iterable[Study]) -> tuple[str, list[LastingStep]] | None:
    """The name of the first study that has a table with the columns LASTING, and its rows; None if
    there is none."""
    found = _first_table(list(studies), tuple(LASTING.values()))
    if not found:
        return None
    name, _, rows = found
    return name, [LastingStep(**{key: row[column] for key, column in LASTING.items()})
                  for row in rows]


def _first_table(
    studies: list[Study], columns: tuple[str, ...]
) -> tuple[str, Table, list[dict[str, object]]] | None:
    """The study's name, the table and its rows."""
    for study in studies:
        for table in study.tables:
            rows = rows_of(table)
            if rows and all(key in rows[0] for key in columns):
                return study.name, table, rows
    return None


def _kinds(
    rows: list[dict[str, object]], errors: list[float]
) -> list[tuple[str, list[Choice | None]]]:
    """Each scene's cheapest method for each of the errors."""
    scenes = dict.fromkeys(str(row["scene"]) for row in rows)
    return [
        (
            scene.replace("-", " "),
            [
                _cheapest_row(
                    [
                        row
                        for row in rows
                        if row["scene"] == scene and isclose(float(row["error wanted"]), error)
                    ]
                )
                for error in errors
            ],
        )
        for scene in scenes
    ]


def _cheapest_row(prices: list[dict[str, object]]) -> Choice | None:
    """Of the prices of one scene and error; None if no method reaches the error."""
    known = [row for row in prices if not isnan(float(row["over the cheapest"]))]
    if not known:
        return None
    tied = [str(row["method"]) for row in known[1:] if row["tied with it"] == "yes"]
    others = [row for row in known[1:] if str(row["method"]) not in tied]
    named = others[:1] + [row for row in others[1:] if row["method"] == "C"]
    return Choice(
        str(known[0]["method"]),
        [(str(row["method"]), float(row["over the cheapest"])) for row in named], tied
    )


def rows_of(table: Table) -> list[dict[str, object]]:
    """A table as rows, keyed by the names of columns with blanks."""
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
    if not {choice.method, *choice.tied} & {winner, *_tied(other)}:
        choice.disagrees = f"{winner} by {other['by']}"


def _tied(row: dict[str, object]) -> list[str]:
    return [name for name in str(row.get("tied", "")).split(", ") if name]


def _choice(row: dict[str, object]) -> Choice:
    method, tied, others = str(row["cheapest method"]), _tied(row), []
    for named, factor in OTHERS:
        other = str(row.get(named, "C")) if named else "C"
        costs = float(row.get(factor, float("nan")))
        if other not in (method, *tied, *(name for name, _ in others)) and not (
            named and isnan(costs)
        ):
            others.append((other, costs))
    return Choice(method, others, tied)
