"""Speed, strain, bending angle and distance to the objects, one number for each particle, from a
case file. Also the edges, hinges and normals of a cloth."""
from __future__ import annotations

import numpy as np

from data.results import Case


def all_values(case: Case) -> dict[str, np.ndarray]:
    """Every field that the file allows by its name, T x N in all frames: speed [m/s]; strain [1],
    the largest abs(length / rest length - 1) of a particle's edges; angle [rad], the largest of its
    hinges, 0 where flat; phi [m], the distance to the objects, negative inside."""
    x, velocities, distances = (
        case.every_frame(name) for name in ("positions", "velocities", "object_distance")
    )
    lengths, hinges = rest_lengths(case), hinges_of(case.triangles)
    values = {}
    if velocities is not None:
        values["speed"] = np.linalg.norm(velocities, axis=2)
    if lengths is not None:
        values["strain"] = _strains(x, edges_of(case.triangles), lengths)
    if len(hinges):
        values["angle"] = _angles(x, hinges, case.triangles)
    if distances is not None:
        values["phi"] = distances
    return values


def edges_of(triangles: np.ndarray) -> np.ndarray:
    """Every edge once, E x 2, the smaller particle first."""
    pairs = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    return np.unique(pairs, axis=0)


#        a
#      /   \      the triangle (p, q, a) turns about p -> q as listed, (q, p, b) about q -> p;
#     p --- q     the angle between their normals is that of the hinge, 0 when flat
#      \   /
#        b
def hinges_of(triangles: np.ndarray) -> np.ndarray:
    """Rows p, q and the two triangles that share this edge, H x 4."""
    sides = triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    owner = np.repeat(np.arange(len(triangles)), 3)
    ends = np.sort(sides, axis=1)
    order = np.lexsort((ends[:, 1], ends[:, 0]))
    ends, owner = ends[order], owner[order]
    twice = np.flatnonzero((ends[1:] == ends[:-1]).all(axis=1))
    return np.column_stack([ends[twice], owner[twice], owner[twice + 1]])


def rest_lengths(case: Case) -> np.ndarray | None:
    """Of each edge, E [m]; the mean of both sides of a seam in a pattern. None: not in the file."""
    rest, pattern = case.rest_positions(), case.pattern()
    if pattern is None and rest is None:
        return None
    corners = rest[case.triangles] if pattern is None else pattern
    sides = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2).ravel()
    pairs = np.sort(case.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    edge = np.unique(pairs, axis=0, return_inverse=True)[1].ravel()
    return np.bincount(edge, sides) / np.bincount(edge)


def _strains(x: np.ndarray, edges: np.ndarray, at_rest: np.ndarray) -> np.ndarray:
    lengths = np.linalg.norm(x[:, edges[:, 0]] - x[:, edges[:, 1]], axis=2)
    return _largest_at_ends(np.abs(lengths / at_rest - 1.0), edges, x.shape[1])


def area_normals(x: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Normals of length twice the area, M x 3 [m^2]."""
    a, b, c = (x[triangles[:, corner]] for corner in range(3))
    return np.cross(b - a, c - a)


def angles_at(x: np.ndarray, hinges: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Of each of `hinges`, without sign, H [rad], at the positions x, N x 3."""
    normals = area_normals(x, triangles)
    first, second = normals[hinges[:, 2]], normals[hinges[:, 3]]
    across = np.linalg.norm(np.cross(first, second), axis=1)
    return np.arctan2(across, (first * second).sum(axis=1))


def _angles(x: np.ndarray, hinges: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    values = np.array([angles_at(now, hinges, triangles) for now in x]).reshape(len(x), len(hinges))
    return _largest_at_ends(values, hinges[:, :2], x.shape[1])


def _largest_at_ends(values: np.ndarray, ends: np.ndarray, particles: int) -> np.ndarray:
    """T x N: of the values (T x E) of all edges at a particle the
    largest; 0 for a particle without any."""
    largest = np.zeros((len(values), particles))
    for row, of_edges in zip(largest, values):
        for side in range(2):
            np.maximum.at(row, ends[:, side], of_edges)
    return largest
