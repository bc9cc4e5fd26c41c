"""The slopes that theory expects, as triangles: one that all curves of a figure
share, or one beside each curve."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes

from data.quantities import number_text
from plots.plot_style import INK, Pen, Points


@dataclass
class Triangle:
    """In log10 of the axes: from (start, base) over `width` to (start + width, base + rise)."""
    start: float
    base: float
    width: float
    rise: float
    is_below: bool      # its curves lie above it

    def span(self, at: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Lowest and highest level of the triangle over the places `at` inside it."""
        on_line = self.base + self.rise * (at - self.start) / self.width
        ends = (self.base, self.base + self.rise)
        return (
            (np.full_like(at, min(ends)), on_line)
            if self.is_below
            else (on_line, np.full_like(at, max(ends)))
        )


def draw_common_slope(axes: Axes, shown: list[Points], pens: list[Pen], slope: float) -> None:
    """A triangle of the expected slope, where it needs the least extra
    room below or above the curves."""
    if not np.isfinite(slope) or slope == 0:
        return
    (bottom, top), gap = np.log10(axes.get_ylim()), _gap(axes, pens)
    places = []
    for place in _places(axes, shown, slope, gap):
        low, high = min(place.base, place.base + place.rise), max(
            place.base, place.base + place.rise
        )
        beyond = bottom - (low - gap) if place.is_below else high + gap - top
        places.append((max(0.0, beyond), place))
    if not places:
        return
    side = np.sign(slope)
    _, best = min(
        places, key=lambda one: (round(one[0], 3), not one[1].is_below, -one[1].start * side)
    )
    _draw(axes, best, slope, gap)


def draw_own_slopes(axes: Axes, shown: list[Points], pens: list[Pen], slopes: list[float]) -> None:
    """For every curve with a slope of its own a triangle beside it, where the other curves and
    triangles leave the most room."""
    gap = 0.6 * _gap(axes, pens)
    drawn: list[Triangle] = []
    for index, slope in enumerate(slopes):
        if not np.isfinite(slope) or slope == 0:
            continue
        others = [points for k, points in enumerate(shown) if k != index and len(points[0]) > 1]
        places = [
            (_clearance(axes, place, others, drawn), place)
            for place in _places(axes, [shown[index]], slope, gap)
        ]
        if places:
            drawn.append(max(places, key=lambda one: one[0])[1])
            _draw(axes, drawn[-1], slope, gap)


def _gap(axes: Axes, pens: list[Pen]) -> float:
    """Between a curve and its triangle [decades]."""
    bottom, top = np.log10(axes.get_ylim())
    return (0.06 if max(pen.size for pen in pens) < 8 else 0.1) * (top - bottom)


def _places(axes: Axes, curves: list[Points], slope: float, gap: float) -> list[Triangle]:
    """Triangles that keep the gap from the curves, below and above them, all along the axes."""
    (left, right), (bottom, top) = np.log10(axes.get_xlim()), np.log10(axes.get_ylim())
    width = 0.22 * (right - left)
    rise = slope * width
    if abs(rise) > 0.4 * (top - bottom):
        width, rise = width * 0.4 * (top - bottom) / abs(rise), np.sign(rise) * 0.4 * (top - bottom)
    first = left + (0.04 if slope > 0 else 0.08) * (right - left)
    places = []
    for start in np.linspace(first, right - width - 0.05 * (right - left), 12):
        here = _envelope(curves, start, start + width, slope)
        if here is not None:
            places.append(Triangle(start, here[0] - gap, width, rise, True))
            places.append(Triangle(start, here[1] + gap, width, rise, False))
    return places


def _clearance(axes: Axes, place: Triangle, others: list[Points], drawn: list[Triangle]) -> float:
    """Least distance up or down to other curves, triangles and the frame
    [decades]; negative where they meet."""
    at = np.linspace(place.start, place.start + place.width, 15)
    low, high = place.span(at)
    bottom, top = np.log10(axes.get_ylim())
    clearance = min(low.min() - bottom, top - high.max())
    for x, y in others:
        order = np.argsort(x)
        level = np.interp(at, np.log10(x[order]), np.log10(y[order]), left=np.nan, right=np.nan)
        apart = np.fmax(level - high, low - level)[np.isfinite(level)]
        clearance = min(clearance, apart.min(initial=np.inf))
    for other in drawn:
        if other.start < place.start + place.width and place.start < other.start + other.width:
            other_low, other_high = other.span(np.clip(at, other.start, other.start + other.width))
            clearance = min(
                clearance, max(other_low.min() - high.max(), low.min() - other_high.max())
            )
    return float(clearance)


def _envelope(
    shown: list[Points], start: float, stop: float, slope: float
) -> tuple[float, float] | None:
    """Lowest and highest level (log10, at `start`) of lines of the given slope that touch the
    curves over the span."""
    levels = []
    for x, y in shown:
        order = np.argsort(x)
        at, level = np.log10(x[order]), np.log10(y[order])
        if len(at) > 1 and at[0] < stop and at[-1] > start:
            here = np.linspace(max(start, at[0]), min(stop, at[-1]), 9)
            levels.append(np.interp(here, at, level) - slope * (here - start))
    return (min(map(np.min, levels)), max(map(np.max, levels))) if levels else None


def _draw(axes: Axes, place: Triangle, slope: float, gap: float) -> None:
    """The triangle with its numbers; makes room for it."""
    bottom, top = np.log10(axes.get_ylim())
    axes.set_ylim(10 ** min(bottom, place.base + min(place.rise, 0) - 1.3 * gap),
                  10 ** max(top, place.base + max(place.rise, 0) + 1.3 * gap))
    corner_right = (slope > 0) == place.is_below
    x0, x1 = 10 ** place.start, 10 ** (place.start + place.width)
    y0, y1 = 10 ** place.base, 10 ** (place.base + place.rise)
    corner = (x1, y0) if corner_right else (x0, y1)
    axes.fill(
        [x0, x1, corner[0]], [y0, y1, corner[1]], facecolor="none", edgecolor=INK, linewidth=1.2,
        zorder=5, joinstyle="round"
    )
    axes.annotate(number_text(slope), (corner[0], 10 ** (place.base + place.rise / 2)),
                  xytext=(4 if corner_right else -4, 0), textcoords="offset points",
                  ha="left" if corner_right else "right", va="center", fontsize=9.0)
    below = (slope > 0) == corner_right
    axes.annotate(
        "1", (10 ** (place.start + place.width / 2), corner[1]), xytext=(0, -3 if below else 3),
        textcoords="offset points", ha="center", va="top" if below else "bottom", fontsize=9.0
    )
