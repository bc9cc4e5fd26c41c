"""Contact maps: how far each part of a cloth is from the objects, drawn
over its rest shape laid flat."""
from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.tri import Triangulation

from data.quantities import number_text
from data.results import Case
from plots.plot_style import (
    Plot, draw_colour_bar, finish, label_axes, new_figure, scale_axis, with_unit
)

WIDTH, HEIGHT = 5.3, 3.6            # [inch]
COLOURS_OF_SIDES = "RdBu"           # red inside, blue outside
ROUNDINGS = 1e-9                    # m: not to be called inside
ROUND = 1e-3                        # of the radius: how round a rest shape must be to be unrolled


def plot_contacts(case: Case, name: str, folder: Path) -> list[tuple[str, Plot]]:
    """The map of the frame with the most particles nearer to the objects than half an edge, with
    its caption; none for cloth that never is, or whose rest shape cannot be
    laid flat without stretching it."""
    every, rest = case.every_frame("object_distance"), case.rest_positions()
    if every is None or rest is None:
        return []
    flat = flatten_to_plane(rest)
    limit = 0.5 * _mean_edge(rest, case.triangles)
    near = (every < limit).sum(axis=1)
    if len(near) > 1:
        # the start is the author's, not the motion's
        near[0] = 0
    if flat is None or not near.any():
        return []
    shown = len(near) - 1 - int(near[::-1].argmax())    # the last of those
    distances = every[shown]
    caption = (
        f"Distance to the objects at {number_text(case.frame_times[shown])} s, the frame with the"
        " most particles nearer than half an edge, drawn on the rest shape laid flat; colours end"
        f" at half an edge. {_inside(distances)}"
    )
    triangles = _without_seam(flat, case.triangles)
    return [
        (
            caption,
            _map(
                flat, triangles, np.nan_to_num(distances, posinf=1e300), limit, f"{name}-contacts",
                folder
            ),
        )
    ]


def flatten_to_plane(rest: np.ndarray) -> np.ndarray | None:
    """N x 2 [m]: a flat shape without the axis along which it is flat, a tube about an axis cut
    open and unrolled; None for others."""
    extents = np.ptp(rest, axis=0)
    thin = int(extents.argmin())
    if extents[thin] < 1e-6 * extents.max():
        return np.delete(rest, thin, axis=1)
    for axis in range(3):
        across = np.delete(rest, axis, axis=1)
        across = across - 0.5 * (across.min(axis=0) + across.max(axis=0))
        radii = np.hypot(*across.T)
        if np.ptp(radii) < ROUND * radii.mean():
            return np.column_stack(
                [radii.mean() * np.arctan2(across[:, 1], across[:, 0]), rest[:, axis]]
            )
    return None


def _inside(distances: np.ndarray) -> str:
    deep = -distances[distances < -ROUNDINGS]
    if not len(deep):
        return f"No particle is inside by more than {number_text(ROUNDINGS)} m"
    return (
        f"{number_text(len(deep))} of {number_text(len(distances))} particles are inside, by at"
        f" most {number_text(deep.max())} m"
    )


def _without_seam(flat: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """The triangles but those that a cut along a tube has torn."""
    wide = np.ptp(flat[triangles][:, :, 0], axis=1)
    return triangles[wide < 0.5 * np.ptp(flat[:, 0])] if len(triangles) > 8 else triangles


def _mean_edge(rest: np.ndarray, triangles: np.ndarray) -> float:
    corners = rest[triangles]
    return float(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).mean())


def _map(flat: np.ndarray, triangles: np.ndarray, distances: np.ndarray, limit: float, name: str,
         folder: Path) -> Plot:
    canvas = new_figure(WIDTH, HEIGHT)
    axes = canvas.add_axes((0.12, 0.13, 0.68, 0.76))
    label_axes(axes, "along the cloth", "m", "across it", "m")
    axes.grid(False)
    for which, places in (("x", flat[:, 0]), ("y", flat[:, 1])):
        scale_axis(axes, which, "linear", places)
    axes.set_aspect("equal", adjustable="datalim")
    colours = axes.tripcolor(
        Triangulation(*flat.T, triangles), np.clip(distances, -limit, limit), shading="gouraud",
        cmap=COLOURS_OF_SIDES, vmin=-limit, vmax=limit, rasterized=True
    )
    bar_axes = canvas.add_axes((0.84, 0.13, 0.03, 0.76))
    draw_colour_bar(bar_axes, colours, with_unit("distance", "m"), 30)
    scale_axis(bar_axes, "y", "linear", np.array([-limit, limit]))
    return finish(canvas, name, folder, "Distance of the cloth to the objects, over its rest shape")
