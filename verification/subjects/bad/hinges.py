"""Hinges as the protocol defines them, with their dampers; and hinges that are wrong where they are
bent sharply, on one side, for long, or from other angles."""
from __future__ import annotations

import numpy as np
from foldproof_solver import Scene
from materials import Damped


class Hinges(Damped):
    """Moments of 2 B w (theta - rest angle), and of bending_damping L times the rate of theta."""

    level, stated = "L1", "dampers at edges and hinges, as the scene says"

    def prepare(self, scene: Scene) -> dict[str, str]:
        material = scene.header["scene"]["material"]
        self.given, material["bending_rigidity"] = material["bending_rigidity"], 0
        self.brake = material["bending_damping"]
        return {**super().prepare(scene), "bending": "hinges of the scene"}

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.corners, self.rest_angles = scene.hinges, scene.rest_angles
        self.moments = 2 * self.given * scene.hinge_weights
        ends = scene.rest[self.corners[:, 3]] - scene.rest[self.corners[:, 2]]
        self.brakes = self.brake * np.linalg.norm(ends, axis=1)

    def turned(self) -> tuple[np.ndarray, np.ndarray]:
        """Angles (K) [rad], and their gradients by the corners (K, 4, 3) [1/m]."""
        x1, x2, x3, x4 = (self.x[self.corners[:, k]] for k in range(4))
        n1, n2, e = np.cross(x1 - x3, x1 - x4), np.cross(x2 - x4, x2 - x3), x4 - x3
        length = np.linalg.norm(e, axis=1, keepdims=True)
        along = e / length
        sine = np.sum(np.cross(n1, n2) * along, axis=1)
        u1, u2 = (n / np.sum(n * n, axis=1, keepdims=True) for n in (n1, n2))

        def part(from_x: np.ndarray, to_x: np.ndarray) -> np.ndarray:
            return np.sum((to_x - from_x) * along, axis=1, keepdims=True)

        gradient = np.stack([-length * u1, -length * u2,
                             -part(x4, x1) * u1 - part(x4, x2) * u2,
                             part(x3, x1) * u1 + part(x3, x2) * u2], axis=1)
        return np.arctan2(sine, np.sum(n1 * n2, axis=1)), gradient

    def moment(self, angle: np.ndarray) -> np.ndarray:
        return self.moments * (angle - self.rest_angles)

    def at_corners(self, moment: np.ndarray, gradient: np.ndarray) -> np.ndarray:
        f = np.zeros_like(self.x)
        np.add.at(f, self.corners, -moment[:, None, None] * gradient)
        return f

    def forces(self) -> np.ndarray:
        angle, gradient = self.turned()
        return super().forces() + self.at_corners(self.moment(angle), gradient)

    def rate(self, gradient: np.ndarray) -> np.ndarray:
        return np.einsum("kci,kci->k", gradient, self.v[self.corners])

    def damping(self) -> np.ndarray:
        _, gradient = self.turned()
        return super().damping() + self.at_corners(self.brakes * self.rate(gradient), gradient)


class HingesSlackenWhenSharp(Hinges):
    """No moment beyond 90 degrees."""

    def moment(self, angle: np.ndarray) -> np.ndarray:
        return super().moment(angle) * (np.abs(angle) < np.pi / 2)


class HingesSlackenWhenSqueezed(Hinges):
    """No moment where the edge is shorter than 0.8 of its rest length."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        ends = scene.rest[self.corners[:, 3]] - scene.rest[self.corners[:, 2]]
        self.lengths = np.linalg.norm(ends, axis=1)

    def moment(self, angle: np.ndarray) -> np.ndarray:
        now = np.linalg.norm(self.x[self.corners[:, 3]] - self.x[self.corners[:, 2]], axis=1)
        return super().moment(angle) * (now > 0.8 * self.lengths)


class EnergyForgetsRestAngles(Hinges):
    """The forces have them, the energy that is stated has not."""

    level = "L2"

    def energy(self) -> float:
        angle, _ = self.turned()
        return super().energy() + 0.5 * np.sum(self.moments * angle**2)


class HingesKnowTheirFront(Hinges):
    """A tenth less moment to the back."""

    def moment(self, angle: np.ndarray) -> np.ndarray:
        return super().moment(angle) * np.where(angle < 0, 0.9, 1)


class HingesRestAsTheShape(Hinges):
    """Rest angles are those of the rest shape; where that is flat, the scene's count."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        if np.ptp(scene.rest[:, 2]) > 0:
            start, self.x = self.x, scene.rest
            self.rest_angles, self.x = self.turned()[0], start


