"""Marks for runs without an error to draw: a strip above the others for those that diverged, and
hollow markers for those on whose way a solve did not finish."""
from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle
from matplotlib.ticker import FuncFormatter

from data.studies import Curve
from plots.plot_style import BAND, MUTED, Pen

# height of one curve's row in the strip, as a fraction of the axes' height
ROW = 0.034
CLIP = 0.45                          # of the floor, where runs below it stand


def has_mark(curve: Curve, mark: str) -> np.ndarray:
    """Of each point: does it have this mark?"""
    return np.zeros(len(curve.x), dtype=bool) if curve.marks is None else curve.marks == mark


def is_marked(curves: list[Curve]) -> bool:
    """Does a figure with these curves say of its points what they stand for?"""
    return any(curve.marks is not None for curve in curves)


def diverged_x(curves: list[Curve]) -> np.ndarray:
    """Where the diverged runs of all curves stand."""
    return np.concatenate([curve.x[has_mark(curve, "diverged")] for curve in curves])


def clip_levels(curve: Curve, y: np.ndarray) -> np.ndarray:
    """Levels to draw: of marked runs, those that err less than the
    reference stand just below its floor."""
    return y if curve.marks is None or not curve.floor > 0 else np.maximum(y, CLIP * curve.floor)


def draw_strip(axes: Axes, curves: list[Curve], pens: list[Pen]) -> None:
    """A strip at the top of the axes with a row for every curve that
    has diverged runs, each at its x."""
    rows = [(curve.x[has_mark(curve, "diverged")], pen) for curve, pen in zip(curves, pens)
            if has_mark(curve, "diverged").any()]
    if not rows:
        return
    height = ROW * (len(rows) + 1)
    _add_headroom(axes, height)
    axes.add_patch(
        Rectangle(
            (0, 1 - height), 1, height, transform=axes.transAxes, facecolor=BAND, edgecolor="none",
            zorder=0.5
        )
    )
    axes.plot(
        [0, 1], [1 - height] * 2, transform=axes.transAxes, color=MUTED, linewidth=0.7, zorder=2
    )
    axes.annotate(
        "diverged", (0.005, 1 - height), xycoords="axes fraction", xytext=(0, 2), fontsize=6.8,
        textcoords="offset points", ha="left", va="bottom", color=MUTED, zorder=6
    )
    for row, (x, pen) in enumerate(rows):
        axes.plot(
            x, np.full(len(x), 1 - ROW * (row + 0.8)), transform=axes.get_xaxis_transform(),
            zorder=4, linestyle="none", marker=pen.marker, markersize=3.2, color=pen.colour,
            markeredgewidth=0.6, scaley=False
        )


def _add_headroom(axes: Axes, height: float) -> None:
    """Raises the upper limit of y, so that what was shown fills the axes but for `height` of them,
    where no tick is named."""
    bottom, top = axes.get_ylim()
    if axes.get_yscale() == "log":
        axes.set_ylim(bottom, bottom * (top / bottom) ** (1 / (1 - height)))
    else:
        axes.set_ylim(bottom, bottom + (top - bottom) / (1 - height))
    name = axes.yaxis.get_major_formatter()
    axes.yaxis.set_major_formatter(
        FuncFormatter(lambda value, place: name(value, place) if value < top else "")
    )
