"""Forces of contact that are read back, and friction of materials, right and wrong."""
from __future__ import annotations

import numpy as np
from foldproof_solver import Scene
from moving import Follows, FollowsBoxes


class ReadsContact(Follows):
    """The impulses of all planes over the time of an `advance`."""

    capabilities = (*Follows.capabilities, "contact_forces")

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.forget()

    def forget(self) -> None:
        self.impulses, self.seconds = [np.zeros_like(self.x)], 1.0

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


class ReadsTheSceneBefore(ReadsContact):
    """Until the first step what was read in another scene of as many particles stays."""

    def forget(self) -> None:
        if len(getattr(self, "impulses", [[]])[0]) != len(self.x):
            super().forget()


class RubsByMaterial(FollowsBoxes):
    """A material's own coefficient in place of the obstacle's."""

    capabilities = (*FollowsBoxes.capabilities, "material_friction")

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.own = np.full(len(self.x), np.nan)
        materials = scene.header["scene"].get("materials", [])
        self.first = materials[0].get("friction", np.nan) if materials else np.nan
        for k, material in enumerate(materials):
            of = scene.triangles[scene.material_of_triangle == k]
            self.own[of] = material.get("friction", np.nan)

    def respond(self, plane: dict) -> None:
        super().respond({**plane, "friction": self.both(plane["friction"])})

    def leave(self, box: dict) -> None:
        super().leave({**box, "friction": self.both(box["friction"])})

    def both(self, of_obstacle: float) -> np.ndarray:
        return np.where(np.isnan(self.own), of_obstacle, self.own)


class RubsByMaterialOnPlanesAlone(RubsByMaterial):
    def leave(self, box: dict) -> None:
        FollowsBoxes.leave(self, box)


class RubsUnlessZero(RubsByMaterial):
    """A coefficient of 0 is taken to be none."""

    def both(self, of_obstacle: float) -> np.ndarray:
        return np.where(self.own > 0, super().both(of_obstacle), of_obstacle)


class RubsByObstaclesAlone(RubsByMaterial):
    def both(self, of_obstacle: float) -> np.ndarray:
        return np.full_like(self.own, of_obstacle)


class RubsByTheMean(RubsByMaterial):
    def both(self, of_obstacle: float) -> np.ndarray:
        return (super().both(of_obstacle) + of_obstacle) / 2


class RubsByTheFirst(RubsByMaterial):
    """All triangles have the first material's coefficient."""

    def both(self, of_obstacle: float) -> np.ndarray:
        return np.full_like(self.own, self.first)


class RubsByMaterialAlone(RubsByMaterial):
    """A material without a coefficient does not rub."""

    def both(self, of_obstacle: float) -> np.ndarray:
        return np.nan_to_num(self.own)
