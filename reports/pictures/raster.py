"""The z-buffer: which triangle every sample of a picture sees, and where in it.

Every triangle is cut into rows and every row into a span of sample centres, so no sample outside a
triangle is visited.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

PAIRS_AT_ONCE = 1_500_000                   # rows of triangles treated together, to bound memory


@dataclass
class Raster:
    """Visible triangle of each sample: a row of `triangles` (-1: none), and its depth [m]."""
    seen: np.ndarray       # height x width
    nearness: np.ndarray   # height x width [m]
    triangles: np.ndarray  # M x 3, those that can be drawn
    # M x 3 x 3: weight of corner k at sample (px, py) is planes[m, k] . (px, py, 1)
    planes: np.ndarray


def rasterise(
    points: np.ndarray, nearness: np.ndarray, triangles: np.ndarray, shape: tuple[int, int]
) -> Raster:
    """The nearest triangle at every sample of height x width, for points N x 2 [samples, y
    downwards] that are so near (N) [m]."""
    triangles = _drawable(points, triangles, shape[::-1])
    planes = _barycentric_planes(points, triangles)
    raster = Raster(np.full(shape, -1, dtype=np.int64), np.full(shape, -np.inf), triangles, planes)
    _fill(raster, points, np.einsum("mk,mkc->mc", nearness[triangles], planes))
    return raster


def faces_viewer(planes: np.ndarray) -> np.ndarray:
    """True where a triangle shows its front: its outline then runs clockwise
    in pixels, whose y points down."""
    return planes[:, 0, 0] * planes[:, 1, 1] - planes[:, 0, 1] * planes[:, 1, 0] < 0


class SeenSamples:
    """The S samples that see a triangle, in raster order: which one (owner, S), the weights of its
    corners (3 x S), and how far they are from the border of the picture (S,
    as a part of its longer side)."""

    def __init__(self, raster: Raster) -> None:
        places = np.flatnonzero(raster.seen.ravel() >= 0)
        column = (places % raster.seen.shape[1] + 0.5).astype(np.float32)
        line = (places // raster.seen.shape[1] + 0.5).astype(np.float32)
        self.owner = raster.seen.ravel()[places]
        height, width = raster.seen.shape
        to_sides = np.minimum(np.minimum(column, width - column), np.minimum(line, height - line))
        self.from_border = to_sides / max(height, width)
        self.corners = [raster.triangles[:, corner][self.owner] for corner in range(3)]
        self.weights = [
            _affine(raster.planes[:, corner], self.owner, column, line) for corner in range(3)
        ]

    def at(self, of_vertices: np.ndarray) -> np.ndarray:
        """Values of vertices (N) at the samples (S)."""
        values = of_vertices.astype(np.float32)
        return sum(weight * values[corner] for weight, corner in zip(self.weights, self.corners))


def _affine(
    plane: np.ndarray, owner: np.ndarray, column: np.ndarray, line: np.ndarray
) -> np.ndarray:
    """plane[owner] . (column, line, 1) for planes M x 3, about the first sample's
    place to spare single precision."""
    column0, line0 = float(column[0]) if len(column) else 0.0, float(line[0]) if len(line) else 0.0
    level = plane[:, 0] * column0 + plane[:, 1] * line0 + plane[:, 2]
    slopes = plane.astype(np.float32)
    across = slopes[:, 0][owner] * (column - np.float32(column0))
    down = slopes[:, 1][owner] * (line - np.float32(line0))
    return across + down + level.astype(np.float32)[owner]


def _drawable(points: np.ndarray, triangles: np.ndarray, size: tuple[int, int]) -> np.ndarray:
    """Triangles that are finite, meet the picture and are not edge-on."""
    corners = points[triangles]
    with np.errstate(invalid="ignore", over="ignore"):
        a, b, c = (corners[:, k] for k in range(3))
        twice_area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (
            c[:, 0] - a[:, 0]
        )
        meets = (corners.max(axis=1) >= 0).all(axis=1) & (
            corners.min(axis=1) <= np.array(size)
        ).all(axis=1)
        modest = (np.abs(corners) < 1e6).all(axis=(1, 2))
        return triangles[meets & modest & (np.abs(twice_area) > 1e-9)]


def _barycentric_planes(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    a, b, c = (points[triangles[:, corner]] for corner in range(3))
    rows = [_edge_plane(b, c), _edge_plane(c, a), _edge_plane(a, b)]
    twice_area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (
        c[:, 0] - a[:, 0]
    )
    return np.stack(rows, axis=1) / twice_area[:, None, None]


def _edge_plane(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Twice the signed area of (p, q, pixel) as an affine function of the pixel, M x 3."""
    return np.stack(
        [p[:, 1] - q[:, 1], q[:, 0] - p[:, 0], p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]], axis=1
    )


