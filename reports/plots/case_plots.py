"""Diagnostics of one simulation against time: energies, momenta, the step,
the conjugate gradient solves."""
from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from data.quantities import superscript
from data.results import Case, Column
from plots.plot_style import (
    COLOURS, INK, Plot, finish, label_axes, new_figure, say_in_the_middle, scale_axis
)
from plots.study_plots import spread

WIDTH, HEIGHT = 5.3, 3.1            # [inch]
# per line; longer histories show mean and extremes of so many stretches
MOST_POINTS = 300
ENERGIES = (
    "kinetic_energy", "stretch_energy", "bending_energy", "gravity_energy", "custom_energy",
    "sticking_energy"
)
INKS = (0, 1, 2, 3, 5, 7)           # of present energies; 4 and 6 are those of the work of damping

Line = tuple[str, np.ndarray, str, float]   # label, values, colour, width


def plot_diagnostics(case: Case, name: str, folder: Path) -> list[tuple[str, Plot]]:
    """Every diagnostics plot that the data allow, each with its caption."""
    if "time" not in case.diagnostics or len(case.diagnostics["time"].values) < 2:
        return []
    makers = (("energies", _energies), ("momenta", _momenta), ("step", _steps), ("solves", _solves))
    made = []
    for part, maker in makers:
        panels, caption = maker(case.diagnostics)
        if panels:
            time = case.diagnostics["time"].values
            if len(time) > MOST_POINTS:
                caption += (". Lines are means, bands run from the least to the largest value, "
                            f"over each {MOST_POINTS}th of the steps")
            made.append((caption, _plot(time, panels, f"{name}-{part}", folder, caption)))
    return made


Panel = tuple[str, str, str, list[Line]]    # label, unit, scale, lines


def _energies(columns: dict[str, Column]) -> tuple[list[Panel], str]:
    present = [key for key in ENERGIES if key in columns and columns[key].values.any()]
    if not present:
        return [], ""
    lines: list[Line] = [
        (key.removesuffix("_energy"), columns[key].values, COLOURS[INKS[ENERGIES.index(key)]], 1.1)
        for key in present
    ]
    total = np.sum([columns[key].values for key in present], axis=0)
    lines.append(("total", total, INK, 1.8))
    shown, kept = "Energies that are not zero throughout", "Their total"
    if "damping_work" in columns and columns["damping_work"].values.any():
        work = columns["damping_work"].values
        lines += [("damping work", work, COLOURS[4], 1.1),
                  ("total \u2212 damping work", total - work, COLOURS[6], 1.1)]
        shown, kept = f"{shown}, and the work done by damping so far", "Total minus damping work"
    caption = (
        f"{shown}. {kept} changes only by what else does work: moving supports, filters, and the"
        " error of the integrator"
    )
    if "bonds" in columns and columns["bonds"].values.any():
        caption += ". The damping of bonds counts as if what they hold to were at rest"
    return [("energy", columns[present[0]].unit or "J", "linear", lines)], caption


def _momenta(columns: dict[str, Column]) -> tuple[list[Panel], str]:
    panels: list[Panel] = []
    for key in ("linear_momentum", "angular_momentum"):
        if key in columns and columns[key].values.ndim == 2 and columns[key].values.any():
            values = columns[key].values
            panels.append((key.replace("_", " "), columns[key].unit, "linear",
                           [(axis, values[:, k], COLOURS[k], 1.1) for k, axis in enumerate("xyz")]))
    return panels, "Linear momentum, and angular momentum about the origin"


def _steps(columns: dict[str, Column]) -> tuple[list[Panel], str]:
    panels = _single_panels(
        columns, (("step", "step"), ("step_over_elastic_limit", "step / elastic limit")), "linear"
    )
    return panels, "Time step, and its ratio to the elastic stability limit"


def _solves(columns: dict[str, Column]) -> tuple[list[Panel], str]:
    """Nothing where no step solves anything: without damping B and C divide by masses only."""
    if "cg_iterations" not in columns or not columns["cg_iterations"].values.any():
        return [], ""
    panels = _single_panels(columns, (("cg_iterations", "CG iterations a step"),), "linear")
    if "cg_residual" in columns and (columns["cg_residual"].values > 0).any():
        panels += _single_panels(columns, (("cg_residual", "relative residual"),), "log")
    return panels, "Conjugate gradient iterations per step, and the residual that they left"


def _single_panels(columns: dict[str, Column], wanted: tuple[tuple[str, str], ...],
                   scale: str) -> list[Panel]:
    return [(label, columns[key].unit, scale, [("", columns[key].values, COLOURS[0], 1.0)])
            for key, label in wanted if key in columns and np.isfinite(columns[key].values).any()]


