"""The flat pattern of a garment: its panels in the colours of their fabrics, the direction of the
warp, and letters at the seams."""
from __future__ import annotations

from pathlib import Path
from string import ascii_uppercase

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.path import Path as Outline
from matplotlib.patches import PathPatch
from matplotlib.tri import Triangulation

from data.garment import Garment, flat_areas, warp_of
from plots.plot_style import (
    INK, MUTED, PAPER, Plot, fabric_colour, finish, label_axes, new_figure, scale_axis
)

WIDTH, MOST_HEIGHT = 7.2, 6.0       # [inch]
STROKES = 240                       # of the warp, about so many on all panels
STROKE = 0.55                       # length of a stroke, of the distance between two
STRAIGHT = 1e-6                     # [1]: a bend smaller than that is none
NAMED_SEAMS = len(ascii_uppercase)


def plot_pattern(garment: Garment, name: str, folder: Path) -> Plot | None:
    """The figure NAME-pattern; None without a pattern."""
    if garment.pattern is None:
        return None
    corners = garment.pattern.reshape(-1, 2)
    low, high = corners.min(axis=0), corners.max(axis=0)
    size = high - low
    inner = WIDTH - 0.75
    height = min(inner * size[1] / size[0] + 0.85, MOST_HEIGHT)
    figure = new_figure(WIDTH, height)
    axes = figure.add_axes((0.55 / WIDTH, 0.5 / height, inner / WIDTH, 1 - 0.85 / height))
    label_axes(axes, "across", "m", "along", "m")
    axes.grid(False)
    for which in (0, 1):
        scale_axis(axes, "xy"[which], "linear", corners[:, which])
    axes.set_aspect("equal")
    axes.set_xlim(low[0] - 0.04 * size[0], high[0] + 0.04 * size[0])
    axes.set_ylim(low[1] - 0.04 * size[1], high[1] + 0.04 * size[1])
    _draw_panels(axes, garment)
    axes.add_collection(LineCollection(warp_strokes(garment)[:, [0, -1]], colors=PAPER,
                                       linewidths=0.9))
    _draw_seams(axes, garment, float(size.max()))
    return finish(figure, f"{name}-pattern", folder, "The flat pattern: fabrics, warp, seams")


def _draw_panels(axes: Axes, garment: Garment) -> None:
    for k in range(max(len(garment.fabrics), 1)):
        loops = outlines(garment.pattern[garment.fabric == k])
        if not loops:
            continue
        steps = [np.r_[Outline.MOVETO, np.full(len(loop) - 1, Outline.LINETO), Outline.CLOSEPOLY]
                 for loop in loops]
        outline = Outline(np.concatenate([np.vstack([loop, loop[:1]]) for loop in loops]),
                          np.concatenate(steps))
        axes.add_patch(PathPatch(outline, facecolor=fabric_colour(k), edgecolor=MUTED,
                                 linewidth=0.5))


def _draw_seams(axes: Axes, garment: Garment, size: float) -> None:
    """Both sides of each seam as lines, with its letter beside them."""
    middle = garment.pattern.mean(axis=1)
    for letter, seam in zip(ascii_uppercase, garment.seams):
        for side in seam.sides:
            axes.add_collection(LineCollection(side, colors=INK, linewidths=1.5))
            at = side.mean(axis=1)
            at = at[np.linalg.norm(at - at.mean(axis=0), axis=1).argmin()]
            inside = middle[np.linalg.norm(middle - at, axis=1).argmin()] - at
            place = at - 0.018 * size * inside / max(float(np.linalg.norm(inside)), 1e-300)
            axes.text(*place, letter, ha="center", va="center", fontsize=8.0, color=INK)


def outlines(pattern: np.ndarray) -> list[np.ndarray]:
    """The borders of flat triangles (M x 3 x 2) as closed loops, each n x 2, without the corners at
    which a border goes straight on."""
    a, b = pattern[:, 1] - pattern[:, 0], pattern[:, 2] - pattern[:, 0]
    turned = np.where((a[:, 0] * b[:, 1] < a[:, 1] * b[:, 0])[:, None, None], pattern[:, ::-1],
                      pattern)
    edges = {(tuple(p), tuple(q)) for one in turned for p, q in zip(one, np.roll(one, -1, axis=0))}
    after: dict[tuple[float, ...], list[tuple[float, ...]]] = {}
    for p, q in sorted(edges):
        if (q, p) not in edges:
            after.setdefault(p, []).append(q)
    loops = []
    while after:
        loop = [next(iter(after))]
        while loop[-1] in after:
            onward = after[loop[-1]]
            loop.append(onward.pop())
            if not onward:
                del after[loop[-2]]
        loops.append(_without_straight_corners(np.array(loop[:-1])))
    return loops


def _without_straight_corners(loop: np.ndarray) -> np.ndarray:
    before, beyond = loop - np.roll(loop, 1, axis=0), np.roll(loop, -1, axis=0) - loop
    bend = np.abs(before[:, 0] * beyond[:, 1] - before[:, 1] * beyond[:, 0])
    lengths = np.linalg.norm(before, axis=1) * np.linalg.norm(beyond, axis=1)
    return loop[bend > STRAIGHT * lengths]


class FlatPlaces:
    """Finds the triangles at places of the pattern. Throws RuntimeError for panels that lie on each
    other."""

    def __init__(self, pattern: np.ndarray) -> None:
        self.pattern = pattern
        points, index = np.unique(pattern.reshape(-1, 2), axis=0, return_inverse=True)
        self.finder = Triangulation(*points.T, index.reshape(-1, 3)).get_trifinder()

    def triangles(self, places: np.ndarray) -> np.ndarray:
        """Of places (... x 2), -1 outside."""
        return self.finder(places[..., 0], places[..., 1])

    def weights(self, places: np.ndarray, triangles: np.ndarray) -> np.ndarray:
        """Of the three corners, ... x 3."""
        a, b, c = (self.pattern[triangles, corner] for corner in range(3))
        whole = _cross(b - a, c - a)
        second, third = _cross(places - a, c - a) / whole, _cross(b - a, places - a) / whole
        return np.stack([1 - second - third, second, third], axis=-1)


def _cross(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    return p[..., 0] * q[..., 1] - p[..., 1] * q[..., 0]


def warp_strokes(garment: Garment, points: int = 5) -> np.ndarray:
    """Short lines along the warp on a grid in the pattern, those that lie inside the panels: n x
    `points` x 2 [m]. None where panels lie on each other."""
    apart = stroke_distance(garment)
    corners = garment.pattern.reshape(-1, 2)
    low, high = corners.min(axis=0), corners.max(axis=0)
    across, along = (np.arange(low[k] + apart / 2, high[k], apart) for k in (0, 1))
    middles = np.stack(np.meshgrid(across, along), axis=-1).reshape(-1, 2)
    reach = np.linspace(-0.5, 0.5, points) * STROKE * apart
    try:
        places = FlatPlaces(garment.pattern)
    except RuntimeError:
        return np.zeros((0, points, 2))
    inside = places.triangles(middles)
    middles, inside = middles[inside >= 0], inside[inside >= 0]
    strokes = middles[:, None] + reach[:, None] * warp_of(garment, inside)[:, None]
    return strokes[(places.triangles(strokes) >= 0).all(axis=1)]


def stroke_distance(garment: Garment) -> float:
    """Between neighbouring strokes [m]."""
    return float(np.sqrt(flat_areas(garment.pattern).sum() / STROKES))
