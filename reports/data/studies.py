"""Studies as a run wrote them: curves, maps and tables. Read by results.py."""
from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, TypeVar

import h5py
import numpy as np

from data.hdf5_values import (
    Column, attributes_of, columns_of, from_attributes, in_order, numbers_of, text_of
)

Axes = TypeVar("Axes", bound="OnAxes")


@dataclass
class Curve:
    """y against x; points below `floor` mean nothing (NaN: no floor). pair_orders has one entry
    less than x, or is None. `slope` is the one expected in log-log axes (NaN: none). marks has one
    entry for each point, or is None."""
    label: str
    x: np.ndarray
    y: np.ndarray
    floor: float
    pair_orders: np.ndarray | None
    slope: float
    marks: np.ndarray | None    # "measured" | "unfinished" | "diverged"


@dataclass
class OnAxes:
    """Fields common to figures and maps."""
    name: str
    title: str
    caption: str
    x_label: str
    x_unit: str
    y_label: str
    y_unit: str
    x_scale: str       # "linear" | "log"
    y_scale: str
    curves: list[Curve]


@dataclass
class StudyFigure(OnAxes):
    """One set of axes. `slope` is the expected slope in log-log axes (NaN: none)."""
    slope: float


@dataclass
class StudyMap(OnAxes):
    """A quantity over two parameters, with limits known beforehand as curves over it."""
    quantity: str
    unit: str          # of the values
    scale: str         # of the values
    x: np.ndarray      # n
    y: np.ndarray      # m
    values: np.ndarray  # m x n; NaN where there is none, as the caption says


@dataclass
class Table:
    """A titled table of columns of equal length."""
    title: str
    columns: list[Column]


@dataclass
class Study:
    """A measured rate or cost, with its curves and tables."""
    name: str
    claim: str
    source: str
    about: str
    seconds: float
    figures: list[StudyFigure]
    tables: list[Table]
    maps: list[StudyMap] = field(default_factory=list)


def study_of(name: str, group: h5py.Group) -> Study:
    """A study as it stands in a group of run.h5."""
    return from_attributes(
        Study, attributes_of(group), name=name,
        figures=[_on_axes(StudyFigure, *figure) for figure in in_order(group, "figures")],
        maps=[_map(*study_map) for study_map in in_order(group, "maps")],
        tables=[
            Table(text_of(attributes_of(table), "title") or key, columns_of(table))
            for key, table in in_order(group, "tables")
        ],
    )


def _map(name: str, group: h5py.Group) -> StudyMap:
    x, y, values = (numbers_of(group, key) for key in ("x", "y", "values"))
    scale = text_of(attributes_of(group), "scale") or "linear"
    return _on_axes(
        StudyMap, name, group, scale=scale, x=x, y=y, values=values.reshape(len(y), len(x))
    )


def _on_axes(kind: type[Axes], name: str, group: h5py.Group, **known: Any) -> Axes:
    said = attributes_of(group)
    scales = {key: text_of(said, key) or "linear" for key in ("x_scale", "y_scale")}
    curves = [_curve(*curve) for curve in in_order(group, "curves")]
    return from_attributes(kind, said, name=name, curves=curves, **scales, **known)


def _curve(name: str, group: h5py.Group) -> Curve:
    attributes = attributes_of(group)
    x, y = (np.asarray(group[key], dtype=float) for key in "xy")
    return from_attributes(
        Curve, attributes, label=text_of(attributes, "label") or name, x=x, y=y,
        pair_orders=numbers_of(group, "pair_orders"),
        marks=group["marks"].asstr()[:] if "marks" in group else None
    )