def _plot(time: np.ndarray, panels: list[Panel], name: str, folder: Path, caption: str) -> Plot:
    figure = new_figure(WIDTH, HEIGHT)
    height = 0.76 if len(panels) == 1 else 0.315
    for k, (label, unit, scale, lines) in enumerate(panels):
        axes = figure.add_axes(
            (0.095, 0.145 + (len(panels) - 1 - k) * 0.445, _width(lines), height)
        )
        values = [line[1] for line in lines]
        factor, shown_unit = (1.0, unit) if scale == "log" else _power_of_ten(values, unit)
        label_axes(axes, "time" if k == len(panels) - 1 else "", "s", label, shown_unit)
        _draw_lines(axes, time, lines, scale, factor)
        if k < len(panels) - 1:
            axes.set_xlabel("")
            axes.tick_params(labelbottom=False)
    return finish(figure, name, folder, caption)


def _width(lines: list[Line]) -> float:
    """Width of the axes, as a fraction of the figure's, that leaves room for the lines' labels."""
    return 0.855 - 0.0125 * max(len(label) for label, *_ in lines)


def _draw_lines(axes: Axes, time: np.ndarray, lines: list[Line], scale: str, factor: float) -> None:
    drawn = [thin_out(time, values / factor) for _, values, _, _ in lines]
    everything = np.concatenate([values / factor for _, values, _, _ in lines])
    everything = everything[np.isfinite(everything) & ((everything > 0) | (scale != "log"))]
    if not len(everything):
        return say_in_the_middle(axes, "no finite values")
    scale_axis(axes, "x", "linear", time)
    scale_axis(axes, "y", scale, everything)
    for history, (_, _, colour, width) in zip(drawn, lines):
        if np.nanmax(history.largest - history.least, initial=0.0) > 0.01 * np.ptp(everything):
            axes.fill_between(
                history.t, history.least, history.largest, facecolor=colour, alpha=0.28, linewidth=0
            )
        axes.plot(history.t, history.y, color=colour, linewidth=width)
    axes.set_xlim(time[0], max(time[-1], np.nextafter(time[0], np.inf)))
    _set_y_limits(axes, everything, scale)
    to_axes = axes.transData + axes.transAxes.inverted()
    ends = [
        float(to_axes.transform((time[-1], h.y[-1]))[1]) if np.isfinite(h.y[-1]) else 0.0
        for h in drawn
    ]
    heights = spread(ends, 0.085 if len(lines) > 3 else 0.2)
    for (label, _, colour, _), height, end in zip(lines, heights, ends):
        if label:
            axes.plot(
                [1.005, 1.03], [end, height], transform=axes.transAxes, clip_on=False, color=colour,
                linewidth=0.5
            )
            axes.text(
                1.04, height, label, transform=axes.transAxes, ha="left", va="center", fontsize=7.4,
                color=colour
            )


def _set_y_limits(axes: Axes, values: np.ndarray, scale: str) -> None:
    if not len(values):
        return
    low, high = float(values.min()), float(values.max())
    if scale == "log":
        axes.set_ylim(low / 2, high * 2)
        return
    if low == high == 0.0:
        axes.set_ylim(-0.1, 1.0)
        return
    margin = (
        0.06 * (high - low)
        if high - low > 1e-6 * max(abs(low), abs(high))
        else 0.1 * abs(high) or 1.0
    )
    bottom = 0.0 if 0 <= low < 0.5 * high else low - margin
    axes.set_ylim(bottom, high + margin)


def _power_of_ten(values: list[np.ndarray], unit: str) -> tuple[float, str]:
    """A factor 10^(3k) that brings the ticks to plain numbers, and the unit that says so."""
    finite = np.concatenate([entry[np.isfinite(entry)] for entry in values])
    largest = float(np.abs(finite).max()) if len(finite) else 0.0
    if largest == 0.0 or 0.05 <= largest < 1e4:
        return 1.0, unit
    exponent = 3 * int(np.floor(np.log10(largest) / 3))
    power = "10" + superscript(str(exponent))
    return 10.0 ** exponent, f"{power} {unit}" if unit not in ("", "1") else power


@dataclass
class History:
    """A line against time; for long histories its mean, least and largest
    value in each stretch of time."""
    t: np.ndarray
    y: np.ndarray
    least: np.ndarray
    largest: np.ndarray


def thin_out(t: np.ndarray, y: np.ndarray) -> History:
    """The history as it is up to MOST_POINTS points, else summed up in that
    many stretches. NaN stays NaN."""
    if len(t) <= MOST_POINTS:
        return History(t, y, y, y)
    starts = np.linspace(0, len(t), MOST_POINTS, endpoint=False).astype(int)
    count = np.diff(np.append(starts, len(t)))
    return History(np.add.reduceat(t, starts) / count, np.add.reduceat(y, starts) / count,
                   np.minimum.reduceat(y, starts), np.maximum.reduceat(y, starts))
