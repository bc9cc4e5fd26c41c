"""What a cloth can be coloured by: speed, strain, bending angle and distance to the objects, one number for each
particle, from what the case file holds. For pictures, films, the view in the page and exported files alike."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from camera import area_normals
from results import Case

QUANTITIES = ("positions", "velocities", "object_distance")
COLOUR_BINS = 16                    # in which the colours of a picture are counted
SMALLEST = 1e-9                     # [unit]: a field whose values all stay below is roundings
OF_LARGEST = 99.0                   # percentile of all values at which the colours of a field end
SIDES, SIZES = "RdBu", "viridis"    # matplotlib's names of the colour maps: red below zero; sizes from zero on


@dataclass
class Field:
    """One number for each particle and frame, and how it is coloured."""
    name: str
    label: str                      # with what it is of, in words
    unit: str
    values: np.ndarray              # T x N, of the frames that were asked for
    low: float                      # [unit], where the colours begin
    high: float                     # [unit], where they end
    colours: str                    # SIDES | SIZES

    def codes(self, row: int) -> np.ndarray:
        """Places on the colour bar, N, from 0 to 1; what lies beyond its ends has the colour of the end."""
        return np.clip((self.values[row] - self.low) / (self.high - self.low), 0.0, 1.0)


def fields_of(case: Case, frames: list[int]) -> list[Field]:
    """Every field that the file allows, in these frames; colours span the values of all of them."""
    x, velocities, distances = (None if rows is None else rows[frames] for rows in map(case.every_frame, QUANTITIES))
    edges, rest = edges_of(case.triangles), case.rest_positions()
    made = []
    if velocities is not None:
        made.append(_sizes("speed", "speed", "m/s", np.linalg.norm(velocities, axis=2)))
    if rest is not None:
        made.append(_sizes("strain", "strain, the largest |length / rest length \u2212 1| of a particle's edges", "1",
                           _strains(x, edges, rest)))
    hinges = hinges_of(case.triangles)
    if len(hinges):
        made.append(_sizes("angle", "bending angle, the largest of a particle's hinges, 0 where flat", "rad",
                           _angles(x, hinges, case.triangles)))
    if distances is not None:
        made.append(_distances(distances, x[0] if rest is None else rest, edges))
    return [field for field in made if field is not None]


def most_telling(fields: list[Field], rows: list[int], edges: np.ndarray) -> tuple[Field, int] | None:
    """The field and that of the rows whose picture says most: colours are many (their entropy in bits), and neighbours are
    alike (the correlation over the edges), so that it is no noise. None where there are no fields."""
    rated = [(_telling(field.codes(row), edges), field, row) for field in fields for row in rows]
    return max(rated, key=lambda entry: entry[0])[1:] if rated else None


def edges_of(triangles: np.ndarray) -> np.ndarray:
    """Every edge once, E x 2, the smaller particle first."""
    pairs = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    return np.unique(pairs, axis=0)


#        a
#      /   \      the triangle (p, q, a) turns about its edge p -> q as it is listed, (q, p, b) about q -> p;
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


def _sizes(name: str, label: str, unit: str, values: np.ndarray) -> Field | None:
    """A field of sizes from zero on; None where nothing in it is finite, or all is
    roundings."""
    if not np.isfinite(values).any():
        return None
    high = float(np.percentile(values[np.isfinite(values)], OF_LARGEST))
    return Field(name, label, unit, np.nan_to_num(values), 0.0, high, SIZES) if high > SMALLEST else None


def _distances(values: np.ndarray, rest: np.ndarray, edges: np.ndarray) -> Field | None:
    """Distances to the objects, coloured up to half an edge to both sides, as the contact maps are."""
    limit = 0.5 * float(np.linalg.norm(rest[edges[:, 0]] - rest[edges[:, 1]], axis=1).mean())
    if not (np.isfinite(values).any() and limit > 0):
        return None
    return Field("phi", "distance to the objects, negative inside", "m", np.nan_to_num(values, posinf=1e300), -limit,
                 limit, SIDES)


def _strains(x: np.ndarray, edges: np.ndarray, rest: np.ndarray) -> np.ndarray:
    lengths = np.linalg.norm(x[:, edges[:, 0]] - x[:, edges[:, 1]], axis=2)
    at_rest = np.linalg.norm(rest[edges[:, 0]] - rest[edges[:, 1]], axis=1)
    return _largest_at_ends(np.abs(lengths / at_rest - 1.0), edges, x.shape[1])


def _angles(x: np.ndarray, hinges: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    values = np.empty((len(x), len(hinges)))
    for row, now in zip(values, x):
        normals = area_normals(now, triangles)
        first, second = normals[hinges[:, 2]], normals[hinges[:, 3]]
        across = np.linalg.norm(np.cross(first, second), axis=1)
        row[:] = np.arctan2(across, (first * second).sum(axis=1))
    return _largest_at_ends(values, hinges[:, :2], x.shape[1])


def _largest_at_ends(values: np.ndarray, ends: np.ndarray, particles: int) -> np.ndarray:
    """T x N: of the values (T x E) of all edges at a particle the largest; 0 for a particle without any."""
    largest = np.zeros((len(values), particles))
    for row, of_edges in zip(largest, values):
        for side in range(2):
            np.maximum.at(row, ends[:, side], of_edges)
    return largest


def _telling(codes: np.ndarray, edges: np.ndarray) -> float:
    share = np.histogram(codes, COLOUR_BINS, (0.0, 1.0))[0] / len(codes)
    entropy = -float((share[share > 0] * np.log2(share[share > 0])).sum())
    near, far = codes[edges[:, 0]], codes[edges[:, 1]]
    spread = float(near.std() * far.std())
    alike = float(((near - near.mean()) * (far - far.mean())).mean()) / spread if spread > 1e-12 else 0.0
    return entropy * max(alike, 0.0)
