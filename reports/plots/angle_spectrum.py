"""How sharply a cloth is folded: the spectrum of its bending
angles, at the start and at the end."""
from __future__ import annotations

from pathlib import Path

import numpy as np

from data.cloth_values import angles_at, hinges_of
from data.results import Case
from plots.plot_style import COLOURS, INK, Plot, finish, label_axes, new_figure, scale_axis

WIDTH, HEIGHT = 5.3, 3.1            # [inch]
DEGREES = np.linspace(0.0, 180.0, 361)
LEAST_HINGES = 20                   # fewer give no meaningful shares


def plot_angle_spectrum(case: Case, name: str, folder: Path) -> list[tuple[str, Plot]]:
    """The share of hinges that are folded by an angle or more, with its caption; none for cloth of
    few hinges, or where nothing is folded."""
    hinges = hinges_of(case.triangles)
    if len(hinges) < LEAST_HINGES:
        return []
    shares = [
        folded_beyond(np.degrees(angles_at(case.positions(frame), hinges, case.triangles)))
        for frame in (0, -1)
    ]
    if not all(share[DEGREES >= 1.0].any() for share in shares[1:]):
        return []
    caption = (
        "Share of the cloth's hinges that are folded by an angle or more, at the start and at the"
        " end. The angle is that between the normals of a hinge's two triangles, 0 where flat"
    )
    return [(caption, _spectrum(shares, 1.0 / len(hinges), f"{name}-angles", folder, caption))]


def folded_beyond(angles: np.ndarray) -> np.ndarray:
    """Of `angles` [degrees] the share that is as large as each of DEGREES, or larger [1]."""
    finite = np.sort(angles[np.isfinite(angles)])
    return 1.0 - np.searchsorted(finite, DEGREES) / max(len(finite), 1)


def _spectrum(
    shares: list[np.ndarray], least: float, name: str, folder: Path, caption: str
) -> Plot:
    figure = new_figure(WIDTH, HEIGHT)
    axes = figure.add_axes((0.115, 0.145, 0.775, 0.76))
    label_axes(axes, "bending angle", "degrees", "share of hinges beyond it", "1")
    scale_axis(axes, "x", "linear", np.array([0.0, 180.0]))
    scale_axis(axes, "y", "log", np.array([least, 1.0]))
    axes.set_xticks(np.arange(0.0, 181.0, 30.0))
    for share, label, colour, height in zip(
        shares, ("start", "end"), (INK, COLOURS[0]), (0.93, 0.86)
    ):
        drawn = share > 0
        axes.plot(DEGREES[drawn], share[drawn], color=colour, linewidth=1.4)
        axes.plot(
            [0.87, 0.91], [height, height], transform=axes.transAxes, color=colour, linewidth=1.4
        )
        said = label if share[DEGREES >= 1.0].any() else f"{label}, flat"
        axes.text(
            0.925, height, said, transform=axes.transAxes, fontsize=7.4, color=colour, va="center"
        )
    axes.set_xlim(0.0, 180.0)
    axes.set_ylim(0.7 * least, 1.5)
    return finish(figure, name, folder, caption)
