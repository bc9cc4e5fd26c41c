"""Forces of contact that are read back, and friction of materials, right and wrong."""
from __future__ import annotations

import numpy as np
from contact import OnPlanes
from foldproof_solver import Scene
from moving import Follows


class ReadsContact(Follows):
    """The impulses of all planes over the time of an `advance`."""

    capabilities = (*Follows.capabilities, "contact_forces")

    def advance(self, dt: float, steps: int) -> None:
        self.impulses, self.seconds = [np.zeros_like(self.x)], dt * steps
        super().advance(dt, steps)

    def touch(self, normals: np.ndarray, gap: np.ndarray, friction: float) -> None:
        before = self.v
        super().touch(normals, gap, friction)
        self.impulses.append(self.mass[:, None] * (self.v - before))

    def contact_forces(self) -> np.ndarray:
        return sum(self.impulses) / self.seconds


class ReadsNothing(ReadsContact):
    def contact_forces(self) -> np.ndarray:
        return np.zeros_like(self.x)


class ReadsImpulses(ReadsContact):
    """Impulses [N s] as if they were forces."""

    def contact_forces(self) -> np.ndarray:
        return sum(self.impulses)


class ReadsTheLastStep(ReadsContact):
    def contact_forces(self) -> np.ndarray:
        return self.impulses[-1] / self.dt


class ReadsForcesOnObstacles(ReadsContact):
    def contact_forces(self) -> np.ndarray:
        return -super().contact_forces()


class ReadsNormalForces(ReadsContact):
    """Friction is left out."""

    def contact_forces(self) -> np.ndarray:
        normal = np.array(self.planes[0]["normal"])
        return (super().contact_forces() @ normal)[:, None] * normal


class ReadsTheMean(ReadsContact):
    """The whole force is spread evenly over the particles."""

    def contact_forces(self) -> np.ndarray:
        force = super().contact_forces()
        return np.tile(force.mean(axis=0), (len(force), 1))


class ReadsAPenalty(ReadsContact):
    """A spring's force near the planes, as in engines whose contact is something else."""

    def contact_forces(self) -> np.ndarray:
        normal, point = (np.array(self.planes[0][name]) for name in ("normal", "point"))
        near = np.abs((self.x - point) @ normal) < 1e-3
        return near[:, None] * self.mass.mean() * np.linalg.norm(self.gravity) * normal


class ReadsForEver(ReadsContact):
    """What was read once is added to what is read next, from scene to scene."""

    sums = 0.0

    def contact_forces(self) -> np.ndarray:
        ReadsForEver.sums += np.sum(super().contact_forces(), axis=0) / len(self.x)
        return np.tile(ReadsForEver.sums, (len(self.x), 1))


class RubsByMaterial(Follows):
    """A material's own coefficient in place of the plane's."""

    capabilities = (*Follows.capabilities, "material_friction")

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.own = np.full(len(self.x), np.nan)
        for k, material in enumerate(scene.header["scene"].get("materials", [])):
            of = scene.triangles[scene.material_of_triangle == k]
            self.own[of] = material.get("friction", np.nan)

    def respond(self, plane: dict) -> None:
        OnPlanes.respond(self, {**plane, "friction": self.both(plane["friction"])})

    def both(self, of_plane: float) -> np.ndarray:
        return np.where(np.isnan(self.own), of_plane, self.own)


class RubsByPlanesAlone(RubsByMaterial):
    def both(self, of_plane: float) -> np.ndarray:
        return np.full_like(self.own, of_plane)


class RubsByTheMean(RubsByMaterial):
    def both(self, of_plane: float) -> np.ndarray:
        return (super().both(of_plane) + of_plane) / 2


class RubsByTheFirst(RubsByMaterial):
    """Of the first material, whatever the triangle."""

    def both(self, of_plane: float) -> np.ndarray:
        return np.full_like(self.own, super().both(of_plane)[0])


class RubsByMaterialAlone(RubsByMaterial):
    """A material without a coefficient does not rub."""

    def both(self, of_plane: float) -> np.ndarray:
        return np.nan_to_num(self.own)
