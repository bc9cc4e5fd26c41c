"""Attributes, columns and ordered groups of an HDF5 file as plain Python values. An absent
attribute becomes "" or NaN, an absent group an empty list."""
from __future__ import annotations

import re
from dataclasses import dataclass
from math import isnan
from typing import Any, TypeVar

import h5py
import numpy as np

from data.records import types_of

T = TypeVar("T")


@dataclass
class Column:
    """One column of a table: numbers, or strings as an object array."""
    name: str
    unit: str
    values: np.ndarray


def columns_of(group: h5py.Group | None) -> list[Column]:
    """The datasets of a group, in the order that they give."""
    if group is None:
        return []
    sets = [(key, item) for key, item in group.items() if isinstance(item, h5py.Dataset)]
    sets.sort(key=_place)
    return [
        Column(plain(key), text_of(attributes_of(item), "unit"), _values(item))
        for key, item in sets
    ]


def _values(data: h5py.Dataset) -> np.ndarray:
    values = data[()]
    if np.asarray(values).dtype.kind in "OSU":
        return np.array([_decode(value) for value in np.atleast_1d(values)], dtype=object)
    return np.atleast_1d(np.asarray(values, dtype=float))


def numbers_of(group: h5py.Group, key: str) -> np.ndarray | None:
    """An array of numbers; None if there is none."""
    return np.asarray(group[key], dtype=float) if key in group else None


def in_order(group: h5py.Group, key: str) -> list[tuple[str, h5py.Group]]:
    """Names and groups inside group/key, in the order that they give."""
    inner = [
        (name, item) for name, item in group.get(key, {}).items() if isinstance(item, h5py.Group)
    ]
    return [(plain(name), item) for name, item in sorted(inner, key=_place)]


def _place(entry: tuple[str, h5py.Group | h5py.Dataset]) -> tuple[float, str]:
    name, item = entry
    return number_of({"order": item.attrs.get("order", 0)}, "order", 0), name


def attributes_of(item: h5py.Group | h5py.Dataset) -> dict[str, Any]:
    """All attributes, texts decoded."""
    return {plain(key): _decode(value) for key, value in item.attrs.items()}


# Characters that XML, and so SVG and the page, does not allow: control characters, halves of
# surrogate pairs (which is how bytes that are no UTF-8 come), and two that are no characters.
_NO_TEXT = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")


def plain(text: str) -> str:
    """The text with U+FFFD for all that cannot be shown."""
    return _NO_TEXT.sub("\ufffd", text)


def _decode(value: Any) -> Any:
    if isinstance(value, bytes):
        return plain(value.decode("utf-8", "replace"))
    if isinstance(value, str):
        return plain(value)
    if isinstance(value, np.ndarray) and value.dtype.kind in "OSU":
        return [_decode(entry) for entry in value.ravel()]
    return value


def text_of(attributes: dict[str, Any], key: str) -> str:
    """A text, "" if absent."""
    value = attributes.get(key, "")
    return "" if isinstance(value, h5py.Empty) else str(value)


def texts_of(attributes: dict[str, Any], key: str) -> list[str]:
    """A list of texts that are not empty."""
    value = attributes.get(key, [])
    if isinstance(value, str):
        value = [value]
    return [] if isinstance(value, h5py.Empty) else [str(entry) for entry in value if str(entry)]


def number_of(attributes: dict[str, Any], key: str, absent: float = float("nan")) -> float:
    """A number, `absent` if there is none."""
    value = attributes.get(key, absent)
    try:
        return float(np.ravel(value)[0])
    except (TypeError, ValueError, IndexError):
        return absent


def from_attributes(kind: type[T], said: dict[str, Any], **known: Any) -> T:
    """A dataclass, each field from the attribute of its name: texts, lists of texts and numbers; an
    absent one is "", [] or NaN, an absent whole number 0. All other fields are `known`."""
    readers = {str: text_of, float: number_of, int: _whole_number, list[str]: texts_of}
    for name, of in types_of(kind).items():
        if name not in known and of in readers:
            known[name] = readers[of](said, name)
    return kind(**known)


def _whole_number(said: dict[str, Any], name: str) -> int:
    value = number_of(said, name)
    return 0 if isnan(value) else int(value)
