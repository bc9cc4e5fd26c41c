"""Curves of a study: markers and lines, labels beside the curves, the noise floor; with
slope_triangles.py the slopes that theory expects, with point_marks.py the runs that diverged."""
from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from textwrap import fill

import numpy as np
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.markers import MarkerStyle

from data.formulas import formula_text
from data.studies import Curve, StudyFigure
from plots.plot_style import (
    BAND, COLOURS, INK, MARKERS, MUTED, PAPER, Pen, Plot, Points, finish, label_axes, new_figure,
    say_in_the_middle, scale_axis, variable_of
)
from plots.point_marks import clip_levels, diverged_x, draw_strip, has_mark, is_marked
from plots.slope_triangles import draw_common_slope, draw_own_slopes

WIDTH, HEIGHT = 7.6, 4.0            # [inch]
# least distance of two labels, as a fraction of the axes' height
LABEL_STEP = 0.055
LABEL_WIDTH = 34                    # characters of a line of a label
# curves whose values differ by less than this fraction lie on each other
SAME = 0.03
SAME_SHAPE = 0.02                   # shapes no farther apart, over the figure's extent
MOST_MARKERS = 60                   # points of a curve beyond which it is a line alone
FLOOR_REACH = 1.3                   # decades below the lowest point within which a floor is drawn

# Methods look alike wherever they appear; other curves take their looks in turn.
METHODS = (
    "A", "B", "C", "forward-euler", "RK2", "SSP-RK3", "RK4", "backward-euler",
    "linear-backward-euler", "BDF2", "implicit-midpoint"
)


def plot_study_figure(figure: StudyFigure, name: str, folder: Path) -> Plot:
    """Draws one figure of a study and writes its files."""
    canvas = new_figure(WIDTH, HEIGHT)
    axes = canvas.add_axes((0.085, 0.125, 0.60, 0.78))
    label_axes(axes, figure.x_label, figure.x_unit, figure.y_label, figure.y_unit)
    shown = [_drawable(curve, figure) for curve in figure.curves]
    if not any(len(x) for x, _ in shown):
        say_in_the_middle(axes, "no finite points to draw")
        return finish(canvas, name, folder, figure.title)
    pens = pens_of(figure)
    for axis, scale, values in (("x", figure.x_scale, 0), ("y", figure.y_scale, 1)):
        scale_axis(axes, axis, scale, np.concatenate([points[values] for points in shown]))
    for layer, (curve, pen) in enumerate(zip(figure.curves, pens)):
        _draw_curve(axes, figure, curve, pen, layer)
    _set_limits(axes, figure, shown)
    if is_geometry(figure):
        axes.set_aspect("equal", adjustable="datalim")
        axes.apply_aspect()
    if figure.x_scale == figure.y_scale == "log":
        draw_common_slope(axes, shown, pens, figure.slope)
        draw_own_slopes(axes, shown, pens, [curve.slope for curve in figure.curves])
    _draw_floors(axes, figure, pens)
    draw_strip(axes, figure.curves, pens)
    _label_curves(axes, figure, pens, shown)
    return finish(canvas, name, folder, figure.title)


def is_geometry(figure: StudyFigure) -> bool:
    """Whether a figure shows shapes: lengths over lengths (of m, or of a strip's own: L, or that
    of its bending under gravity), each on a linear axis."""
    return (figure.x_unit == figure.y_unit
            and figure.x_unit in ("m", "L", "(B/(rho_A g))^(1/3)")
            and figure.x_scale == figure.y_scale == "linear")


def pens_of(figure: StudyFigure) -> list[Pen]:
    """The pens of a figure's curves. Of two shapes that lie on each other, the later is drawn in
    the colour of the earlier, by its points alone: a line would hide the other's."""
    pens, curves = choose_pens(figure.curves), figure.curves
    if not is_geometry(figure):
        return pens
    extent = max(float(np.ptp(np.concatenate([getattr(curve, axis) for curve in curves])))
                 for axis in "xy")
    for index, curve in enumerate(curves):
        gaps = [_gap(curve, earlier) for earlier in curves[:index]]
        if gaps and min(gaps) < SAME_SHAPE * extent and len(curve.x) <= MOST_MARKERS:
            pens[index] = replace(pens[index], colour=pens[int(np.argmin(gaps))].colour, width=0.0)
    return pens


