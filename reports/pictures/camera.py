"""One camera for all the pictures of a case, chosen from the positions and from where up is.

The projection is orthographic: a scale bar then holds for every length across the view, and
pictures of a row compare.
"""
from __future__ import annotations

from dataclasses import dataclass, replace
from math import cos, radians, sin

import numpy as np

from data.cloth_values import area_normals

MARGIN = 0.05              # of the picture's size, on each side
LARGEST_WIDTH = 600        # pixels of a finished picture
LARGEST_HEIGHT = 880       # pixels
RUNAWAY = 30.0             # a frame larger than this many times the first does not set the scale
AZIMUTHS = range(-90, 90, 15)  # degrees, about up from the front
WITHOUT_GRAVITY = np.array([0.0, 1.0, 0.0])  # up, where nothing falls


@dataclass(frozen=True)
class Camera:
    """Orthographic: `right`, `up`, `toward` (the viewer) are orthonormal; `corner` is the lower
    left of the picture."""
    right: np.ndarray
    up: np.ndarray
    toward: np.ndarray
    corner: tuple[float, float]    # along right and up [m]
    metres: tuple[float, float]    # width and height of the picture [m]
    pixels_per_metre: float

    @property
    def pixels(self) -> tuple[int, int]:
        """Width and height of the finished picture."""
        return (max(8, round(self.metres[0] * self.pixels_per_metre)),
                max(8, round(self.metres[1] * self.pixels_per_metre)))

    def scaled_to(self, width: int, height: int) -> Camera:
        """The same view for a picture of at most so many pixels."""
        return replace(self, pixels_per_metre=min(width / self.metres[0], height / self.metres[1]))

    def project(self, x: np.ndarray, supersampling: int) -> tuple[np.ndarray, np.ndarray]:
        """Pixel coordinates (N x 2, y downwards) and nearness to the viewer
        (N) [m] of points x (N x 3) [m]."""
        scale = self.pixels_per_metre * supersampling
        across = (x @ self.right - self.corner[0]) * scale
        down = (self.corner[1] + self.metres[1] - x @ self.up) * scale
        return np.stack([across, down], axis=1), x @ self.toward


def up_against(gravity: np.ndarray | None) -> np.ndarray:
    """The direction against gravity (3 [m/s^2]; None: there is none), 3, unit."""
    size = 0.0 if gravity is None else float(np.linalg.norm(gravity))
    return -gravity / size if 0.0 < size < np.inf else WITHOUT_GRAVITY


def upright_axes(up: np.ndarray) -> np.ndarray:
    """Side, up and front as rows, 3 x 3: the axes x, y, z turned the shortest way from y to `up`
    (3, unit). So z up has its front at -y, as in modelling programs; y down is turned about z."""
    x, y, z = up
    aside = x * x + z * z                   # 1 - y^2, without cancellation
    if aside == 0:
        return np.diag([y, y, 1.0])
    share = (1 - y) / aside                 # 1 / (1 + y)
    return np.array(
        [
            [1 - share * x * x, -x, -share * x * z], [x, y, z],
            [-share * x * z, -z, 1 - share * z * z]
        ]
    )


def choose_camera(
    frames: list[np.ndarray], triangles: np.ndarray, landmarks: np.ndarray | None = None,
    up: np.ndarray = WITHOUT_GRAVITY
) -> Camera:
    """An upright camera that holds all frames (each N x 3 [m]) and landmarks (M x 3 [m]), a little
    to the side of where most of the cloth faces the viewer."""
    upright = upright_axes(up)
    frames = frames_that_set_the_scale(frames)
    normals = np.concatenate(
        [area_normals(x, triangles[:: max(1, len(triangles) // 4000)]) for x in frames]
    )
    normals = normals[np.isfinite(normals).all(axis=1)] @ upright.T
    elevation = _elevation(normals)
    azimuth = _azimuth(normals, elevation)
    right, upward, toward = (axis @ upright for axis in _axes(azimuth, elevation))
    points = frames if landmarks is None else [*frames, landmarks]
    return fit_camera(np.concatenate(points), right, upward, toward)


def fit_camera(points: np.ndarray, right: np.ndarray, up: np.ndarray, toward: np.ndarray) -> Camera:
    """The camera with these axes that just holds all points (N x 3 [m]), with a margin."""
    across, upward = points @ right, points @ up
    low = np.array([across.min(), upward.min()])
    size = np.array([np.ptp(across), np.ptp(upward)])
    least = max(0.12 * size.max(), 1e-9)
    wanted = np.maximum(size, least) + 2 * MARGIN * max(size.max(), least)
    corner = low - (wanted - size) / 2
    scale = min(LARGEST_WIDTH / wanted[0], LARGEST_HEIGHT / wanted[1])
    return Camera(right, up, toward, corner=(float(corner[0]), float(corner[1])),
                  metres=(float(wanted[0]), float(wanted[1])), pixels_per_metre=float(scale))


def frames_that_set_the_scale(frames: list[np.ndarray]) -> list[np.ndarray]:
    """Those of the frames (each N x 3 [m]) whose particles are all finite and not far outside the
    first; if there are none, the first with zeros for what is infinite."""
    finite = [x[np.isfinite(x).all(axis=1)] if not np.isfinite(x).all() else x for x in frames]
    size = np.ptp(finite[0], axis=0).max() if len(finite[0]) else 1.0
    centre = finite[0].mean(axis=0) if len(finite[0]) else np.zeros(3)
    kept = [x for x, whole in zip(finite, frames)
            if len(x) == len(whole) and np.abs(x - centre).max() <= RUNAWAY * max(size, 1e-12)]
    return kept or [np.nan_to_num(frames[0], posinf=0.0, neginf=0.0)]


def _axes(azimuth: float, elevation: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Right, up and toward the viewer, in upright axes, as are the normals below."""
    a, e = radians(azimuth), radians(elevation)
    toward = np.array([sin(a) * cos(e), sin(e), cos(a) * cos(e)])
    right = np.array([cos(a), 0.0, -sin(a)])
    return right, np.cross(toward, right), toward


def _elevation(normals: np.ndarray) -> float:
    """Degrees; higher for cloth that mostly lies flat."""
    total = np.linalg.norm(normals, axis=1).sum()
    lying = np.abs(normals[:, 1]).sum() / total if total > 0 else 0.0
    return 14.0 + 20.0 * float(np.clip((lying - 0.45) / 0.4, 0.0, 1.0))


def _azimuth(normals: np.ndarray, elevation: float) -> float:
    """Degrees: 28 to the side of the fullest view, on the side that shows
    more, and facing the cloth's front."""
    def share_shown(azimuth: float) -> float:
        return float(np.abs(normals @ _axes(azimuth, elevation)[2]).sum())

    seen = {azimuth: share_shown(azimuth) for azimuth in AZIMUTHS}
    fullest = max(seen, key=lambda azimuth: seen[azimuth])
    if not max(seen.values()) > 1.15 * min(seen.values()):
        fullest = 0
    azimuth = max((fullest + 28.0, fullest - 28.0), key=share_shown)
    front = float((normals @ _axes(azimuth, elevation)[2]).sum())
    return azimuth if front >= -1e-3 * share_shown(azimuth) else azimuth + 180.0
