"""Appearance of cloth and objects in pictures, films and the 3D view: colours and lights."""
from __future__ import annotations

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import to_rgb

from plots.plot_style import PAPER, fabric_colour

# linear RGB
FRONT = np.array([0.56, 0.175, 0.085])      # the side that the triangles' normals point to
BACK = np.array([0.085, 0.20, 0.30])
OBJECT = np.array([0.30, 0.30, 0.29])       # what the cloth can hit, both sides
GROUND = np.array([0.42, 0.42, 0.41])      # of that, what has no end
MARK = np.array([0.012, 0.014, 0.018])      # held particles
STUCK = np.array([0.60, 0.30, 0.01])        # particles that stick to something

# in the axes of a case's camera: right, up, toward the viewer
KEY_LIGHT = np.array([-0.52, 0.74, 0.42])   # casts the shadows
FILL_LIGHT = np.array([0.85, -0.05, 0.50])

# of the picture's size: cloth that lies on an object stays visible
SET_BACK = 0.008
# of how far the cloth reaches: ground beyond is seen less and less
GROUND_FADES = (0.75, 1.3)
# colours that stand for a colour map; between them it is straight
STOPS = 17
FABRICS = "fabrics"                         # the map whose stops are fabrics, the last one strokes


def colour_stops(name: str) -> np.ndarray:
    """A colour map of matplotlib, or FABRICS, as STOPS evenly spaced colours, sRGB from 0 to
    255."""
    if name == FABRICS:
        inks = [fabric_colour(k) for k in range(STOPS - 1)] + [PAPER]
        return np.round(255 * np.array([to_rgb(ink) for ink in inks])).astype(int)
    return np.round(255 * colormaps[name](np.linspace(0.0, 1.0, STOPS))[:, :3]).astype(int)


def fabric_code(k: int | np.ndarray) -> float | np.ndarray:
    """The place of a fabric on the colour bar FABRICS."""
    return k % (STOPS - 1) / (STOPS - 1)


def field_colours(codes: np.ndarray, name: str) -> np.ndarray:
    """Linear RGB of places on a colour bar (any shape, 0 to 1), with the channels in front."""
    fine = np.linspace(0.0, 1.0, 1024)
    table = np.stack(
        [
            np.interp(fine, np.linspace(0.0, 1.0, STOPS), channel)
            for channel in colour_stops(name).T / 255.0
        ]
    )
    return linear(table).astype(np.float32)[:, np.round(1023 * codes).astype(np.int16)]


def linear(srgb: np.ndarray) -> np.ndarray:
    """Linear light of sRGB values from 0 to 1."""
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