def _gap(curve: Curve, line: Curve) -> float:
    """The largest distance of a point of a shape from another's line; infinite where it has none.
    """
    if len(line.x) < 2 or not len(curve.x):
        return float("inf")
    points = np.stack([curve.x, curve.y], axis=-1)[:, None]
    ends = np.stack([line.x, line.y], axis=-1)
    sides = np.diff(ends, axis=0)
    lengths = np.maximum((sides ** 2).sum(-1), 1e-300)
    along = np.clip(((points - ends[:-1]) * sides).sum(-1) / lengths, 0, 1)
    apart = np.linalg.norm(points - ends[:-1] - along[..., None] * sides, axis=-1).min(axis=1)
    return float(np.nan_to_num(apart.max(), nan=np.inf))


def points_left_out(figure: StudyFigure) -> int:
    """How many points cannot be drawn: NaN, infinite, or not positive on a logarithmic axis."""
    return sum(int(((~_is_drawable(curve, figure)) & ~has_mark(curve, "diverged")).sum())
               for curve in figure.curves)


def floors_below(figure: StudyFigure) -> list[float]:
    """The floors that lie too far below the points to be drawn."""
    lowest = _lowest(figure)
    return [curve.floor for curve in figure.curves if np.isfinite(curve.floor)
            and not _floor_shows(curve, lowest)]


def key_svg(pen: Pen, filled: bool = False) -> Markup:
    """The curve's line and marker as a small inline picture, for the page's tables and keys."""
    marker = MarkerStyle(pen.marker)
    outlines = marker.get_path().transformed(marker.get_transform()).to_polygons()
    d = " ".join("M" + "L".join(f"{13 + 8 * x:.2f},{6 - 8 * y:.2f}" for x, y in outline) + "Z"
                 for outline in outlines)
    colour = variable_of(pen.colour)
    picture = Markup('<svg class="key" viewBox="0 0 26 12" aria-hidden="true">'
                     '<path d="{3}" stroke="{0}" stroke-width="1.6"/>'
                     '<path d="{1}" stroke="{0}" stroke-width="1.3" fill="{2}"/></svg>')
    return picture.format(colour, d, colour if filled else "var(--paper)",
                          "M0,6H26" if pen.width else "")


def choose_pens(curves: list[Curve]) -> list[Pen]:
    """One pen for every curve, a method's the same in all figures.

    Within a group of coincident curves the first is the widest.
    """
    groups: list[list[int]] = []
    for index, curve in enumerate(curves):
        home = next((group for group in groups if _coincide(curves[group[0]], curve)), None)
        (home.append(index) if home is not None else groups.append([index]))
    pens: dict[int, Pen] = {}
    for group in groups:
        for depth, index in enumerate(group):
            above = min(len(group) - 1 - depth, 4)
            colour, marker = _look(curves, index)
            pens[index] = Pen(colour, marker, 1.2 + 1.9 * above, 4.6 + 3.6 * above)
    return [pens[index] for index in range(len(curves))]


def _look(curves: list[Curve], index: int) -> tuple[str, str]:
    """Colour and marker: a method's own; ink for what is drawn beside methods; else in turn. Long
    curves have no marker."""
    colour, marker = _look_in_turn(curves, index)
    return colour, marker if len(curves[index].x) <= MOST_MARKERS else ""


def _look_in_turn(curves: list[Curve], index: int) -> tuple[str, str]:
    methods = [method_of(curve.label) for curve in curves]
    if any(methods) and not methods[index]:
        return INK, MARKERS[-1]
    turn = METHODS.index(methods[index]) if methods[index] else index
    return COLOURS[turn % len(COLOURS)], MARKERS[turn % len(MARKERS)]


