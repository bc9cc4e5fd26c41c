"""Solvers of which one quantity is the scene's times a factor."""
from __future__ import annotations

import numpy as np
from contact import OnPlanes
from foldproof_solver import Scene
from materials import Bends, Damped
from round_bodies import OnRoundBodies
from schemes import Single
from toy import Toy


class Young(Toy):
    factor = 1.0

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.k = self.factor * self.k


class Gravity(Toy):
    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.gravity = self.factor * self.gravity


class GravityOfSingle(Gravity, Single):
    pass


class RestLengths(Toy):
    def alter(self, scene: Scene) -> None:
        self.length = self.factor * self.length


class OneEnd(Toy):
    """The pull of each spring on its second end."""

    def forces(self) -> np.ndarray:
        direction, elongation = self.springs()
        f = super().forces()
        pull = (self.factor - 1) * self.k * elongation
        np.add.at(f, self.edges[:, 1], -pull[:, None] * direction)
        return f


class Energy(Toy):
    def energy(self) -> float:
        return self.factor * super().energy()


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

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.c = self.factor * self.c


class Friction(OnPlanes):
    def kept(self, most: np.ndarray, speed: np.ndarray) -> np.ndarray:
        return super().kept(self.factor * most, speed)


class FrictionOfBending(Friction, Bends):
    pass


class RoundFriction(Friction, OnRoundBodies):
    pass


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

# bends_fourfold takes the paper's constant for the rigidity; single gravity is wrong by less than a
# loose bound on the rounding of single precision would allow.
KINDS = {
    "pre_stressed": (RestLengths, 0.999),
    "energy_halved": (Energy, 0.5),
    "gravity_scaled": (Gravity, 1.02),
    "gravity_scaled_single": (GravityOfSingle, np.float32(1.01)),
    "damping_halved": (Damping, 0.5),
    "bends_fourfold": (Rigidity, 4.0),
    "bends_not_at_all": (Rigidity, 0.0),
    "friction_halved": (Friction, 0.5),
    "bends_on_planes_friction_halved": (FrictionOfBending, 0.5),
    "round_friction_halved": (RoundFriction, 0.5),
    "radius_too_small": (Radius, 0.97),
    "radius_too_large": (Radius, 1.06),
}


def scaled(kind: type[Toy], factor: float) -> Toy:
    solver = kind()
    solver.factor = factor
    return solver
