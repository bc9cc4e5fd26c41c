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
        thirds = np.zeros((len(self.triangles), len(cloth.rest)))
        np.put_along_axis(thirds, self.triangles, 1 / 3, axis=1)
        self.mean = np.kron(thirds, np.eye(3)).reshape(len(thirds), 3, -1)  # M x 3 x 3N

    def elastic(self, _time: float, x: np.ndarray) -> np.ndarray:
        return np.zeros_like(x)

    def damping(self, _time: float, x: np.ndarray,
                seen: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        a, b, c = (x[self.triangles[:, corner]] for corner in range(3))
        normal = np.cross(b - a, c - a)
        doubled = np.linalg.norm(normal, axis=1)
        outer = np.einsum("ti,tj->tij", normal, normal) / doubled[:, None, None]**2
        u = self.wind - self.mean @ seen.ravel()
        across = np.einsum("tij,tj->ti", outer, u)
        factors = self.half_density * doubled / 2 * np.array([
            self.across * np.linalg.norm(across, axis=1),
            self.along * np.linalg.norm(u - across, axis=1)])
        block = (factors[0, :, None, None] * outer
                 + factors[1, :, None, None] * (np.eye(3) - outer))
        rows = self.mean.reshape(-1, x.size)
        known = rows.T @ (block @ self.wind).ravel()
        return -rows.T @ (block @ self.mean).reshape(-1, x.size), known.reshape(-1, 3)


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
        places = (3 * self.triangles[:, :, None] + np.arange(3)).reshape(-1, 1, 9)
        rates = np.zeros((len(places), 3, x.size))
        np.put_along_axis(rates, np.broadcast_to(places, by_corner.shape), by_corner, axis=2)
        stress = self.delay * self.areas[:, None, None] * (self.stiffness @ rates)
        return -rates.reshape(-1, x.size).T @ stress.reshape(-1, x.size), np.zeros_like(x)
