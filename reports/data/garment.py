"""What a case file holds of a garment: flat panels and their seams, fabrics, warp, wind."""
from __future__ import annotations

from dataclasses import dataclass, field

import h5py
import numpy as np

from data.cloth_values import hinges_of
from data.hdf5_values import attributes_of, from_attributes, numbers_of
from data.results import Case, reading_hdf5


@dataclass
class Fabric:
    """A fabric, and its part of the cloth."""
    name: str
    density: float = float("nan")   # [kg/m^2]
    stretch: float = float("nan")   # of springs [N/m]; NaN: there are none
    bending: float = float("nan")   # ke [J]; NaN: there is none
    warp: float = float("nan")      # of a membrane [N/m]; NaN: there is none
    weft: float = float("nan")
    shear: float = float("nan")
    direction: float = float("nan")  # of the warp, from the first axis of the pattern [rad]
    area: float = float("nan")      # at rest [m^2]; NaN without a pattern, as the mass
    mass: float = float("nan")      # [kg]


@dataclass
class Seam:
    """Two sides that are sewn together, E edges."""
    sides: np.ndarray               # 2 x E x 2 x 2: the ends of each edge in the pattern [m]

    @property
    def lengths(self) -> np.ndarray:
        """Of the two sides, 2 [m]."""
        return np.linalg.norm(self.sides[:, :, 1] - self.sides[:, :, 0], axis=2).sum(axis=1)

    @property
    def eased_percent(self) -> float:
        """By how much the longer side is longer than the shorter one; 0 for roundings [%]."""
        return round(100 * float(self.lengths.max() / self.lengths.min() - 1), 6)


@dataclass
class Garment:
    """What the cloth was made of and in; of M triangles."""
    fabrics: list[Fabric]           # none: the file names none
    fabric: np.ndarray              # M, places in the list
    pattern: np.ndarray | None = None           # M x 3 x 2, corners in the panels [m]
    panels: int = 0
    seams: list[Seam] = field(default_factory=list)
    wind: np.ndarray | None = None  # 3 [m/s]; None: no air
    air_density: float = float("nan")           # [kg/m^3]


def garment_of(case: Case) -> Garment | None:
    """None for a case without panels, fabrics and air."""
    with reading_hdf5(case.path), h5py.File(case.path, "r") as file:
        if not any(name in file for name in ("mesh/pattern", "fabrics", "air")):
            return None
        groups = file.get("fabrics", {})
        fabrics = [
            from_attributes(Fabric, attributes_of(groups[k])) for k in sorted(groups, key=int)
        ]
        of_triangle = numbers_of(file, "mesh/fabric")
        made = Garment(
            fabrics, np.zeros(len(case.triangles), int) if of_triangle is None
            else of_triangle.astype(int), pattern=case.pattern())
        if "air" in file:
            made.wind = numbers_of(file, "air/wind")
            made.air_density = float(attributes_of(file["air"])["density"])
        if made.pattern is not None:
            made.panels = int(attributes_of(file["mesh/pattern"])["panels"])
            made.seams = seams_of(case.triangles, made.pattern)
            _weigh(made)
    return made


def warp_of(garment: Garment, triangles: np.ndarray) -> np.ndarray:
    """Directions of the warp in the pattern, at triangles of any shape, ... x 2, unit."""
    angles = np.nan_to_num([fabric.direction for fabric in garment.fabrics] or [0.0])
    at = angles[garment.fabric[triangles]]
    return np.stack([np.cos(at), np.sin(at)], axis=-1)


def flat_areas(pattern: np.ndarray) -> np.ndarray:
    """Of the triangles in the pattern, M [m^2]."""
    a, b = pattern[:, 1] - pattern[:, 0], pattern[:, 2] - pattern[:, 0]
    return 0.5 * np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def _weigh(made: Garment) -> None:
    areas = flat_areas(made.pattern)
    for k, fabric in enumerate(made.fabrics):
        fabric.area = float(areas[made.fabric == k].sum())
        fabric.mass = fabric.area * fabric.density


def edge_sides(triangles: np.ndarray, pattern: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The ends of each edge between two triangles, E x 2; and their places in the pattern of either
    triangle, 2 x E x 2 x 2 [m]."""
    hinges = hinges_of(triangles)
    sides = []
    for of in (hinges[:, 2], hinges[:, 3]):
        corners = [(triangles[of] == hinges[:, end, None]).argmax(axis=1) for end in (0, 1)]
        sides.append(np.stack([pattern[of, corner] for corner in corners], axis=1))
    return hinges[:, :2], np.stack(sides)


def seams_of(triangles: np.ndarray, pattern: np.ndarray) -> list[Seam]:
    """The longest first. A seam goes on where an edge with a common end lies on the same two sides
    of the pattern."""
    ends, sides = edge_sides(triangles, pattern)
    sewn = np.flatnonzero((sides[0] != sides[1]).any(axis=(1, 2)))
    at_place: dict[tuple[int, bytes], list[int]] = {}
    root = {int(edge): int(edge) for edge in sewn}

    def top(edge: int) -> int:
        while root[edge] != edge:
            edge = root[edge]
        return edge

    for edge in map(int, sewn):
        for end in (0, 1):
            both = np.sort(sides[:, edge, end].view(complex).ravel()).tobytes()
            for other in at_place.setdefault((int(ends[edge, end]), both), []):
                root[top(edge)] = top(other)
            at_place[int(ends[edge, end]), both].append(edge)
    chains: dict[int, list[int]] = {}
    for edge in map(int, sewn):
        chains.setdefault(top(edge), []).append(edge)
    seams = [Seam(_in_order(sides[:, chain])) for chain in chains.values()]
    return sorted(seams, key=lambda seam: -float(seam.lengths.max()))


def _in_order(sides: np.ndarray) -> np.ndarray:
    """The sides of the edges such that each array holds those of one panel: where the triangles of
    an edge stand the other way round, both are swapped."""
    ordered = sides.copy()
    for k in range(1, sides.shape[1]):
        before = ordered[:, :k].reshape(2, -1, 2)
        near = [[np.abs(before[one] - sides[other, k, :, None]).sum(axis=-1).min()
                 for other in (0, 1)] for one in (0, 1)]
        if near[0][1] + near[1][0] < near[0][0] + near[1][1]:
            ordered[:, k] = sides[::-1, k]
    return ordered
