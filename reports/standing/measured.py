"""What laws measured beside their verdicts, of all runs: moduli by mesh, and error against cost in
steps of the reference. Arranges tables of bundles; judges nothing."""
from __future__ import annotations

import tempfile
from dataclasses import dataclass
from itertools import product
from math import nan
from pathlib import Path
from typing import Any

import numpy as np
from markupsafe import Markup

from data.bundle import Bundle
from data.studies import Curve, StudyFigure
from pages.figure_words import figure_keys
from plots.plot_style import Plot, use_style
from plots.study_plots import plot_study_figure

COLUMNS = (4, 8, 12)  # of the meshes
MESHES = tuple(product(("equilateral", "one diagonal"), "xy"))
COST_LAW = "order.halved-steps-approach-a-limit"


@dataclass(frozen=True)
class Parameter:
    """A parameter of the scene, and the law that measures it by mesh."""
    name: str
    value: str              # in the scene, with its unit
    law: str
    scale: float            # the value [SI]


PARAMETERS = (
    Parameter("Young's modulus", "5 N/m", "calibration.modulus-survives-refinement", 5),
    Parameter("Bending rigidity", "0.001 N m", "calibration.rigidity-survives-refinement", 1e-3),
)


def columns_of(bundle: Bundle, law: str, part: str = "laws") -> dict[str, list[Any]]:
    """Cells by the column's name; empty if the bundle has no such table."""
    return {name: cells for name, _, cells in bundle.evidence[part].get(law, [])}


def by_mesh(bundle: Bundle, parameter: Parameter) -> list[float | None]:
    """Measured over the scene's [1], for each of MESHES and COLUMNS; None: not measured."""
    table = columns_of(bundle, parameter.law)
    found: dict[Any, Any] = {}
    for row in range(len(table.get("pattern", ()))):
        cells = {name: values[row] for name, values in table.items()}
        for axis in [cells["along"]] if "along" in cells else "xy":
            value = cells.get("bending rigidity" if "along" in cells else f"along {axis}")
            if isinstance(value, (int, float)):
                found[cells["pattern"], axis, cells.get("columns")] = value / parameter.scale
    return [found.get((*mesh, columns)) for mesh in MESHES for columns in COLUMNS]


def is_in(bundle: Bundle, parameter: Parameter) -> bool:
    """Whether it was measured on some mesh."""
    return any(cell is not None for cell in by_mesh(bundle, parameter))


def cost_rows(bundle: Bundle, part: str = "laws") -> list[tuple[float, float, float, float]]:
    """For each step: steps, error [1], seconds [s], seconds over those of a step of the reference
    on that machine [1]. Empty where the motion approaches no limit."""
    row = getattr(bundle, part).get(COST_LAW, [""])
    reference = _points(bundle, "yardstick")
    if row[0] != "holds" or not reference:
        return []
    step = min(seconds / steps for steps, _, seconds in reference)  # what disturbs adds to it
    return [(*point, point[2] / step) for point in _points(bundle, part)]


def _points(bundle: Bundle, part: str) -> list[tuple[float, float, float]]:
    table = columns_of(bundle, COST_LAW, part)
    names = ("steps", "error", "seconds by the clock")
    rows = zip(*(table.get(name, ()) for name in names))
    return [row for row in rows if all(isinstance(cell, (int, float)) and 0 < cell < 1e9
                                       for cell in row)]


@dataclass(frozen=True)
class Costs:
    """The figure, the keys of its curves, and the rows of the table below it, by label."""
    plot: Plot
    keys: list[tuple[Markup, str]]
    rows: list[tuple[str, Any]]


def costs_of(runs: list[tuple[str, Bundle]]) -> Costs | None:
    """runs: label and bundle. None where no run approaches a limit."""
    rows = [(label, found) for label, bundle in runs if (found := cost_rows(bundle))]
    if not rows:
        return None
    yardstick = next(bundle for _, bundle in runs if cost_rows(bundle))
    rows.append(("reference, the yardstick", cost_rows(yardstick, "yardstick")))
    curves = [Curve(label, np.array([one[3] for one in found]), np.array([one[1] for one in found]),
                    nan, None, nan, None) for label, found in rows]
    figure = StudyFigure(
        name="error_against_cost", title="Error against cost", caption="",
        x_label="cost, in steps of the reference on the same machine", x_unit="1",
        y_label="error of the time step, over the motion", y_unit="1", x_scale="log", y_scale="log",
        curves=curves, slope=nan)
    use_style()
    with tempfile.TemporaryDirectory() as folder:
        plot = plot_study_figure(figure, "error-against-cost", Path(folder))
    return Costs(plot, figure_keys(figure), rows)
