"""Forces. Each gives its elastic part f(x), and its damping as a
matrix and a known part: D(x) v + g.

A force has `elastic(time, x)` -> N x 3 [N], and `damping(time, x, seen)` -> D: 3N x 3N [N s/m],
g: N x 3 [N]; `seen`: the velocities that drag takes its factors from.
"""

from dataclasses import dataclass

import numpy as np

from surface import Surface


def nothing(count: int) -> tuple[np.ndarray, np.ndarray]:
    return np.zeros((3 * count, 3 * count)), np.zeros((count, 3))


def dampers(
    count: int, particles: np.ndarray, modes: np.ndarray, factors: np.ndarray
) -> np.ndarray:
    """3N x 3N: minus the sum of factor * mode (x) mode; particles K x
    k, modes K x k x 3, factors K."""
    rows = np.zeros((len(particles), 3 * count))
    places = 3 * particles[:, :, None] + np.arange(3)
    rows[np.arange(len(particles))[:, None, None], places] = modes
    return -rows.T @ (factors[:, None] * rows)


@dataclass
class Gravity:
    """A constant acceleration [m/s^2]."""
    mass: np.ndarray
    acceleration: np.ndarray

    def elastic(self, _time: float, _x: np.ndarray) -> np.ndarray:
        return self.mass[:, None] * self.acceleration

    def damping(self, _time: float, _x: np.ndarray,
                _seen: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return nothing(len(self.mass))


class Springs:
    """F_a = Y A/L^2 (|d| - s L) d^ + kd A/L^2 ((v_b - v_a).d^) d^, F_b = -F_a; s: scale."""

    def __init__(self, cloth: Surface, keys: list[dict], scale: float) -> None:
        """keys: the table [stretch] of each triangle."""
        self.a, self.b = cloth.edges.T
        stiffness = np.array([one["stiffness"] for one in keys])
        damper = np.array([one.get("damping", 0.0) for one in keys])
        edge, triangle, length = cloth.sides.T
        triangle, edge = triangle.astype(int), edge.astype(int)
        shape = cloth.triangle_areas[triangle] / length**2

        def summed(values: np.ndarray) -> np.ndarray:
            return np.bincount(edge, values, len(cloth.edges))

        # the springs of an edge's triangles side by side
        self.stiffness, self.damper = (summed(each[triangle] * shape) for each in
                                       (stiffness, damper))  # N/m, N s/m
        self.length = scale * summed(stiffness[triangle] * shape * length) / self.stiffness

    def directions(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        d = x[self.b] - x[self.a]
        length = np.linalg.norm(d, axis=1)
        return length, d / length[:, None]

    def elastic(self, _time: float, x: np.ndarray) -> np.ndarray:
        length, direction = self.directions(x)
        pull = (self.stiffness * (length - self.length))[:, None] * direction
        force = np.zeros_like(x)
        np.add.at(force, self.a, pull)
        np.add.at(force, self.b, -pull)
        return force

    def damping(self, _time: float, x: np.ndarray,
                _seen: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        _, direction = self.directions(x)
        ends, modes = np.stack([self.a, self.b], axis=1), np.stack([direction, -direction], axis=1)
        return dampers(len(x), ends, modes, self.damper), np.zeros_like(x)


class Fold:
    """The bending elements of BMF03 section 4 at positions x;
    arrays with one row for each hinge."""

    def __init__(self, x: np.ndarray, hinges: np.ndarray) -> None:
        x1, x2, x3, x4 = (x[hinges[:, corner]] for corner in range(4))
        edge = x4 - x3
        self.edge = np.linalg.norm(edge, axis=1)
        e = edge / self.edge[:, None]
        n1, n2 = np.cross(x1 - x3, x1 - x4), np.cross(x2 - x4, x2 - x3)
        self.doubled_area = np.linalg.norm(n1, axis=1) + np.linalg.norm(n2, axis=1)
        q1 = n1 / np.sum(n1 * n1, axis=1)[:, None]
        q2 = n2 / np.sum(n2 * n2, axis=1)[:, None]

        def along(vector: np.ndarray) -> np.ndarray:
            return np.sum(vector * e, axis=1)[:, None]

        self.mode = np.stack([self.edge[:, None] * q1, self.edge[:, None] * q2,
                              along(x1 - x4) * q1 + along(x2 - x4) * q2,
                              -along(x1 - x3) * q1 - along(x2 - x3) * q2], axis=1)  # H x 4 x 3
        sine = np.sum(np.cross(n1, n2) * e, axis=1)
        self.angle = np.arctan2(sine, np.sum(n1 * n2, axis=1))


class Bending:
    """F_i = ke |E|^2/(|N1|+|N2|) (sin(theta/2) - sin(theta0/2)) u_i and -kd |E| (u.v) u_i."""

    def __init__(self, cloth: Surface, keys: list[dict]) -> None:
        """keys: the table [bending] of each triangle."""
        self.hinges = cloth.hinges
        one, other = ([keys[t] for t in side] for side in cloth.hinge_triangles.T)
        self.stiffness = np.array([2 / (1 / a["stiffness"] + 1 / b["stiffness"])
                                   for a, b in zip(one, other)])
        self.damper = np.array([(a.get("damping", 0.0) + b.get("damping", 0.0)) / 2
                                for a, b in zip(one, other)])
        self.weighting = keys[0].get("weighting", "rest")
        self.factor = keys[0].get("damping_factor", "edge")
        areas = cloth.triangle_areas[cloth.hinge_triangles].sum(axis=1)
        self.rest_weight = cloth.hinge_lengths**2 / (2 * areas)
        asked = keys[0].get("rest_angle", "rest_shape")
        self.rest_angle = (Fold(cloth.rest, cloth.hinges).angle
                           if asked == "rest_shape" and not cloth.has_pattern else
                           np.full(len(self.hinges), 0.0 if asked in ("flat", "rest_shape")
                                   else np.radians(asked)))

    def elastic(self, _time: float, x: np.ndarray) -> np.ndarray:
        fold = Fold(x, self.hinges)
        weight = self.rest_weight if self.weighting == "rest" else fold.edge**2 / fold.doubled_area
        size = self.stiffness * weight * (np.sin(fold.angle / 2) - np.sin(self.rest_angle / 2))
        force = np.zeros_like(x)
        np.add.at(force, self.hinges, size[:, None, None] * fold.mode)
        return force

    def damping(self, _time: float, x: np.ndarray,
                _seen: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        fold = Fold(x, self.hinges)
        factor = self.damper * (fold.edge if self.factor == "edge" else
                                fold.edge**2 / fold.doubled_area)
        return dampers(len(x), self.hinges, fold.mode, factor), np.zeros_like(x)
