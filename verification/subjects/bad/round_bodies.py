"""Contact with spheres and capsules, right and wrong."""
from __future__ import annotations

import numpy as np
from contact import OnPlanes
from foldproof_solver import Scene
from schemes import BackwardEuler, Single
from toy_solver import ToySolver


class OnRoundBodies(OnPlanes):
    """A step that would end in a sphere or a capsule ends on it; friction as on planes."""

    capabilities = (*ToySolver.capabilities, "spheres", "capsules")
    scale = 1.0  # of all radii

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        constants = scene.header["scene"]
        self.bodies = [{"a": body["centre"], "b": body["centre"], **body}
                       for body in constants.get("spheres", [])] + constants.get("capsules", [])

    def meet_obstacles(self) -> None:
        for body in self.bodies:
            out = self.from_axis(body, self.before + self.dt * self.v.astype("f8"))
            length = np.linalg.norm(out, axis=1)
            normals, gap = out / length[:, None], length - self.scale * body["radius"]
            self.touch(normals, gap, body["friction"])

    def from_axis(self, body: dict, p: np.ndarray) -> np.ndarray:
        """From the nearest point of the body's segment to each p."""
        a, axis = np.array(body["a"]), np.array(body["b"]) - np.array(body["a"])
        share = (p - a) @ axis / max(axis @ axis, 1e-30)
        return p - a - np.clip(share, 0, 1)[:, None] * axis


class OnRoundBodiesSingle(OnRoundBodies, Single):
    number = "f4"


class OnRoundBodiesBackwardEuler(OnRoundBodies, BackwardEuler):
    pass


class ChokesOnRoundBodies(OnRoundBodies):
    """Declares them, and was never tried on one."""

    def from_axis(self, body: dict, p: np.ndarray) -> np.ndarray:
        raise NotImplementedError("round bodies")


class StopsFromAbove(OnRoundBodies):
    """Sees what comes from above alone: cloth that hangs down beside a ball swings into it."""

    def touch(self, normals: np.ndarray, gap: np.ndarray, friction: float) -> None:
        super().touch(normals, np.where(normals[:, 2] > 0.7, gap, 1), friction)


class ThrowsBack(OnRoundBodies):
    """What meets a body leaves it twice as fast as it came."""

    slowest = 0.0  # m/s, that it throws back

    def touch(self, normals: np.ndarray, gap: np.ndarray, friction: float) -> None:
        inward = np.maximum(0, -np.sum(self.v * normals, axis=1))
        inward[inward < self.slowest] = 0
        super().touch(normals, gap, friction)
        self.v = self.v + np.where(gap < 0, 2.0 * inward, 0)[:, None] * normals
        self.x = self.before + self.dt * self.v


class ThrowsBackWhenFast(ThrowsBack):
    slowest = 3.5


class RoundBodiesTurn(OnRoundBodies):
    """Friction against a body that turns about the vertical axis, though it is fixed."""

    def touch(self, normals: np.ndarray, gap: np.ndarray, friction: float) -> None:
        carried = 0.3 * np.cross([0, 0, 1], normals)
        self.v, before = self.v - carried, self.before
        self.before = before + self.dt * carried
        super().touch(normals, gap, friction)
        self.v, self.before = self.v + carried, before


class RoundBodiesWithoutFriction(OnRoundBodies):
    def kept(self, most: np.ndarray, speed: np.ndarray) -> np.ndarray:
        return np.ones_like(speed)


class RoundBodiesStick(OnRoundBodies):
    """Friction as on a level plane, whose normal force is the weight: too large on a slope."""

    def touch(self, normals: np.ndarray, gap: np.ndarray, friction: float) -> None:
        steep = np.maximum(0.1, normals[:, 2])
        self.excess = 1 / steep
        super().touch(normals, gap, friction)

    def kept(self, most: np.ndarray, speed: np.ndarray) -> np.ndarray:
        return super().kept(most * self.excess, speed)


class RoundFrictionIsDrag(OnRoundBodies):
    """Takes a share of the sliding speed, however hard the contact: what moves creeps on."""

    def kept(self, most: np.ndarray, speed: np.ndarray) -> np.ndarray:
        return np.where(most > 0, 0.9, 1.0)


class CapsulesAreBalls(OnRoundBodies):
    """A capsule is the ball in its middle."""

    def from_axis(self, body: dict, p: np.ndarray) -> np.ndarray:
        return p - (np.array(body["a"]) + np.array(body["b"])) / 2
