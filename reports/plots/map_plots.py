"""Maps of a study: a quantity over two parameters as a heat map, with its colour bar, the points
without a value hatched, and the curves that theory expects drawn
over it with their names on them."""
from __future__ import annotations

from pathlib import Path
from textwrap import fill

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure

from data.quantities import number_text
from data.formulas import formula_text
from data.studies import Curve, StudyMap
from plots.plot_style import (
    INK, PAPER, Plot, draw_colour_bar, finish, hatch, label_axes, level_text, new_figure,
    say_in_the_middle, scale_axis, with_unit
)

WIDTH, HEIGHT = 5.6, 4.0  # [inch]
# perceptually uniform, readable without colour vision, and in grey
COLOURS_OF_VALUES = "viridis"
DASHES = ("solid", (0, (5, 2)), (0, (1.5, 1.5)), (0, (6, 2, 1.5, 2)))
MOST_ROWS = 8  # of a map whose rows are all named
LABEL_WIDTH = 30  # characters of a line of a label


def plot_study_map(study_map: StudyMap, name: str, folder: Path) -> Plot:
    """Draws one map of a study and writes its files."""
    canvas = new_figure(WIDTH, HEIGHT)
    axes = canvas.add_axes((0.105, 0.125, 0.735, 0.78))
    label_axes(axes, study_map.x_label, study_map.x_unit, study_map.y_label, study_map.y_unit)
    axes.grid(False)
    drawable = _drawable(study_map)
    if not drawable.any() or not _places_are_good(study_map):
        say_in_the_middle(axes, "no values to draw")
        return finish(canvas, name, folder, study_map.title)
    for which, scale, places in (
        ("x", study_map.x_scale, study_map.x), ("y", study_map.y_scale, study_map.y)
    ):
        scale_axis(axes, which, scale, places)
    if len(study_map.y) <= MOST_ROWS:
        axes.set_yticks(study_map.y, [level_text(value) for value in study_map.y])
    colours = _draw_values(axes, study_map, drawable)
    _draw_colour_bar(canvas, study_map, colours)
    _draw_curves(axes, study_map.curves)
    return finish(canvas, name, folder, study_map.title)


def map_notes(study_map: StudyMap) -> list[str]:
    """Notes that a reader of the map needs."""
    hatched = int((~_drawable(study_map)).sum())
    if not hatched:
        return []
    why = (
        "NaN, infinite, or not positive on a logarithmic scale"
        if study_map.scale == "log"
        else "NaN or infinite"
    )
    return [
        f"Hatched: {number_text(hatched)} of {number_text(study_map.values.size)} points without a"
        f" value ({why})."
    ]


def edges_of(places: np.ndarray, scale: str) -> np.ndarray:
    """The borders of the cells around ascending places: halfway between
    them, on the axis's own scale."""
    at = np.log10(places) if scale == "log" else np.asarray(places, dtype=float)
    if len(at) == 1:
        borders = np.array([at[0] - 0.5, at[0] + 0.5])
    else:
        middles = 0.5 * (at[1:] + at[:-1])
        borders = np.concatenate([[2 * at[0] - middles[0]], middles, [2 * at[-1] - middles[-1]]])
    return 10.0**borders if scale == "log" else borders


def _drawable(study_map: StudyMap) -> np.ndarray:
    good = np.isfinite(study_map.values)
    return good & (study_map.values > 0) if study_map.scale == "log" else good


def _places_are_good(study_map: StudyMap) -> bool:
    return all(
        np.isfinite(places).all()
        and (np.diff(places) > 0).all()
        and (scale != "log" or places[0] > 0)
        for places, scale in ((study_map.x, study_map.x_scale), (study_map.y, study_map.y_scale))
    )


