"""Bundles: all that the verdicts on a solver rest on, in one file of JSON. What others send is
checked, never run. A digest shows that a file was altered or damaged, not who wrote it.

A bundle has a line for each part: about (engine, version, settings, what it declares and maps,
machine, program, law set, seed), adapter (file, sha256, source), laws (by name: outcome, measured,
bound, unit, seconds, note), yardstick (the same of the reference on that machine), evidence (tables
of what some laws measured, of both), and the sha256 of each part's line."""
from __future__ import annotations

import hashlib
import json
import math
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

FORM = 2                    # of the file
MOST_BYTES = 2_000_000
MOST_SECONDS = 1e7          # of a law
LONGEST = 400               # characters of a text, but the adapter's source
SPREAD = 0.05               # by which a second run may differ, of the larger number or the bound
BOUND_SPREAD = 0.05         # likewise the reference's bounds from those of the law set
MOST_COLUMNS, MOST_CELLS = 12, 200     # of a table of evidence
PARTS = ("about", "adapter", "laws", "yardstick", "evidence")
OUTCOMES = ("holds", "fails", "inconclusive", "not applicable", "did not run")
NAME = re.compile(r"[\w .,()+=:/*'-]{1,120}")
FILE = re.compile(r"[\w+-][\w.+-]{0,100}")
LAW_SETS = Path(__file__).resolve().parents[2] / "verification/subjects/law_sets"

# part "about": the kinds of its fields
ABOUT: dict[str, type | tuple[type, ...]] = {
    "engine": str, "version": str, "settings": dict, "options": list, "declared": dict,
    "mapping": dict, "command": str, "machine": dict, "program": dict, "law_set": str, "seed": int,
    "spread": (int, float), "date": str
}

Row = list[Any]             # outcome, measured, bound, unit, seconds, note
Tables = dict[str, list[Any]]   # by law: columns, each of name, unit and cells


class Refused(Exception):
    """A bundle that is not taken; the message names the file and the reason."""


@dataclass
class Bundle:
    """A bundle that was checked."""
    about: dict[str, Any]
    adapter: dict[str, Any]
    laws: dict[str, Row]
    yardstick: dict[str, Row]       # empty: recorded before there was one
    evidence: dict[str, Tables]     # of "laws" and "yardstick"

    @property
    def identity(self) -> tuple[str, ...]:
        """Bundles of one identity are runs of the same thing. An adapter that is compiled has other
        bytes on each machine: its name counts."""
        about, adapter = self.about, self.adapter
        return (about["engine"], about["version"], json.dumps(about["settings"], sort_keys=True),
                self.arguments, about["law_set"], adapter["file"],
                adapter["sha256"] if adapter["source"] else "")

    @property
    def arguments(self) -> str:
        """Of the adapter: what its command has behind its file."""
        words = self.about["command"].split()
        at = [k for k, word in enumerate(words) if Path(word).name == self.adapter["file"]]
        return " ".join(words[at[-1] + 1:]) if at else ""


def law_set(name: str) -> dict[str, float | None]:
    """The bound of each law of a set, for the reference. Throws KeyError for an unknown set."""
    file = LAW_SETS / f"{name}.tsv"
    if not FILE.fullmatch(name) or not file.is_file():
        raise KeyError(name)
    rows = [line.split("\t") for line in file.read_text().splitlines() if not line.startswith("#")]
    return {row[0]: None if row[2] == "-" else float(row[2].split()[0]) for row in rows}


def line_of(part: Any) -> str:
    return json.dumps(part, sort_keys=True, ensure_ascii=False, allow_nan=False,
                      separators=(",", ":"))


def text_of(parts: dict[str, Any]) -> str:
    """The text of a bundle, the same for the same content."""
    lines = {name: line_of(parts[name]) for name in PARTS}
    digests = {name: hashlib.sha256(line.encode()).hexdigest() for name, line in lines.items()}
    all_lines = {"bundle": str(FORM), **lines, "sha256": line_of(digests)}
    return "{\n" + ",\n".join(f'"{name}":{line}' for name, line in all_lines.items()) + "\n}\n"


def read_bundle(path: Path) -> Bundle:
    """Throws Refused unless the file is whole, well-formed and consistent in itself."""
    try:
        text = _text_in(path)
        parts = _parts_of(text)
        _check_parts(parts)
        return Bundle(*(parts[name] for name in PARTS))
    except Refused as error:
        raise Refused(f"{path}: {error}") from None
    except OSError as error:
        raise Refused(f"{path}: {error.strerror}") from None


