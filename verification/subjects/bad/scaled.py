"""Solvers that are slightly wrong: one quantity is the scene's times a factor."""
from __future__ import annotations

import numpy as np
from contact import OnPlanes
from materials import Bends, Damped
from round_bodies import OnRoundBodies
from schemes import ToySolver

from foldproof_solver import Scene


class Young(ToySolver):
    factor = 1.0

    def prepare(self, scene: Scene) -> dict[str, str]:
        mapping = super().prepare(scene)
        self.k = self.factor * self.k
        return mapping


class Gravity(ToySolver):
    def prepare(self, scene: Scene) -> dict[str, str]:
        mapping = super().prepare(scene)
        self.gravity = self.factor * self.gravity
        return mapping


class OneEnd(ToySolver):
    """The pull of each spring on its second end."""

    def forces(self) -> np.ndarray:
        direction, elongation = self.springs()
        f = super().forces()
        pull = (self.factor - 1) * self.k * elongation
        np.add.at(f, self.edges[:, 1], -pull[:, None] * direction)
        return f


class Rigidity(Bends):
    @property
    def rigidity(self) -> float:
        return self.factor


class Damping(Damped):
    @property
    def share(self) -> float:
        return self.factor


class DampedYoung(Young, Damped):
    """Springs and their dampers, whose times remain."""

    def prepare(self, scene: Scene) -> dict[str, str]:
        mapping = super().prepare(scene)
        self.c = self.factor * self.c
        return mapping


class Friction(OnPlanes):
    def kept(self, most: np.ndarray, speed: np.ndarray) -> np.ndarray:
        return super().kept(self.factor * most, speed)


class Radius(OnRoundBodies):
    @property
    def scale(self) -> float:
        return self.factor


QUANTITIES = {
    "young": Young,
    "gravity": Gravity,
    "one_end": OneEnd,
    "rigidity": Rigidity,
    "damping": Damping,
    "damped_young": DampedYoung,
    "friction": Friction,
    "radius": Radius,
}


def scaled(quantity: str, factor: str) -> ToySolver:
    solver = QUANTITIES[quantity]()
    solver.factor = float(factor)
    return solver
