"""Correct schemes for the springs of the toy, beside its symplectic Euler."""
from __future__ import annotations

import os
import sys
from pathlib import Path

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # before numpy: small systems, and other jobs beside

import numpy as np  # noqa: E402

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "adapters"))
from foldproof_solver import Scene  # noqa: E402
from toy_solver import ToySolver  # noqa: E402


class Implicit(ToySolver):
    """One nonlinear solve a step, dense: theta 1 is backward Euler, 1/2 the trapezoidal rule."""

    theta, level = 1.0, "L1"

    def jacobian(self) -> np.ndarray:
        direction, elongation = self.springs()
        length = self.length + elongation
        across = self.k * elongation / length
        block = np.einsum("e,ei,ej->eij", self.k - across, direction, direction) + across[
            :, None, None
        ] * np.eye(3)
        n = len(self.x)
        matrix = np.zeros((n, n, 3, 3))
        a, b = self.edges.T
        for rows, columns, sign in ((a, a, -1), (b, b, -1), (a, b, 1), (b, a, 1)):
            np.add.at(matrix, (rows, columns), sign * block)
        return matrix.transpose(0, 2, 1, 3).reshape(3 * n, 3 * n)

    def advance(self, dt: float, steps: int) -> None:
        for _ in range(steps):
            self.solve_step(dt)

    def solve_step(self, dt: float) -> None:
        x, v, mass = self.x, self.v, np.repeat(self.mass, 3)
        known, new = self.forces(), v.copy()
        free = np.repeat(~np.isin(np.arange(len(x)), self.held), 3)
        matrix = np.diag(mass) - (dt * self.theta) ** 2 * self.jacobian()
        # at the start of the step: chord iterations
        inverse = np.linalg.inv(matrix[np.ix_(free, free)])
        size = np.inf
        for _ in range(40):
            self.x = x + dt * (self.theta * new + (1 - self.theta) * v)
            mean = self.theta * self.forces() + (1 - self.theta) * known
            residual = mass * (new - v).ravel() - dt * mean.ravel()
            change = inverse @ residual[free]
            new.ravel()[free] -= change
            last, size = size, np.abs(change).max()
            if size == 0 or (size < 1e-12 and size >= last):  # rounding is left
                break
        self.x, self.v = x + dt * (self.theta * new + (1 - self.theta) * v), new


class BackwardEuler(Implicit):
    scheme = "backward Euler"


class BackwardEulerInSingle(BackwardEuler):
    """Its state is rounded to single precision after each step."""

    precision = "f4"

    def solve_step(self, dt: float) -> None:
        super().solve_step(dt)
        self.x, self.v = self.x.astype("f4").astype("f8"), self.v.astype("f4").astype("f8")


class Trapezoidal(Implicit):
    theta, scheme, order = 0.5, "trapezoidal rule", 2


class Single(ToySolver):
    precision = "f4"

    def prepare(self, scene: Scene) -> dict[str, str]:
        mapping = super().prepare(scene)
        for name in ("x", "v", "mass", "k", "length", "gravity"):
            setattr(self, name, getattr(self, name).astype("f4"))
        return mapping

    def set_state(self, x: np.ndarray, v: np.ndarray, time: float) -> None:
        super().set_state(x.astype("f4"), v.astype("f4"), time)

    def advance(self, dt: float, steps: int) -> None:
        super().advance(np.float32(dt), steps)
