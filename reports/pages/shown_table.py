"""A table as the page sets it: its first and last rows, and how many lie between."""
from __future__ import annotations

from dataclasses import dataclass

from markupsafe import Markup

from data.quantities import cells_html
from data.results import Column

WHOLE_TABLE, WHOLE_STUDY_TABLE = 12, 60  # rows; longer tables show FIRST_ROWS and LAST_ROWS
FIRST_ROWS, LAST_ROWS = 7, 3


@dataclass
class ShownTable:
    """A table ready to be set: heads with units, the rows shown first and
    last, and how many lie between."""

    heads: list[tuple[str, str, bool]]  # name, unit, whether it holds numbers
    first: list[tuple[Markup, ...]]
    left_out: int
    last: list[tuple[Markup, ...]]


def select_rows(columns: list[Column], most: int = WHOLE_TABLE) -> ShownTable:
    """The displayed part of a table, up to `most` rows; vectors get one column per component."""
    flat = [part for column in columns for part in _components(column)]
    count = max((len(column.values) for column in flat), default=0)
    whole = count <= most
    kept = [*range(count)] if whole else [*range(FIRST_ROWS), *range(count - LAST_ROWS, count)]
    cells = [
        cells_html(column.values[row] if row < len(column.values) else "" for row in kept)
        for column in flat
    ]
    rows = list(zip(*cells))
    cut = len(rows) if whole else FIRST_ROWS
    heads = [
        (column.name.replace("_", " "), column.unit, column.values.dtype.kind == "f")
        for column in flat
    ]
    return ShownTable(heads, rows[:cut], count - len(rows), rows[cut:])


def _components(column: Column) -> list[Column]:
    if column.values.ndim == 1:
        return [column]
    flat = column.values.reshape(len(column.values), -1)
    names = "xyz" if flat.shape[1] == 3 else [str(k + 1) for k in range(flat.shape[1])]
    return [
        Column(f"{column.name} {name}", column.unit, flat[:, k]) for k, name in enumerate(names)
    ]
