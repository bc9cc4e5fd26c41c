"""Solvers in whose motions nothing happens: with these, no law of motion may hold."""
from __future__ import annotations

import numpy as np
from foldproof_solver import Scene
from materials import Bends
from toy_solver import ToySolver

EVERYTHING = (*ToySolver.capabilities, "damping", "planes", "boxes", "spheres", "capsules",
              "self_collision")


class NeverMoves(ToySolver):
    """Answers each call with what it was given, and states no force."""

    capabilities = EVERYTHING

    def prepare(self, scene: Scene) -> dict[str, str]:
        self.x, self.v = scene.x, scene.v
        return {}

    def advance(self, dt: float, steps: int) -> None:
        pass

    def forces(self) -> np.ndarray:
        return np.zeros_like(self.x)

    def energy(self) -> float:
        return 0.0


class MovesRigidly(NeverMoves):
    """All particles have the mean velocity, and fall with it; held ones hold all of them."""

    def prepare(self, scene: Scene) -> dict[str, str]:
        self.is_held, self.mass = len(scene.held) > 0, scene.mass
        self.gravity = np.array(scene.header["scene"]["gravity"])
        return super().prepare(scene)

    def advance(self, dt: float, steps: int) -> None:
        if self.is_held:
            return
        mean = self.mass @ self.v / self.mass.sum()
        self.v = np.tile(mean, (len(self.x), 1))
        for _ in range(steps):
            self.v = self.v + dt * self.gravity
            self.x = self.x + dt * self.v

    def forces(self) -> np.ndarray:
        return self.mass[:, None] * self.gravity

    def energy(self) -> float:
        return -float(np.sum(self.mass * (self.x @ self.gravity)))


class IgnoresAllContact(Bends):
    """Declares every obstacle and meets none."""

    capabilities = (*ToySolver.capabilities, "planes", "boxes", "spheres", "capsules",
                    "self_collision")
