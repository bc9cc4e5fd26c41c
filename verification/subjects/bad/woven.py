"""Membranes of triangles with warp and weft, right and wrong."""
from __future__ import annotations

import numpy as np
from foldproof_solver import Scene
from toy import Toy
from toy_solver import ToySolver


class Woven(Toy):
    """St. Venant-Kirchhoff triangles; scenes without a membrane have springs."""

    capabilities = (*ToySolver.capabilities, "membrane")

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.membrane = scene.header["scene"]["material"].get("membrane")
        if not self.membrane:
            return
        self.corners = scene.triangles
        one, other = (scene.rest[self.corners[:, k]] - scene.rest[self.corners[:, 0]]
                      for k in (1, 2))
        normal = np.cross(one, other)
        self.area = np.linalg.norm(normal, axis=1) / 2
        along = self.warp_of(scene)
        across = np.cross(normal / (2 * self.area)[:, None], along)
        flat = np.stack([[np.sum(d * axis, axis=1) for axis in (along, across)]
                         for d in (one, other)])  # side, axis, triangle
        self.inverse = np.linalg.inv(np.moveaxis(flat, 2, 0).transpose(0, 2, 1))

    def warp_of(self, scene: Scene) -> np.ndarray:
        return scene.warp

    def moduli(self) -> tuple[float, float, float, float, float]:
        """E1, E2, G, nu12, tau."""
        names = ("warp", "weft", "shear", "poisson", "damping")
        return tuple(self.membrane[name] for name in names)

    def gradient(self, of: np.ndarray) -> np.ndarray:
        """By the rest plane's axes (M, 3, 2)."""
        c = of[self.corners]
        return np.stack([c[:, 1] - c[:, 0], c[:, 2] - c[:, 0]], axis=2) @ self.inverse

    def stress(self, strain: np.ndarray) -> np.ndarray:
        warp, weft, shear, nu, _ = self.moduli()
        common = 1 / (1 - nu * nu * weft / warp)
        s = 2 * shear * strain
        s[:, 0, 0] = common * (warp * strain[:, 0, 0] + nu * weft * strain[:, 1, 1])
        s[:, 1, 1] = common * (weft * strain[:, 1, 1] + nu * weft * strain[:, 0, 0])
        return s

    def strain(self, gradient: np.ndarray) -> np.ndarray:
        return (gradient.transpose(0, 2, 1) @ gradient - np.eye(2)) / 2

    def forces(self) -> np.ndarray:
        if not self.membrane:
            return super().forces()
        gradient, rate = self.gradient(self.x), self.gradient(self.v)
        change = gradient.transpose(0, 2, 1) @ rate
        total = self.strain(gradient) + self.moduli()[4] * (change + change.transpose(0, 2, 1)) / 2
        pull = -self.area[:, None, None] * (gradient @ self.stress(total)) \
            @ self.inverse.transpose(0, 2, 1)
        f = self.mass[:, None] * self.gravity
        for k in (0, 1):
            np.add.at(f, self.corners[:, k + 1], pull[:, :, k])
            np.add.at(f, self.corners[:, 0], -pull[:, :, k])
        return f


class WovenAcross(Woven):
    """Warp and weft are swapped."""

    def moduli(self) -> tuple[float, float, float, float, float]:
        warp, weft, shear, nu, tau = super().moduli()
        return weft, warp, shear, nu * weft / warp, tau


class WovenAlongX(Woven):
    """The warp is the x axis, whatever the scene says."""

    def warp_of(self, scene: Scene) -> np.ndarray:
        return np.tile([1.0, 0, 0], (len(scene.warp), 1))


class WovenWithoutNarrowing(Woven):
    def moduli(self) -> tuple[float, float, float, float, float]:
        warp, weft, shear, _, tau = super().moduli()
        return warp, weft, shear, 0, tau


class WovenAlike(Woven):
    """Sheared as an isotropic sheet is."""

    def moduli(self) -> tuple[float, float, float, float, float]:
        warp, weft, _, nu, tau = super().moduli()
        return warp, weft, warp / (2 + 2 * nu), nu, tau


class WovenOfHalfTheShear(Woven):
    """G times the tensor's shear, not the angle's."""

    def stress(self, strain: np.ndarray) -> np.ndarray:
        s = super().stress(strain)
        s[:, 0, 1] /= 2
        s[:, 1, 0] /= 2
        return s


class WovenUndamped(Woven):
    def moduli(self) -> tuple[float, float, float, float, float]:
        return (*super().moduli()[:4], 0)


class WovenInItsFirstPlane(Woven):
    """Strains by displacements, as if the sheet never turned."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.first = self.membrane and self.gradient(scene.rest)

    def strain(self, gradient: np.ndarray) -> np.ndarray:
        change = self.first.transpose(0, 2, 1) @ (gradient - self.first)
        return (change + change.transpose(0, 2, 1)) / 2