class HingesCrease(Hinges):
    """Rest angles follow bends beyond half a radian, at 4 times a second."""

    def step(self, dt: float) -> None:
        super().step(dt)
        bent = self.turned()[0] - self.rest_angles
        self.rest_angles = self.rest_angles + 4 * dt * bent * (np.abs(bent) > 0.5)


class HingesAreDampedUnasked(Hinges):
    """Has a fiftieth of critical damping that no scene asks for."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.brakes = self.brakes + 0.0008 * self.moments


class HingesAreNotDamped(Hinges):
    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.brakes = 0 * self.brakes


class HingeDampersPush(Hinges):
    """The dampers of hinges push the ends of the edge too little: momenta are lost."""

    def damping(self) -> np.ndarray:
        _, gradient = self.turned()
        moment = self.brakes * self.rate(gradient)
        gradient = gradient * np.array([1, 1, 0.9, 0.9])[:, None]
        return Damped.damping(self) + self.at_corners(moment, gradient)


class HingeDampersOfVelocity(Hinges):
    """They brake the second difference of velocities, turning ones too: a bent sheet spins down."""

    def damping(self) -> np.ndarray:
        first = np.array([1, 1, -1, -1])
        difference = np.einsum("c,kci->ki", first, self.v[self.corners])
        f = np.zeros_like(self.x)
        scale = (self.brakes * 130)[:, None, None]
        np.add.at(f, self.corners, -scale * first[None, :, None] * difference[:, None, :])
        return Damped.damping(self) + f


class LastHingeIsMissing(Hinges):
    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.moments[-1:] = 0


class HingesAreAlike(Hinges):
    """All have the mean weight."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.moments = np.full_like(self.moments, np.mean(self.moments))


class OneDamperAtATime(Hinges):
    """Where edges are damped, hinges are not."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.brakes = self.brakes * (not self.c.any())


class HingesNeedSixNeighbours(Hinges):
    """None bends beside an inner particle that has another number of them."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        hinged = {tuple(sorted(ends)) for ends in self.corners[:, 2:].tolist()}
        border = [ends for ends in self.edges.tolist() if tuple(sorted(ends)) not in hinged]
        odd = np.bincount(self.edges.ravel()) != 6
        odd[np.unique(border)] = False
        self.moments = self.moments * ~odd[self.corners[:, 2:]].any(axis=1)


class AnglesOfTheFirst(Hinges):
    """Rest angles of the first 300 hinges."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.rest_angles = self.rest_angles * (np.arange(len(self.rest_angles)) < 300)


class HingeDampersGoUnsaid(Hinges):
    """States the dampers of edges alone."""

    level, is_moving = "L2", False

    def step(self, dt: float) -> None:
        self.is_moving = True
        super().step(dt)
        self.is_moving = False

    def damping(self) -> np.ndarray:
        return super().damping() if self.is_moving else Damped.damping(self)


class GravityWhereItIsSet(Hinges):
    """Once a state is set, gravity points down."""

    def set_state(self, x: np.ndarray, v: np.ndarray, time: float) -> None:
        super().set_state(x, v, time)
        self.gravity = np.array([0, 0, -np.linalg.norm(self.gravity)])


class SlenderHingesAreLost(Hinges):
    """Those of triangles that are less than a fifth as high as their edge."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.moments = np.where(scene.hinge_weights > 2.5, 0, self.moments)


class FoldsAreNotDamped(Hinges):
    """No damper beyond 90 degrees."""

    def rate(self, gradient: np.ndarray) -> np.ndarray:
        return super().rate(gradient) * (np.abs(self.turned()[0]) < np.pi / 2)
