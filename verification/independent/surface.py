"""The cloth at rest: meshes, springs along edges, hinges across them, lumped masses."""

from pathlib import Path
from typing import NamedTuple

import numpy as np


class Surface(NamedTuple):
    """A triangle mesh at rest. N particles, M triangles, E edges, H hinges."""
    rest: np.ndarray  # N x 3 [m]
    triangles: np.ndarray  # M x 3
    corners: np.ndarray  # M x 3 x 3: of each triangle, in its panel if there is a pattern [m]
    has_pattern: bool
    triangle_areas: np.ndarray  # M, at rest [m^2]
    edges: np.ndarray  # E x 2, in the order in which triangles name them
    sides: np.ndarray  # 3M rows: an edge, one of its triangles, and its length there [m]
    edge_areas: np.ndarray  # E: rest area of the one or two triangles of an edge [m^2]
    hinges: np.ndarray  # H x 4: x1, x2, x3, x4 of BMF03 section 4
    hinge_triangles: np.ndarray  # H x 2
    hinge_lengths: np.ndarray  # H: of the edge at rest; of two sides, see KEYS.md [m]
    areas: np.ndarray  # N: a third of the rest area of a particle's triangles [m^2]


def sheet(width: float, height: float, columns: int, rows: int) -> tuple[np.ndarray, np.ndarray]:
    """A rectangle in z = 0, particles row by row from the lower left; all diagonals one way."""
    x, y = np.meshgrid(np.linspace(0, width, columns + 1), np.linspace(0, height, rows + 1))
    points = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    triangles = []
    for row in range(rows):
        for column in range(columns):
            a = row * (columns + 1) + column
            b, c, d = a + 1, a + columns + 1, a + columns + 2
            triangles += [(a, b, d), (a, d, c)]
    return points, np.array(triangles)


def read_obj(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (N x 3) and triangles (M x 3) of an OBJ file of plain `v` and `f` records."""
    rows = [line.split() for line in path.read_text(encoding="utf-8").splitlines()]
    points = [[float(word) for word in row[1:4]] for row in rows if row[:1] == ["v"]]
    faces = [[int(word) - 1 for word in row[1:4]] for row in rows if row[:1] == ["f"]]
    return np.array(points), np.array(faces)


def surface_of(points: np.ndarray, triangles: np.ndarray,
               pattern: np.ndarray | None = None) -> Surface:
    """Springs, hinges and areas of an oriented mesh whose edges have one or two triangles.
    pattern: M x 3 x 3, the corners in the flat panels."""
    corners = points[triangles] if pattern is None else pattern
    spanned = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(spanned, axis=1) / 2
    sides: dict[tuple[int, int], list[tuple[int, int, int]]] = {}
    for number, (a, b, c) in enumerate(triangles.tolist()):
        for start, end, opposite in ((a, b, c), (b, c, a), (c, a, b)):
            sides.setdefault((min(start, end), max(start, end)), []).append(
                (number, start, opposite)
            )
    hinges, hinge_triangles, hinge_lengths, lengths = [], [], [], []
    for number, ((low, high), both) in enumerate(sides.items()):
        pulls = weights = 0.0
        for t, _, _ in both:
            a, b = (corners[t, np.flatnonzero(triangles[t] == end)[0]] for end in (low, high))
            length = np.linalg.norm(b - a)
            lengths.append((number, t, length))
            pulls, weights = pulls + area[t] / length, weights + area[t] / length**2
        if len(both) == 2:
            one, two = both
            start, end = (low, high) if one[1] == low else (high, low)
            hinges.append((one[2], two[2], start, end))
            hinge_triangles.append((one[0], two[0]))
            hinge_lengths.append(pulls / weights)
    lumped = np.zeros(len(points))
    np.add.at(lumped, triangles, area[:, None] / 3)
    return Surface(points, triangles, corners, pattern is not None, area,
                   np.array(list(sides)), np.array(lengths),
                   np.array([sum(area[side[0]] for side in both) for both in sides.values()]),
                   np.array(hinges, dtype=int).reshape(-1, 4),
                   np.array(hinge_triangles, dtype=int).reshape(-1, 2), np.array(hinge_lengths),
                   lumped)
