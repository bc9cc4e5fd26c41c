"""What a cloth can be coloured by: speed, strain, bending angle and distance to the objects, one number for each
particle, from what the case file holds. For pictures, films, the view in the page and exported files alike."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from data.results import Case

WORDS = {"speed": ("speed", "m/s"),
         "strain": ("strain, the largest |length / rest length \u2212 1| of a particle's edges", "1"),
         "angle": ("bending angle, the largest of a particle's hinges, 0 where flat", "rad"),
         "phi": ("distance to the objects, negative inside", "m")}
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


def all_values(case: Case) -> dict[str, np.ndarray]:
    """Every field that the file allows by its name, T x N in all frames: speed [m/s]; strain [1], the largest
    |length / rest length - 1| of a particle's edges; angle [rad], the largest of its hinges, 0 where flat; phi [m], the
    distance to the objects, negative inside."""
    x, velocities, distances = (case.every_frame(name) for name in ("positions", "velocities", "object_distance"))
    rest, hinges = case.rest_positions(), hinges_of(case.triangles)
    values = {}
    if velocities is not None:
        values["speed"] = np.linalg.norm(velocities, axis=2)
    if rest is not None:
        values["strain"] = _strains(x, edges_of(case.triangles), rest)
    if len(hinges):
        values["angle"] = _angles(x, hinges, case.triangles)
    if distances is not None:
        values["phi"] = distances
    return values


def fields_of(case: Case, frames: list[int]) -> list[Field]:
    """Every field that the file allows and that is more than roundings, in these frames; colours span the values of all
    of them."""
    made = []
    for name, values in all_values(case).items():
        ends = _side_ends(case) if name == "phi" else _size_ends(values[frames])
        if ends[1] > SMALLEST:
            made.append(Field(name, *WORDS[name], np.nan_to_num(values[frames], posinf=1e300), *ends,
                              SIDES if name == "phi" else SIZES))
    return made


def most_telling(fields: list[Field], rows: list[int], edges: np.ndarray) -> tuple[Field, int] | None:
    """The field and that of the rows whose picture says most: colours are many (their entropy in bits), and neighbours are
    alike (the correlation over the edges), so that it is no noise. Where all say the same, as of a sheet that moves as one,
    the last. None where there are no fields."""
    rated = [(_telling(field.codes(row), edges), field, row) for field in fields for row in rows]
    return max(rated, key=lambda entry: (entry[0], entry[2]))[1:] if rated else None


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


def _size_ends(values: np.ndarray) -> tuple[float, float]:
    """Colours of sizes begin at zero."""
    finite = values[np.isfinite(values)]
    return 0.0, float(np.percentile(finite, OF_LARGEST)) if len(finite) else 0.0


def _side_ends(case: Case) -> tuple[float, float]:
    """Colours of distances to the objects go to half an edge to both sides, as those of the contact maps do."""
    edges, rest = edges_of(case.triangles), case.rest_positions()
    places = case.positions(0) if rest is None else rest
    limit = 0.5 * float(np.linalg.norm(places[edges[:, 0]] - places[edges[:, 1]], axis=1).mean())
    return -limit, limit


def _strains(x: np.ndarray, edges: np.ndarray, rest: np.ndarray) -> np.ndarray:
    lengths = np.linalg.norm(x[:, edges[:, 0]] - x[:, edges[:, 1]], axis=2)
    at_rest = np.linalg.norm(rest[edges[:, 0]] - rest[edges[:, 1]], axis=1)
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
