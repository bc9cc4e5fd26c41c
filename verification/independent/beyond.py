"""What the paper does not have: air and a triangle membrane, by their formulas in KEYS.md."""

import numpy as np

from surface import Surface


class Air:
    """rho A/2 (C_n |u_n| u_n + C_t |u_t| u_t) on each triangle, a third at each corner, as
    D v + g with the factors of the velocity `seen`."""

    def __init__(self, cloth: Surface, keys: dict) -> None:
        self.triangles = cloth.triangles
        self.half_density = keys.get("density", 1.2) / 2
        self.wind = np.array(keys.get("wind", [0.0, 0.0, 0.0]))
        self.across, self.along = keys.get("normal_drag", 1.17), keys.get("tangential_drag", 0.02)

    def elastic(self, _time: float, x: np.ndarray) -> np.ndarray:
        return np.zeros_like(x)

    def damping(self, _time: float, x: np.ndarray,
                seen: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        matrix, known = np.zeros((x.size, x.size)), np.zeros_like(x)
        for corners in self.triangles:
            a, b, c = x[corners]
            normal = np.cross(b - a, c - a)
            area = np.linalg.norm(normal) / 2
            outer = np.outer(normal, normal) / (2 * area)**2
            u = self.wind - seen[corners].mean(axis=0)
            block = self.half_density * area * (
                self.across * np.linalg.norm(outer @ u) * outer
                + self.along * np.linalg.norm(u - outer @ u) * (np.eye(3) - outer))
            for i in corners:
                known[i] += block @ self.wind / 3
                for j in corners:
                    matrix[3 * i:3 * i + 3, 3 * j:3 * j + 3] -= block / 9
        return matrix, known


class Membrane:
    """The energy A/2 e.C e of each triangle, e = (E11, E22, 2 E12) along warp and weft."""

    def __init__(self, cloth: Surface, keys: dict) -> None:
        self.triangles, self.areas = cloth.triangles, cloth.triangle_areas
        warp, nu = keys["warp"], keys.get("poisson", 0.0)
        weft = keys.get("weft", warp)
        shear = keys.get("shear", warp / (2 * (1 + nu)))
        # the stiffness is the inverse of the compliance
        self.stiffness = np.linalg.inv(np.array([[1 / warp, -nu / warp, 0],
                                                 [-nu / warp, 1 / weft, 0], [0, 0, 1 / shear]]))
        self.delay = keys.get("damping", 0.0)
        angle = np.radians(keys.get("direction", 0.0))
        axes = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        flat = cloth.corners[:, :, :2] @ axes  # along warp and weft
        sides = np.stack([flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0]], axis=2)
        inverse = np.linalg.inv(sides)
        self.gradients = np.concatenate([-inverse.sum(axis=1, keepdims=True), inverse], axis=1)

    def strains(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """M x 3 strains, and their derivatives by the corners, M x 3 x 9."""
        slope = np.einsum("tki,tka->tia", x[self.triangles], self.gradients)  # M x 3 x 2
        product = np.einsum("tia,tib->tab", slope, slope)
        strain = np.stack([(product[:, 0, 0] - 1) / 2, (product[:, 1, 1] - 1) / 2,
                           product[:, 0, 1]], axis=1)
        by_corner = np.einsum("tia,tkb->tabki", slope, self.gradients)
        rows = [by_corner[:, 0, 0], by_corner[:, 1, 1], by_corner[:, 0, 1] + by_corner[:, 1, 0]]
        return strain, np.stack(rows, axis=1).reshape(len(strain), 3, 9)

    def elastic(self, _time: float, x: np.ndarray) -> np.ndarray:
        strain, by_corner = self.strains(x)
        pull = -self.areas[:, None] * np.einsum("tsc,ts->tc", by_corner, strain @ self.stiffness)
        force = np.zeros_like(x)
        np.add.at(force, self.triangles, pull.reshape(-1, 3, 3))
        return force

    def damping(self, _time: float, x: np.ndarray,
                _seen: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        _, by_corner = self.strains(x)
        matrix = np.zeros((x.size, x.size))
        for corners, area, rows in zip(self.triangles, self.areas, by_corner):
            places = (3 * corners[:, None] + np.arange(3)).ravel()
            matrix[np.ix_(places, places)] -= self.delay * area * rows.T @ self.stiffness @ rows
        return matrix, np.zeros_like(x)
