"""Units of the keys of case files, as cases/KEYS.md states them."""
from __future__ import annotations

import re
from functools import cache
from pathlib import Path

KEYS_PAGE = Path(__file__).resolve().parents[2] / "cases" / "KEYS.md"
HEADING = re.compile(r"^## `\[+(\w+)")
KEY = re.compile(r"`(\w+)`")
# keys of shapes, which the page lists with "lengths in m"
LENGTHS = (
    "drawn_width", "height", "length", "radius", "ring_radius", "size", "tube_radius", "width"
)
NO_UNIT = ("", "1", "rest lengths", "units of the file")


@cache
def units_of_keys(page: Path = KEYS_PAGE) -> dict[str, str]:
    """Unit of each "table.key" that has one; none where the page is not installed."""
    units: dict[str, str] = {}
    table, has_units = "", False
    for line in page.read_text(encoding="utf-8").splitlines() if page.is_file() else []:
        if heading := HEADING.match(line):
            table = heading[1]
        cells = [cell.strip() for cell in line.strip("|").split("|")] if line[:1] == "|" else []
        if not cells:
            has_units = False
        elif cells[:2] == ["key", "unit"]:
            has_units = True
        elif cells[:1] == ["shape"]:
            units |= {f"{table}.{key}": "m" for key in LENGTHS}
        elif has_units:
            units |= _units_of_row(table, KEY.findall(cells[0]), cells[1])
    return units


def _units_of_row(table: str, keys: list[str], said: str) -> dict[str, str]:
    """One unit for all keys of a row, or one for each."""
    each = [unit.strip() for unit in said.split(",")]
    units = each if len(each) == len(keys) else [said] * len(keys)
    return {f"{table}.{key}": unit for key, unit in zip(keys, units) if unit not in NO_UNIT}


def unit_of_key(name: str) -> str:
    """Of a parameter as after --set, as hold.0.velocity; "1" if it has none."""
    return units_of_keys().get(re.sub(r"\.\d+\.", ".", name), "1")


def words_of_key(name: str) -> str:
    """The same for readers: "self_collision.thickness" is "self collision thickness"."""
    return re.sub(r"[._]", " ", re.sub(r"\.\d+\.", ".", name))