def _fill(raster: Raster, points: np.ndarray, depth_planes: np.ndarray) -> None:
    """Enters every triangle at the samples that it covers, where nothing
    nearer is. depth_planes: M x 3 [m]."""
    planes, shape = raster.planes, raster.seen.shape
    heights = points[raster.triangles][:, :, 1]
    first = np.maximum(np.ceil(heights.min(axis=1) - 0.5).astype(int), 0)
    last = np.minimum(np.floor(heights.max(axis=1) - 0.5).astype(int), shape[0] - 1)
    rows = np.maximum(last - first + 1, 0)
    box = np.ptp(points[raster.triangles][:, :, 0], axis=1)
    ends = np.cumsum(rows * (box + 2.0))
    cuts = np.searchsorted(
        ends, np.arange(PAIRS_AT_ONCE, ends[-1] if len(ends) else 0, PAIRS_AT_ONCE)
    )
    for chunk in np.split(np.arange(len(planes)), cuts):
        owner = np.repeat(chunk, rows[chunk])
        line = np.repeat(first[chunk], rows[chunk]) + _count_up(rows[chunk])
        start, count = _spans(planes[owner], line + 0.5, shape[1])
        plane = depth_planes[owner]
        level = plane[:, 0] * (start + 0.5) + plane[:, 1] * (line + 0.5) + plane[:, 2]
        along = _count_up(count)
        near = np.repeat(level, count) + np.repeat(plane[:, 0], count) * along
        _keep_nearest(
            raster, np.repeat(line * shape[1] + start, count) + along, near, np.repeat(owner, count)
        )


def _count_up(count: np.ndarray) -> np.ndarray:
    """0, 1, ... count - 1 of each, one after the other."""
    return np.arange(int(count.sum())) - np.repeat(np.cumsum(count) - count, count)


def _spans(planes: np.ndarray, y: np.ndarray, width: int) -> tuple[np.ndarray, np.ndarray]:
    """First pixel and number of pixels whose centres lie in the triangle, for
    triangles `planes` on lines y."""
    left, right = np.zeros(len(y)), np.full(len(y), float(width))
    for corner in range(3):
        slope = planes[:, corner, 0]
        rest = planes[:, corner, 1] * y + planes[:, corner, 2]
        with np.errstate(divide="ignore", invalid="ignore"):
            crossing = -rest / slope
        left = np.where(slope > 0, np.maximum(left, crossing), left)
        right = np.where(slope < 0, np.minimum(right, crossing), right)
        right = np.where((slope == 0) & (rest < 0), -1.0, right)
    start = np.ceil(np.clip(left, 0, width) - 0.5 - 1e-7).astype(int)
    stop = np.floor(np.clip(right, -1, width) - 0.5 + 1e-7).astype(int)
    start, stop = np.maximum(start, 0), np.minimum(stop, width - 1)
    return start, np.maximum(stop - start + 1, 0)


def _keep_nearest(raster: Raster, pixel: np.ndarray, near: np.ndarray, owner: np.ndarray) -> None:
    seen, nearness = raster.seen.reshape(-1), raster.nearness.reshape(-1)
    while True:  # of equal pixels the last written stays; those nearer than that are written again
        better = np.flatnonzero(near > nearness[pixel])
        if not len(better):
            return
        pixel, near, owner = pixel[better], near[better], owner[better]
        seen[pixel], nearness[pixel] = owner, near
