"""Figures of a campaign: a quantity over one to three parameters as maps and curves. A run that has
no value is a mark of its outcome, never a gap that looks like nothing."""
from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colorbar import Colorbar
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle

from data.campaign_table import WITH_VALUE, CampaignFigure, CampaignTable
from plots.campaign_layout import Layout, Levels, Panel, layout_of
from plots.map_plots import COLOURS_OF_VALUES
from plots.plot_style import (
    COLOURS, INK, MARKERS, MUTED, PAPER, Plot, finish, hatch, label_axes, new_figure,
    say_in_the_middle, scale_axis, with_unit)

# of outcomes without a value; "missing" is hatched
MARKS = {"stopped": "x", "refused": "s", "timed out": "D", "out of memory": "v", "crashed": "P",
         "missing": "1"}
MOST_CURVES, MOST_NAMED = 11, 8
LETTER = 0.075  # width [inch], with the space around a tick's name shared out
KEY = 0.4  # width of a legend's mark, with the space around it [inch]
LINE = 0.2  # height of a tick's name [inch], with the space above it
BEFORE_PANELS = 0.75  # for the numbers of an axis and its label [inch]
ABOVE_PANELS = 0.2  # for the name of the colour bar [inch]
SPARSE = 4  # places for each run beyond which a map becomes points


def plot_campaign_figure(table: CampaignTable, figure: CampaignFigure, name: str,
                         folder: Path) -> list[Plot]:
    """A map where two parameters have enough values each, and curves where they are few enough to
    be told apart; at least one of the two."""
    layout = layout_of(table, figure)
    values = table.values.get(figure.quantity, np.full(len(table.outcomes), np.nan))
    if figure.is_logarithmic:
        values = np.where(values > 0, values, np.nan)
    said = figure.title or figure.quantity
    plots = []
    is_map = len(figure.over) > 1 and len(layout.x.texts) > 1 and len(layout.y.texts) > 2
    if is_map or len(layout.y.texts) > MOST_CURVES:
        canvas = _draw_panels(layout, table, values, _draw_map)
        plots.append(finish(canvas, f"{name}-map", folder, f"{said}: map"))
    if len(layout.y.texts) <= MOST_CURVES:
        canvas = _draw_panels(layout, table, values, _draw_curves)
        plots.append(finish(canvas, f"{name}-curves", folder, f"{said}: curves"))
    return plots


# ---- panels --------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Drawing:
    """One panel, ready to be drawn."""

    axes: Axes
    layout: Layout
    panel: Panel
    values: np.ndarray
    outcomes: list[str]
    norm: Normalize


