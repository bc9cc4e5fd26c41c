"""Dataclasses from objects of JSON: a field is filled with what stands under its name."""
from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING, fields
from functools import cache
from math import nan
from typing import Any, TypeVar, get_type_hints

T = TypeVar("T")


@cache
def types_of(kind: type) -> dict[str, Any]:
    """The types of its fields."""
    return get_type_hints(kind)


def record(kind: type[T], said: Mapping[str, Any], **known: Any) -> T:
    """From an object of JSON; `known` are fields that stand under no name of it. null becomes NaN
    in a field for a number. Throws KeyError for a field that is not there and has no default."""
    types = types_of(kind)
    for field in fields(kind):  # type: ignore[arg-type]
        if field.name in known:
            continue
        if field.name in said:
            value = said[field.name]
            if types[field.name] is float:
                value = nan if value is None else float(value)
            known[field.name] = value
        elif field.default is MISSING and field.default_factory is MISSING:
            raise KeyError(field.name)
    return kind(**known)
