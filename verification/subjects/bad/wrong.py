#!/usr/bin/python3
"""Solvers that keep to the protocol and are wrong, each in one law of
physics or one claim: wrong.py KIND

The portable suite must find each by the laws that it breaks. "none" is the unspoiled toy;
"backward_euler" and "trapezoidal", alone or after "damped_", and "in_turn" are other correct
schemes, which must raise no alarm, at f8; "single", "backward_euler_single" and
"substeps_in_single" are some at f4, as "bends_in_substeps_of_single", "sleeps" is right but slow,
and "clamps_where_held" right where bending begins behind a clamp.

A kind is the name of a class here or in the modules below, or a row of `scaled`.
"""
from __future__ import annotations

import functools
import os
import re
import sys
from collections.abc import Iterator
from pathlib import Path

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # before numpy: small systems, and other jobs beside

import numpy as np  # noqa: E402

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "adapters"))
import contact  # noqa: E402
import hinges  # noqa: E402, F401
import idle  # noqa: E402, F401
import limits  # noqa: E402, F401
import moving  # noqa: E402, F401
import obstacles  # noqa: E402
import processes  # noqa: E402
import read_contact  # noqa: E402, F401
import scaled  # noqa: E402
import several  # noqa: E402, F401
import stated  # noqa: E402
import woven  # noqa: E402, F401
from foldproof_solver import Scene, serve  # noqa: E402
from materials import Bends  # noqa: E402
from schemes import Single  # noqa: E402
from toy import Toy, add_pulls  # noqa: E402
from toy_solver import ToySolver  # noqa: E402


class WrongMass(Toy):
    def alter(self, scene: Scene) -> None:
        self.mass = np.full_like(self.mass, self.mass.mean())


class OwnMassesIgnored(Toy):
    """Masses are those of the density, whatever the scene says."""

    def alter(self, scene: Scene) -> None:
        a, b, c = (scene.rest[scene.triangles[:, k]] for k in range(3))
        areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
        thirds = np.repeat(scene.header["scene"]["material"]["density"] * areas / 3, 3)
        self.mass = np.bincount(scene.triangles.ravel(), thirds, len(self.x))


class StandsStillToHalf(Toy):
    """Moves nothing, and declares a tolerance that would allow it."""

    solve_tolerance = 0.5

    def step(self, dt: float) -> None:
        pass


class MomentumDropped(Toy):
    def step(self, dt: float) -> None:
        super().step(dt)
        self.v[0] *= 0.999


class FirstOrderAsSecond(Toy):
    scheme, order = "symplectic Euler, said to be Verlet", 2


class FirstOrderAsSecondSingle(FirstOrderAsSecond, Single):
    pass


class HiddenDamping(Toy):
    def step(self, dt: float) -> None:
        super().step(dt)
        self.v *= 1 - 0.05 * dt


class KnowsItsAxes(Toy):
    """Springs along x are stiffer: right where it was tried, wrong when turned."""

    def forces(self) -> np.ndarray:
        f = super().forces()
        weight = self.mass[:, None] * self.gravity
        return weight + (f - weight) * np.array([1.01, 1, 1])


class DependsOnNumbers(Toy):
    """Springs whose first end has an even number are stiffer by a millionth."""

    def alter(self, scene: Scene) -> None:
        self.k = self.k * (1 + 1e-6 * (self.edges[:, 0] % 2 == 0))


class HeldLoosely(Toy):
    def advance(self, dt: float, steps: int) -> None:
        held, self.held = self.held, np.array([], int)
        start = self.x[held].copy()
        super().advance(dt, steps)
        self.x[held] = start + 1e-6 * (self.x[held] - start)
        self.held = held


class SpinDamped(Toy):
    """Takes angular momentum from a free sheet, linear momentum not."""

    def step(self, dt: float) -> None:
        super().step(dt)
        mean = self.mass @ self.v / self.mass.sum()
        self.v = mean + (1 - 0.5 * dt) * (self.v - mean)


class ForcesUnbalanced(Toy):
    def forces(self) -> np.ndarray:
        f = super().forces()
        f[3] += 1e-9 * np.abs(f).max()
        return f


class KnowsItsUnits(Toy):
    """A margin in metres: rest lengths below it are not met."""

    def forces(self) -> np.ndarray:
        direction, elongation = self.springs()
        slack = np.sign(elongation) * np.minimum(np.abs(elongation), 1e-6)
        f = super().forces()
        add_pulls(f, self.edges, -(self.k * slack)[:, None] * direction)
        return f


class KnowsLeftFromRight(Toy):
    """Each triangle is turned a little about its normal."""

    def alter(self, scene: Scene) -> None:
        self.triangles = scene.triangles

    def forces(self) -> np.ndarray:
        f, corners = super().forces(), self.triangles.T
        for k in range(3):
            side = self.x[corners[(k + 2) % 3]] - self.x[corners[(k + 1) % 3]]
            np.add.at(f, corners[k], 1e-6 * side)
        return f


class StiffensWithSmallSteps(Toy):
    """What a fixed number of iterations without compliance does: stiffness goes as 1/dt^2."""

    def step(self, dt: float) -> None:
        given, self.k = self.k, self.k * (0.002 / dt) ** 2
        super().step(dt)
        self.k = given


class StiffensALittleSingle(Single):
    """Its changes grow fourfold, and are less than a bound on rounding in single precision."""

    def step(self, dt: float) -> None:
        given, self.k = self.k, self.k * np.float32(0.99 + 0.01 * (0.002 / dt) ** 2)
        super().step(dt)
        self.k = given


class SubstepsInSingle(Single):
    """Right, as position based engines are: five substeps a step, velocities from positions of
    single precision, so that short steps are mostly rounding."""

    def step(self, dt: float) -> None:
        dt /= 5
        for _ in range(5):
            start = self.x.astype("f4")
            super().step(dt)
            self.x = self.x.astype("f4").astype("f8")
            self.v = (self.x - start) / dt


class BendsInSubstepsOfSingle(SubstepsInSingle, Bends):
    """Right; in steps of 0.1 ms a strip gains less speed by its bending than rounding gives it."""


def below(kind: type) -> Iterator[type]:
    for other in kind.__subclasses__():
        yield other
        yield from below(other)


def snake_case(name: str) -> str:
    return re.sub(r"(?<!^)(?=[A-Z])", "_", name).lower()


KINDS = {"none": ToySolver} | {
    snake_case(kind.__name__): kind
    for kind in below(ToySolver)
    if kind is not Toy and kind.__module__ != scaled.__name__
} | {kind: functools.partial(scaled.scaled, *row) for kind, row in scaled.KINDS.items()}

if __name__ == "__main__":
    if len(sys.argv) == 4 and sys.argv[1] == "scaled" and sys.argv[2] in scaled.QUANTITIES:
        serve(scaled.scaled(scaled.QUANTITIES[sys.argv[2]], float(sys.argv[3])))
        sys.exit()
    if len(sys.argv) != 2 or sys.argv[1] not in KINDS:
        print("usage: wrong.py KIND, below foldproof;", *KINDS)
        print("or wrong.py scaled QUANTITY FACTOR;", *scaled.QUANTITIES)
        sys.exit(2)
    serve(KINDS[sys.argv[1]]())
