"""Membranes of triangles with warp and weft, right and wrong."""
from __future__ import annotations

import numpy as np
from foldproof_solver import Scene
from toy import Toy
from toy_solver import ToySolver


class Woven(Toy):
    """St. Venant-Kirchhoff triangles beside the springs."""

    capabilities = (*ToySolver.capabilities, "membrane", "materials")

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        constants, names = scene.header["scene"], ("warp", "weft", "shear", "poisson", "damping")
        self.is_woven = "membrane" in constants["material"]
        if not self.is_woven:
            return
        of = scene.arrays.get("material_of_triangle", np.zeros(len(scene.triangles), int))
        materials = constants.get("materials", [constants["material"]])
        self.table = np.array([[m["membrane"][name] for name in names] for m in materials])[of].T
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

    def moduli(self) -> tuple[np.ndarray, ...]:
        """E1, E2, G, nu12, tau of each triangle."""
        return tuple(self.table)

    def gradient(self, of: np.ndarray) -> np.ndarray:
        """By the rest plane's axes (M, 3, 2)."""
        c = of[self.corners]
        return np.stack([c[:, 1] - c[:, 0], c[:, 2] - c[:, 0]], axis=2) @ self.inverse

    def stress(self, strain: np.ndarray) -> np.ndarray:
        warp, weft, shear, nu, _ = self.moduli()
        common = 1 / self.determinant(nu, nu * weft / warp)
        s = 2 * shear[:, None, None] * strain
        s[:, 0, 0] = common * (warp * strain[:, 0, 0] + nu * weft * strain[:, 1, 1])
        s[:, 1, 1] = common * (weft * strain[:, 1, 1] + nu * weft * strain[:, 0, 0])
        return s

    def determinant(self, nu: np.ndarray, other: np.ndarray) -> np.ndarray:
        return 1 - nu * other

    def strain(self, gradient: np.ndarray) -> np.ndarray:
        return (gradient.transpose(0, 2, 1) @ gradient - np.eye(2)) / 2

    def beside(self) -> np.ndarray:
        """Weight and springs."""
        return super().forces()

    def forces(self) -> np.ndarray:
        f = self.beside()
        if not self.is_woven:
            return f
        gradient, rate = self.gradient(self.x), self.gradient(self.v)
        change = gradient.transpose(0, 2, 1) @ rate
        tau = self.moduli()[4][:, None, None]
        total = self.strain(gradient) + tau * (change + change.transpose(0, 2, 1)) / 2
        pull = -self.area[:, None, None] * (gradient @ self.stress(total)) \
            @ self.inverse.transpose(0, 2, 1)
        for k in (0, 1):
            np.add.at(f, self.corners[:, k + 1], pull[:, :, k])
            np.add.at(f, self.corners[:, 0], -pull[:, :, k])
        return f


class WovenAcross(Woven):
    """Warp and weft are swapped."""

    def moduli(self) -> tuple[np.ndarray, ...]:
        warp, weft, shear, nu, tau = super().moduli()
        return weft, warp, shear, nu * weft / warp, tau


class WovenAlongX(Woven):
    """The warp is always the x axis."""

    def warp_of(self, scene: Scene) -> np.ndarray:
        return np.tile([1.0, 0, 0], (len(scene.warp), 1))


class WovenAsTheFirstTriangle(Woven):
    """All triangles have the warp of the first."""

    def warp_of(self, scene: Scene) -> np.ndarray:
        return np.tile(scene.warp[0], (len(scene.warp), 1))


class WovenOfTheFirstMaterial(Woven):
    def moduli(self) -> tuple[np.ndarray, ...]:
        return tuple(np.tile(row[:1], len(row)) for row in super().moduli())


class WovenWithoutSprings(Woven):
    """What has a membrane has no springs."""

    def beside(self) -> np.ndarray:
        return self.mass[:, None] * self.gravity if self.is_woven else super().beside()


class WovenOfOnePoissonRatio(Woven):
    """1 - nu^2, as of isotropic sheets."""

    def determinant(self, nu: np.ndarray, other: np.ndarray) -> np.ndarray:
        return 1 - nu * nu


class WovenWithoutNarrowing(Woven):
    def moduli(self) -> tuple[np.ndarray, ...]:
        warp, weft, shear, _, tau = super().moduli()
        return warp, weft, shear, 0 * warp, tau


class WovenAlike(Woven):
    """Sheared as an isotropic sheet is."""

    def moduli(self) -> tuple[np.ndarray, ...]:
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
    def moduli(self) -> tuple[np.ndarray, ...]:
        return (*super().moduli()[:4], np.zeros(len(self.corners)))


class WovenInItsFirstPlane(Woven):
    """Strains by displacements, as if the sheet never turned."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.first = self.gradient(scene.rest) if self.is_woven else None

    def strain(self, gradient: np.ndarray) -> np.ndarray:
        change = self.first.transpose(0, 2, 1) @ (gradient - self.first)
        return (change + change.transpose(0, 2, 1)) / 2