def _text_in(path: Path) -> str:
    if path.is_symlink() or not path.is_file():
        raise Refused("is no file of its own" if path.exists() else "there is no such file")
    if path.stat().st_size > MOST_BYTES:
        raise Refused(f"is larger than {MOST_BYTES} bytes")
    data = path.read_bytes()
    if not data.startswith(b"{"):
        raise Refused("is no bundle: its text does not begin with '{'")
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        raise Refused(f"is no UTF-8 text at byte {error.start}") from None


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) != len(pairs):
        raise Refused("has a field twice")
    return found


def _integer(word: str) -> int:
    if len(word) > 18:
        raise Refused(f"has {word[:18]}..., which is too large")
    return int(word)


def _no_number(word: str) -> None:
    raise Refused(f"has {word}, which is no number")


def _parts_of(text: str) -> dict[str, Any]:
    try:
        parts = json.loads(text, object_pairs_hook=_once, parse_constant=_no_number,
                           parse_int=_integer)
    except RecursionError:
        raise Refused("is nested too deeply") from None
    except ValueError as error:
        raise Refused(f"is no JSON: {error}") from None
    _only(parts, "the bundle", {"bundle", "sha256", *PARTS})
    if parts["bundle"] != FORM:
        raise Refused(f"is of form {str(parts['bundle'])[:20]}; this program reads {FORM}")
    try:
        anew = text_of(parts)
    except ValueError:
        raise Refused("has a number that is not finite") from None
    for name in PARTS:  # the last line but one has the digests
        digest = parts["sha256"].get(name) if isinstance(parts["sha256"], dict) else None
        if digest != hashlib.sha256(line_of(parts[name]).encode()).hexdigest():
            raise Refused(f"'{name}' is not what its sha256 says: altered, or damaged")
    if text != anew:
        raise Refused("is not as it was written: altered, or damaged")
    return parts


def _only(found: Any, what: str, wanted: set[str]) -> None:
    if not isinstance(found, dict):
        raise Refused(f"{what} is no object")
    for name in sorted(found.keys() - wanted):
        raise Refused(f"{what} has an unknown field '{name[:40]}'")
    for name in sorted(wanted - found.keys()):
        raise Refused(f"{what} lacks '{name}'")


def _check_parts(parts: dict[str, Any]) -> None:
    about, adapter = parts["about"], parts["adapter"]
    _only(about, "'about'", set(ABOUT))
    for name, kind in ABOUT.items():
        if not isinstance(about[name], kind) or isinstance(about[name], bool):
            raise Refused(f"'about': '{name}' is of the wrong kind")
    for name in ("engine", "version"):
        if not NAME.fullmatch(about[name]):
            raise Refused(f"'about': '{name}' is no plain name of at most 120 characters")
    if not 0 < about["spread"] <= 1:
        raise Refused("'about': 'spread' is not within 0 and 1")
    _check_texts(about, "'about'")
    _only(adapter, "'adapter'", {"file", "sha256", "source"})
    if not all(isinstance(text, str) for text in adapter.values()):
        raise Refused("'adapter' is no texts")
    if not FILE.fullmatch(adapter["file"]):
        raise Refused("'adapter': 'file' is no plain name of a file")
    if adapter["source"] and hashlib.sha256(adapter["source"].encode()).hexdigest() != \
            adapter["sha256"]:
        raise Refused("'adapter': the source is not that of its sha256")
    try:
        known = law_set(about["law_set"])
    except KeyError:
        raise Refused(f"law set '{about['law_set'][:20]}' is not one of this program") from None
    for part in ("laws", "yardstick"):
        _check_rows(parts[part], part, set(known))
    if not parts["laws"]:
        raise Refused("'laws' is empty")
    _only(parts["evidence"], "'evidence'", {"laws", "yardstick"})
    for part, tables in parts["evidence"].items():
        _check_tables(tables, f"'evidence' of '{part}'", set(known))


def _check_texts(value: Any, what: str, depth: int = 0) -> None:
    if depth > 4:
        raise Refused(f"{what} is nested too deeply")
    if isinstance(value, str) and len(value) > LONGEST:
        raise Refused(f"{what} has a text of more than {LONGEST} characters")
    inside = value.items() if isinstance(value, dict) else enumerate(value) \
        if isinstance(value, list) else ()
    for name, one in inside:
        _check_texts(name, what, depth + 1)
        _check_texts(one, what, depth + 1)