def method_of(label: str) -> str:
    """The method that a label names: "RK2", "scheme A", "RK2, grows"; "" if it names none."""
    name = label.split(",")[0].removeprefix("scheme ")
    return name if name in METHODS else ""


def _is_drawable(curve: Curve, figure: StudyFigure) -> np.ndarray:
    good = np.isfinite(curve.x) & np.isfinite(curve.y)
    if figure.x_scale == "log":
        good &= curve.x > 0
    if figure.y_scale == "log":
        good &= curve.y > 0
    return good


def _drawable(curve: Curve, figure: StudyFigure) -> Points:
    good = _is_drawable(curve, figure)
    return curve.x[good], clip_levels(curve, curve.y[good])


def _coincide(one: Curve, other: Curve) -> bool:
    if len(one.x) != len(other.x) or not np.allclose(one.x, other.x, rtol=1e-6):
        return False
    scale = np.maximum(np.abs(one.y), np.abs(other.y))
    with np.errstate(invalid="ignore"):
        least = 0.0 if one.y.min() > 0 else 1e-3 * np.nanmax(scale, initial=0.0)
        close = np.abs(one.y - other.y) <= SAME * scale + least
    return bool(np.mean(close) > 0.6)


def _draw_curve(axes: Axes, figure: StudyFigure, curve: Curve, pen: Pen, layer: int) -> None:
    """Line and markers. Where some runs of a figure are marked, hollow means that a solve did not
    finish. The line goes from left to right; that of a shape goes from point to
    point, so that loops can close."""
    good = np.flatnonzero(_is_drawable(curve, figure))
    order = good if is_geometry(figure) else good[np.argsort(curve.x[good], kind="stable")]
    x, y = curve.x[order], clip_levels(curve, curve.y[order])
    axes.plot(x, y, color=pen.colour, linewidth=pen.width, zorder=3 + 0.01 * layer)
    if not pen.marker:
        return
    hollow = (
        has_mark(curve, "unfinished")[order]
        if is_marked(figure.curves)
        else np.ones(len(x), dtype=bool)
    )
    below = curve.y[order] <= curve.floor
    for kind, face in ((hollow, PAPER), (~hollow, pen.colour)):
        for part, size, edge, alpha in (
            (kind & ~below, 1.0, 1.1, 1.0), (kind & below, 0.7, 0.6, 0.5)
        ):
            axes.plot(
                x[part], y[part], linestyle="none", marker=pen.marker, markersize=size * pen.size,
                color=pen.colour, markerfacecolor=face, markeredgewidth=edge, alpha=alpha,
                zorder=4 + 0.01 * layer
            )


def _set_limits(axes: Axes, figure: StudyFigure, shown: list[Points]) -> None:
    for part, scale, set_limits in (
        (0, figure.x_scale, axes.set_xlim), (1, figure.y_scale, axes.set_ylim)
    ):
        values = np.concatenate([points[part] for points in shown]
                                + ([diverged_x(figure.curves)] if part == 0 else []))
        low, high = values.min(), values.max()
        if scale == "log":
            margin = max(0.06 * np.log10(high / low), 0.06 if part == 0 else 0.15)
            set_limits(low / 10 ** margin, high * 10 ** margin)
            continue
        margin = 0.06 * (high - low) or 0.1 * abs(high) or 1.0
        from_zero = part == 1 and low >= 0 and low < 0.4 * high
        set_limits(0.0 if from_zero else low - margin, high + margin)


def _lowest(figure: StudyFigure) -> float:
    points = [y for y in (_drawable(curve, figure)[1] for curve in figure.curves) if len(y)]
    return float(min(y.min() for y in points)) if points else float("nan")


def _floor_shows(curve: Curve, lowest: float) -> bool:
    return bool(curve.floor > 0 and lowest > 0 and curve.floor > lowest / 10 ** FLOOR_REACH)