def _draw_values(axes: Axes, study_map: StudyMap, drawable: np.ndarray) -> ScalarMappable:
    """The cells; where one has no value, the hatching below them shows."""
    x, y = edges_of(study_map.x, study_map.x_scale), edges_of(study_map.y, study_map.y_scale)
    axes.set_xlim(x[0], x[-1])
    axes.set_ylim(y[0], y[-1])
    if not drawable.all():
        hatch(axes)
    values = np.ma.masked_where(~drawable, study_map.values)
    return axes.pcolormesh(
        x, y, values, cmap=COLOURS_OF_VALUES, norm=_norm(values.compressed(), study_map.scale),
        rasterized=True, zorder=1
    )


def _norm(values: np.ndarray, scale: str) -> Normalize:
    low, high = float(values.min()), float(values.max())
    if scale == "log":
        return LogNorm(low, high) if high > low else LogNorm(low / 2, high * 2)
    return Normalize(low, high) if high > low else Normalize(low - 0.5, high + 0.5)


def _draw_colour_bar(canvas: Figure, study_map: StudyMap, colours: ScalarMappable) -> None:
    axes = canvas.add_axes((0.865, 0.125, 0.028, 0.78))
    draw_colour_bar(axes, colours, with_unit(study_map.quantity, study_map.unit), 38)
    limits = colours.norm.vmin, colours.norm.vmax
    scale_axis(axes, "y", study_map.scale, np.array(limits))
    axes.set_ylim(*limits)


def _draw_curves(axes: Axes, curves: list[Curve]) -> None:
    paths = []
    for index, curve in enumerate(curves):
        good = np.isfinite(curve.x) & np.isfinite(curve.y)
        x, y = curve.x[good], curve.y[good]
        style = DASHES[index % len(DASHES)]
        if len(x) == 1:  # a place, not a line
            axes.plot(x, y, "o", color=INK, markeredgecolor=PAPER, markersize=7, zorder=5)
        axes.plot(x, y, color=PAPER, linewidth=3.6, zorder=3, scalex=False, scaley=False)
        axes.plot(
            x, y, color=INK, linewidth=1.4, linestyle=style, zorder=4, scalex=False, scaley=False
        )
        paths.append(_path(axes, x, y))
    names: list[np.ndarray] = []
    for index, (curve, path) in enumerate(zip(curves, paths)):
        place = _place_of_name(path, names, paths[:index] + paths[index + 1 :])
        if place is not None:
            names.append(place)
            axes.text(
                *place,
                fill(formula_text(curve.label), LABEL_WIDTH),
                transform=axes.transAxes,
                ha="center",
                va="center",
                fontsize=7.4,
                color=INK,
                zorder=6,
                bbox={
                    "facecolor": PAPER, "edgecolor": "none", "boxstyle": "round,pad=0.25",
                    "alpha": 0.9
                },
            )


def _place_of_name(
    path: np.ndarray, names: list[np.ndarray], others: list[np.ndarray]
) -> np.ndarray | None:
    """Where on a curve its name stands: farthest from the frame, from other names and from other
    curves; None if the curve is not in the picture. Distances count
    less across, since names are wide."""
    if not len(path):
        return None
    across, up = path.T
    clearance = np.minimum(np.minimum(across, 1 - across) - 0.08, 1.5 * np.minimum(up, 1 - up))
    obstacles = [name[None, :] for name in names] + [other for other in others if len(other)]
    for obstacle in obstacles:
        apart = path[:, None, :] - obstacle[None, :, :]
        clearance = np.minimum(
            clearance, np.hypot(apart[:, :, 0], 2.0 * apart[:, :, 1]).min(axis=1)
        )
    return path[int(np.argmax(np.minimum(clearance, 0.3)))]


def _path(axes: Axes, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """The part of a curve inside the axes, in their coordinates from 0 to 1, in small steps."""
    with np.errstate(all="ignore"):
        path = axes.transAxes.inverted().transform(
            axes.transData.transform(np.column_stack([x, y]))
        )
    path = path[np.isfinite(path).all(axis=1)]
    if len(path) > 1:
        lengths = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))])
        at = np.linspace(0.0, lengths[-1], 200)
        path = np.column_stack([np.interp(at, lengths, path[:, k]) for k in (0, 1)])
    return path[((path > 0.02) & (path < 0.98)).all(axis=1)]