def _check_rows(rows: Any, part: str, known: set[str]) -> None:
    if not isinstance(rows, dict):
        raise Refused(f"'{part}' is no object")
    for law, row in rows.items():
        if law not in known:
            raise Refused(f"'{part}': there is no law '{law[:80]}' in the set")
        if not isinstance(row, list) or len(row) != 6 or row[0] not in OUTCOMES:
            raise Refused(f"'{part}': {law} is no row of outcome and five cells")
        outcome, measured, bound, unit, seconds, note = row
        for number in (measured, bound, seconds):
            if number is not None and not (type(number) in (int, float) and
                                           math.isfinite(number)):
                raise Refused(f"'{part}': {law} has a cell that is no number")
        if not isinstance(unit, str) or not isinstance(note, str) or len(unit + note) > LONGEST:
            raise Refused(f"'{part}': {law} has a text that is none, or too long")
        if seconds is not None and not 0 <= seconds <= MOST_SECONDS:
            raise Refused(f"'{part}': {law} took {seconds:g} s")
        _check_outcome(f"'{part}': {law}", outcome, measured, bound)


def _check_tables(tables: Any, what: str, known: set[str]) -> None:
    if not isinstance(tables, dict):
        raise Refused(f"{what} is no object")
    for law, columns in tables.items():
        if law not in known:
            raise Refused(f"{what}: there is no law '{law[:80]}' in the set")
        if not (isinstance(columns, list) and 0 < len(columns) <= MOST_COLUMNS
                and all(map(_is_column, columns)) and len({len(one[2]) for one in columns}) == 1):
            raise Refused(f"{what}: {law} has no table of up to {MOST_COLUMNS} columns of one "
                          f"length, {MOST_CELLS} at most")


def _is_column(one: Any) -> bool:
    return (isinstance(one, list) and len(one) == 3 and isinstance(one[2], list)
            and len(one[2]) <= MOST_CELLS and all(
                cell is None or type(cell) in (int, float)
                or isinstance(cell, str) and len(cell) <= LONGEST for cell in (*one[:2], *one[2]))
            and all(isinstance(word, str) for word in one[:2]))


def _check_outcome(what: str, outcome: str, measured: float | None, bound: float | None) -> None:
    if outcome == "holds" and (measured is None or bound is None or measured > bound):
        raise Refused(f"{what} holds, but {measured} is not within {bound}")
    if outcome == "fails" and None not in (measured, bound) and measured <= bound:
        raise Refused(f"{what} fails, but {measured:g} is within {bound:g}")


def check_submission(path: Path) -> Bundle:
    """read_bundle, and whether the whole set was asked, and the yardstick is plausible."""
    bundle = read_bundle(path)
    bounds = law_set(bundle.about["law_set"])
    missing = sorted(bounds.keys() - bundle.laws.keys())
    if missing:
        raise Refused(f"{path}: 'laws' lacks {missing[0]}, and {len(missing) - 1} more of the set")
    for law, bound in bounds.items():
        row = bundle.yardstick.get(law)
        if row is None or row[0] not in ("holds", "not applicable") or not row[4]:
            raise Refused(f"{path}: 'yardstick': the reference does not hold {law} there")
        if None not in (bound, row[2]) and _is_far(row[2], bound, BOUND_SPREAD):
            raise Refused(f"{path}: 'yardstick': {law} has bound {row[2]:g}; the law set"
                          f" {bound:g}")
    return bundle


def _is_far(a: float, b: float, spread: float, least: float = 0) -> bool:
    return abs(a - b) > spread * max(abs(a), abs(b), least)


def differences(one: Bundle, other: Bundle, spread: float = 0) -> list[tuple[str, Row, Row]]:
    """Laws that both asked, whose outcomes differ, or whose numbers differ by more."""
    found = []
    for law in sorted(one.laws.keys() & other.laws.keys()):
        a, b = one.laws[law], other.laws[law]
        if a[0] != b[0] or (a[1] is None) != (b[1] is None) or \
                a[1] is not None and _is_far(a[1], b[1], spread, abs(a[2] or 0)):
            found.append((law, a, b))
    return found


def agrees(one: Bundle, other: Bundle) -> bool:
    """Whether the other is a second run of the same, not a copy, and disagrees in nothing."""
    return (one.identity == other.identity and one.about["date"] != other.about["date"]
            and one.laws != other.laws and one.laws.keys() == other.laws.keys()
            and not disagreements(one, other))


def disagreements(one: Bundle, other: Bundle) -> list[tuple[str, Row, Row]]:
    """Laws whose outcomes differ, or whose numbers differ by more than the spread. Numbers of cost
    are by a clock: their outcome alone counts."""
    spread = min(one.about["spread"], other.about["spread"])
    return [(law, a, b) for law, a, b in differences(one, other, spread)
            if a[0] != b[0] or not law.startswith("cost.")]