def _draw_floors(axes: Axes, figure: StudyFigure, pens: list[Pen]) -> None:
    """Shades what lies below every floor; where floors differ each also gets a
    dotted line in its curve's colour."""
    lowest = _lowest(figure)
    drawn = [(curve, pen) for curve, pen in zip(figure.curves, pens) if _floor_shows(curve, lowest)]
    if not drawn:
        return
    floors = np.array([curve.floor for curve, _ in drawn])
    bottom, top = axes.get_ylim()
    if figure.y_scale == "log":
        bottom = min(bottom, floors.min() / 10 ** (0.05 * np.log10(top / bottom)))
    axes.set_ylim(bottom, top)
    axes.axhspan(bottom, floors.min(), facecolor=BAND, edgecolor="none", zorder=0.5)
    axes.axhline(floors.min(), color=MUTED, linewidth=0.7, linestyle=(0, (4, 3)), zorder=2)
    axes.annotate(
        "noise floor of the reference", (0.995, floors.min()), xycoords=("axes fraction", "data"),
        xytext=(0, -2.5), textcoords="offset points", ha="right", va="top", fontsize=6.8,
        color=MUTED, zorder=6
    )
    for curve, pen in drawn:
        if curve.floor > 1.01 * floors.min():
            axes.plot(
                [curve.x.min(), curve.x.max()], [curve.floor] * 2, color=pen.colour, linewidth=0.8,
                linestyle=(0, (1, 2.2)), zorder=2
            )


def _label_curves(axes: Axes, figure: StudyFigure, pens: list[Pen], shown: list[Points]) -> None:
    """Labels in a column right of the axes, near the right end of
    their curves, with thin leaders; those of shapes in their order, without."""
    curves, in_order = figure.curves, is_geometry(figure)
    to_axes = axes.transData + axes.transAxes.inverted()
    ends = [tuple(to_axes.transform((x[x.argmax()], y[x.argmax()]))) if len(x) else (0.0, -1.0)
            for x, y in shown]
    labels = [fill(formula_text(curve.label), LABEL_WIDTH) for curve in curves]
    lines = max(1 + label.count("\n") for label in labels)
    step = min(LABEL_STEP * lines, 1.06 / max(len(curves), 1))
    heights = ([1 - step * k for k in range(len(ends))] if in_order
               else spread([end[1] for end in ends], step))
    size = 7.6 if step >= LABEL_STEP else 6.4
    for label, pen, end, height in zip(labels, pens, ends, heights):
        key = [1.075] if pen.marker else [1.062, 1.088]
        axes.plot(
            key, [height] * len(key), transform=axes.transAxes, clip_on=False, color=pen.colour,
            marker=pen.marker, markersize=4.6, markeredgewidth=1.1,
            markerfacecolor=pen.colour if is_marked(curves) else PAPER
        )
        axes.text(
            1.10, height, label, transform=axes.transAxes, ha="left", va="center", fontsize=size,
            color=INK
        )
        if end[0] > 0.85 and 0 <= end[1] <= 1 and not in_order:
            axes.plot(
                [end[0] + 0.012, 1.015, 1.06], [end[1], end[1], height], transform=axes.transAxes,
                clip_on=False, color=pen.colour, linewidth=0.5, alpha=0.7
            )


def spread(heights: list[float], step: float) -> list[float]:
    """The heights, moved apart to at least `step` with their order kept,
    inside [0, 1] as far as they fit."""
    order = np.argsort(heights, kind="stable")
    placed = np.clip(np.array(heights, dtype=float)[order], 0.0, 1.0)
    for _ in range(200):
        gaps = np.diff(placed)
        short = np.maximum(step - gaps, 0.0)
        if not short.max(initial=0.0) > 1e-6:
            break
        placed[1:] += 0.5 * short
        placed[:-1] -= 0.5 * short
        over = max(placed[-1] - 1.0, 0.0) - max(-placed[0], 0.0)
        placed -= over if len(placed) * step <= 1.0 else 0.0
    result = np.empty(len(placed))
    result[order] = placed
    return [float(value) for value in result]