def _draw_panels(layout: Layout, table: CampaignTable, values: np.ndarray, draw) -> Figure:
    count = len(layout.panels)
    columns = min(3, count)
    rows = -(-count // columns)
    wide, high = (5.2, 3.4) if count == 1 else (2.5, 2.1)
    before = BEFORE_PANELS
    if draw is _draw_map:
        before = max(before, LETTER * (2 + max(map(len, layout.y.named()))))
    across, up, right = wide + before, high + 0.95, 1.2
    wide_canvas = columns * across + right
    key_rows = -(-len(layout.y.texts) // key_columns(layout, wide_canvas))
    below = 0.55 + (LINE * max(0, key_rows - 2) if draw is _draw_curves else 0)
    canvas = new_figure(wide_canvas, rows * up + below + ABOVE_PANELS)
    width, height = canvas.get_size_inches()
    norm = _norm(values, layout.figure.is_logarithmic)
    for k, panel in enumerate(layout.panels):
        left = before + (k % columns) * across
        bottom = below + 0.5 + (rows - 1 - k // columns) * up
        axes = canvas.add_axes((left / width, bottom / height, wide / width, high / height))
        label_axes(axes, *layout.labels[0], "", "1")
        draw(Drawing(axes, layout, panel, values, table.outcomes, norm))
        _say_above(axes, panel.title, (0, 18), MUTED)  # above the axis's label
    if draw is _draw_map and np.isfinite(values).any():
        _draw_colour_bar(canvas, layout, norm, (columns * across + 0.2) / width)
    _draw_legend(canvas, layout, table, draw is _draw_curves)
    return canvas


def _norm(values: np.ndarray, is_logarithmic: bool) -> Normalize:
    known = values[np.isfinite(values)]
    low, high = (known.min(), known.max()) if len(known) else (1.0, 2.0)
    if low == high:
        low, high = (low / 2, high * 2) if is_logarithmic else (low - 0.5, high + 0.5)
    return LogNorm(low, high) if is_logarithmic else Normalize(low, high)


def _draw_colour_bar(canvas: Figure, layout: Layout, norm: Normalize, left: float) -> None:
    height = canvas.get_size_inches()[1]
    axes = canvas.add_axes((left, 1.05 / height, 0.018, 1 - (1.5 + ABOVE_PANELS) / height))
    bar = Colorbar(axes, ScalarMappable(norm, COLOURS_OF_VALUES), ticklocation="right")
    bar.outline.set_visible(False)
    bar.solids.set_rasterized(True)
    scale = "log" if layout.figure.is_logarithmic else "linear"
    scale_axis(axes, "y", scale, np.array([norm.vmin, norm.vmax]))
    axes.set_ylim(norm.vmin, norm.vmax)
    _say_above(axes, with_unit(*layout.value), (38, 27), INK)  # above the titles of panels


def _say_above(axes: Axes, words: str, offset: tuple[float, float], colour: str) -> None:
    """Words that end above the upper right corner; offset in points."""
    axes.annotate(words, (1.0, 1.0), xycoords="axes fraction", xytext=offset,
                  textcoords="offset points", ha="right", va="bottom", color=colour)


def key_columns(layout: Layout, width: float) -> int:
    """How many keys of the second parameter's values stand side by side in this width [inch]."""
    longest = max(map(len, layout.y.named()))
    return max(1, min(MOST_NAMED, int(width / (KEY + LETTER * longest))))


def _draw_legend(canvas: Figure, layout: Layout, table: CampaignTable, has_curves: bool) -> None:
    jobs = [job for panel in layout.panels for cell in panel.jobs.values() for job in cell]
    seen = {table.outcomes[job] for job in jobs}
    keys = []
    if has_curves and len(layout.figure.over) > 1:
        keys = [Line2D([], [], color=COLOURS[k], marker=MARKERS[k], markersize=4, label=text)
                for k, text in enumerate(layout.y.named())]
    ends = [("o", "fails", "none"), *((mark, o, face_of(o)) for o, mark in MARKS.items())]
    keys += [Line2D([], [], linestyle="none", marker=mark, label=outcome, **_pen(face))
             for mark, outcome, face in ends if outcome in seen]
    if not keys:
        return
    title = with_unit(*layout.labels[1]) if has_curves and len(layout.labels) > 1 else None
    canvas.legend(handles=keys, title=title, loc="lower left", bbox_to_anchor=(0.01, 0.0),
                  ncol=key_columns(layout, canvas.get_figwidth()), frameon=False, fontsize=7.4,
                  title_fontsize=7.4, handletextpad=0.4, columnspacing=1.2, alignment="left")


def _pen(face: str) -> dict[str, Any]:
    return {"markersize": 5, "markeredgecolor": INK, "markerfacecolor": face}


# ---- a map ---------------------------------------------------------------------------------------


def is_sparse(layout: Layout) -> bool:
    """Whether jobs lie where they please, as samples do."""
    places = len(layout.x.texts) * len(layout.y.texts)
    return places > SPARSE * max(len(panel.jobs) for panel in layout.panels)


def _draw_map(drawing: Drawing) -> None:
    axes, layout = drawing.axes, drawing.layout
    label_axes(axes, *layout.labels[0], *layout.labels[1])
    axes.grid(False)
    if is_sparse(layout) and layout.x.numbers is not None and layout.y.numbers is not None:
        _draw_points(drawing)
        return
    cells = cells_of(layout, drawing.panel, drawing.values)
    for (x, y), jobs in drawing.panel.jobs.items():
        for mark, face in marks_of(drawing, jobs):
            axes.plot(x, y, mark, zorder=3, **_pen(face))
    hatch(axes)
    for (x, y), jobs in drawing.panel.jobs.items():
        if not np.isfinite(cells[y, x]):  # its mark stands on paper; hatched is what no job asks
            axes.add_patch(Rectangle((x - 0.5, y - 0.5), 1, 1, facecolor=PAPER, linewidth=0.0,
                                     zorder=0.7))
    across, up = (np.arange(count + 1) - 0.5 for count in cells.shape[::-1])
    axes.pcolormesh(across, up, np.ma.masked_invalid(cells), cmap=COLOURS_OF_VALUES,
                    norm=drawing.norm, rasterized=True, zorder=1)
    _name_places(axes, "x", layout.x)
    _name_places(axes, "y", layout.y)


def cells_of(layout: Layout, panel: Panel, values: np.ndarray) -> np.ndarray:
    """The median of each place, a row for each level of the second parameter; NaN: no value."""
    cells = np.full((len(layout.y.texts), len(layout.x.texts)), np.nan)
    for (x, y), jobs in panel.jobs.items():
        cells[y, x] = median_of(values[jobs])
    return cells


def _name_places(axes: Axes, which: str, levels: Levels) -> None:
    """Ticks at cells, every second or third one where there are many: names must not touch."""
    named = levels.named()
    place, canvas = axes.get_position(), axes.figure
    if which == "x":
        longest = max(map(len, named))
        room = int(place.width * canvas.get_figwidth() / (LETTER * (2 + longest)))
    else:
        room = int(place.height * canvas.get_figheight() / LINE)
    most = room if levels.numbers is None else min(room, MOST_NAMED)
    every = -(-len(named) // max(1, most))
    places = list(range(0, len(named), every))
    (axes.set_xticks if which == "x" else axes.set_yticks)(places, [named[k] for k in places])
    (axes.set_xlim if which == "x" else axes.set_ylim)(-0.5, len(named) - 0.5)


def _draw_points(drawing: Drawing) -> None:
    """Samples at their own places, coloured by their value."""
    axes, layout = drawing.axes, drawing.layout
    at = np.array(list(drawing.panel.jobs))
    x, y = layout.x.numbers[at[:, 0]], layout.y.numbers[at[:, 1]]
    for which, levels in (("x", layout.x), ("y", layout.y)):
        scale_axis(axes, which, levels.scale, levels.numbers)
    values = np.array([median_of(drawing.values[jobs]) for jobs in drawing.panel.jobs.values()])
    known = np.isfinite(values)
    if known.any():
        colours = {"cmap": COLOURS_OF_VALUES, "norm": drawing.norm}
        axes.scatter(x[known], y[known], 14, values[known], linewidths=0, **colours)
    for k, jobs in enumerate(drawing.panel.jobs.values()):
        for mark, face in marks_of(drawing, jobs):
            axes.plot(x[k], y[k], mark, **_pen(face))


# ---- curves --------------------------------------------------------------------------------------


def _draw_curves(drawing: Drawing) -> None:
    axes, layout = drawing.axes, drawing.layout
    label_axes(axes, *layout.labels[0], *layout.value)
    if not np.isfinite(drawing.values).any():
        say_in_the_middle(axes, "no run has a value")
        return
    places = np.arange(len(layout.x.texts)) if layout.x.numbers is None else layout.x.numbers
    if layout.x.numbers is None:
        _name_places(axes, "x", layout.x)
    else:
        scale_axis(axes, "x", layout.x.scale, places)
    scale = "log" if layout.figure.is_logarithmic else "linear"
    scale_axis(axes, "y", scale, np.array([drawing.norm.vmin, drawing.norm.vmax]))
    for k in range(len(layout.y.texts)):
        _draw_curve(drawing, k, places)
    low, high = drawing.norm.vmin, drawing.norm.vmax
    share = 0.08  # of room above and below, where runs without a value are marked
    if scale == "log":
        axes.set_ylim(low * (low / high) ** share, high * (high / low) ** share)
    else:
        axes.set_ylim(low - share * (high - low), high + share * (high - low))


def _draw_curve(drawing: Drawing, k: int, places: np.ndarray) -> None:
    axes, colour = drawing.axes, COLOURS[k]
    cells = sorted((x, jobs) for (x, y), jobs in drawing.panel.jobs.items() if y == k)
    medians = [(places[x], median_of(drawing.values[jobs])) for x, jobs in cells]
    known = [(x, value) for x, value in medians if np.isfinite(value)]
    joined = "none" if len(places) > 40 else "solid"  # samples are not joined
    # curves that lie on each other are all seen
    axes.plot([x for x, _ in known], [value for _, value in known], linestyle=joined, color=colour,
              marker=MARKERS[k], markersize=max(2.5, 6.5 - k), linewidth=max(0.8, 2.4 - 0.4 * k))
    for x, jobs in cells:
        for mark, face in marks_of(drawing, jobs):
            value = median_of(drawing.values[jobs])
            where = axes.transData if np.isfinite(value) else axes.get_xaxis_transform()
            size, edge = (7, INK) if face == "none" else (5, colour)
            axes.plot(places[x], value if np.isfinite(value) else 0.03 + 0.02 * (k % 2), mark,
                      markersize=size, markeredgecolor=edge, markerfacecolor=face,
                      transform=where, scaley=False, zorder=4)


# ---- both ----------------------------------------------------------------------------------------


def median_of(values: np.ndarray) -> float:
    """The median of the finite values; NaN if there are none."""
    known = values[np.isfinite(values)]
    return float(np.median(known)) if len(known) else float("nan")


def marks_of(drawing: Drawing, jobs: list[int]) -> list[tuple[str, str]]:
    """Marker and face of what the runs of a place came to, beside values that hold."""
    outcomes = {drawing.outcomes[job] for job in jobs}
    marks = [("o", "none")] if "fails" in outcomes else []
    return marks + [(mark, face_of(end)) for end, mark in MARKS.items() if end in outcomes]


def face_of(outcome: str) -> str:
    """The colour inside a mark: refused runs never began, and are hollow."""
    return PAPER if outcome == "refused" else MUTED


def figure_notes(table: CampaignTable, figure: CampaignFigure) -> list[str]:
    """What a reader of the figure needs to know."""
    layout = layout_of(table, figure)
    notes = []
    most = max(len(jobs) for panel in layout.panels for jobs in panel.jobs.values())
    if most > 1:
        notes.append(f"Each place is the median of its runs, at most {most}.")
    without = [o for o in table.outcomes if o not in WITH_VALUE]
    if without:
        notes.append(f"{len(without)} of {len(table.outcomes)} runs have no value; marks say why.")
    if "fails" in table.outcomes:
        notes.append("A ring is around runs that fail one of their case's expectations.")
    if layout.panels_left_out:
        of = layout.labels[2][0]
        notes.append(f"{layout.panels_left_out} more values of {of} are not drawn.")
    return notes
