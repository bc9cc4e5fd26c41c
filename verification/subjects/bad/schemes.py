"""Correct schemes for the springs of the toy, beside its symplectic Euler."""
from __future__ import annotations

import numpy as np
from foldproof_solver import Scene
from materials import Damped, DampedVerlet
from toy import Toy
from toy_solver import ToySolver


class BackwardEuler(Toy):
    """One nonlinear solve a step: theta 1 is backward Euler, 1/2 the trapezoidal rule."""

    theta, level, scheme = 1.0, "L1", "backward Euler"
    tolerance = 1e-3  # of a linear solve, over its right-hand side

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        ends = self.edges.T.ravel()
        self.by_end = np.argsort(ends, kind="stable")
        self.first_of = np.searchsorted(ends[self.by_end], np.arange(len(self.x)))
        self.is_free = ~np.isin(np.arange(len(self.x)), self.held)
        self.v = self.v * self.is_free[:, None]

    def blocks(self) -> np.ndarray:
        """(E, 3, 3): change of the pull of each edge; without what compression takes from it, so
        that the matrix is positive definite."""
        direction, elongation = self.springs()
        across = self.k * np.maximum(0, elongation) / (self.length + elongation)
        return np.einsum("e,ei,ej->eij", self.k - across, direction, direction) + across[
            :, None, None
        ] * np.eye(3)

    def times_matrix(self, blocks: np.ndarray, square: float, p: np.ndarray) -> np.ndarray:
        """mass - square * the forces' derivative, times p."""
        pull = np.einsum("eij,ej->ei", blocks, p[self.edges[:, 1]] - p[self.edges[:, 0]])
        at_ends = np.concatenate([pull, -pull])[self.by_end]
        product = self.mass[:, None] * p - square * np.add.reduceat(at_ends, self.first_of)
        return product * self.is_free[:, None]

    def solve(self, blocks: np.ndarray, square: float, b: np.ndarray) -> np.ndarray:
        """Conjugate gradients."""
        x, r = np.zeros_like(b), b.copy()
        p, rr = r, np.sum(r * r)
        enough = self.tolerance**2 * rr
        for _ in range(3 * len(b)):
            if not rr > enough:
                break
            ap = self.times_matrix(blocks, square, p)
            alpha = rr / np.sum(p * ap)
            x, r = x + alpha * p, r - alpha * ap
            rr, before = np.sum(r * r), rr
            p = r + rr / before * p
        return x

    def step(self, dt: float) -> None:
        x, v, mass = self.x.astype("f8"), self.v.astype("f8"), self.mass[:, None]
        self.x = x
        known, new, blocks = self.forces(), v.copy(), self.blocks()
        size = np.inf
        for _ in range(60):  # the matrix is that of the step's start
            self.x, self.v = x + dt * (self.theta * new + (1 - self.theta) * v), new
            mean = self.theta * self.forces() + (1 - self.theta) * known
            residual = (mass * (new - v) - dt * mean) * self.is_free[:, None]
            change = self.solve(blocks, (dt * self.theta) ** 2, residual)
            new -= change
            last, size = size, np.abs(change).max()
            if size == 0 or (size < 1e-12 and size >= last):  # rounding is left
                break
        self.x, self.v = x + dt * (self.theta * new + (1 - self.theta) * v), new


class SoftensInLongSteps(BackwardEuler):
    """Springs are no stiffer than 4 m/dt^2, as where a solve ends before it has converged."""

    def step(self, dt: float) -> None:
        given, self.k = self.k, np.minimum(self.k, 4 * self.mass.mean() / dt**2)
        super().step(dt)
        self.k = given


class SingleForDouble(Toy):
    """The state is rounded to single precision after each step."""

    def step(self, dt: float) -> None:
        super().step(dt)
        self.x, self.v = self.x.astype("f4").astype("f8"), self.v.astype("f4").astype("f8")


class BackwardEulerSingle(SingleForDouble, BackwardEuler):
    precision = "f4"


class DampedVerletSingle(SingleForDouble, DampedVerlet):
    precision = "f4"


class Trapezoidal(BackwardEuler):
    theta, scheme, order = 0.5, "trapezoidal rule", 2


class InTurn(Toy):
    """One sweep of Gauss and Seidel in place of backward Euler's solve: each spring in its turn
    pulls as it must after those before it. What their order changes falls with the step."""

    scheme, level = "one sweep of springs", "L1"

    def step(self, dt: float) -> None:
        v = self.v + dt * self.gravity
        v[self.held] = 0
        x, w = self.x + dt * v, 1 / self.mass
        w[self.held] = 0
        for a, b, k, length in zip(*self.edges.T, self.k, self.length, strict=True):
            d = x[b] - x[a]
            now = np.linalg.norm(d)
            weight = w[a] + w[b]
            pull = k * dt * dt * (now - length) / (1 + k * dt * dt * weight) / now
            x[a] += w[a] * pull * d
            x[b] -= w[b] * pull * d
        self.x, self.v = x, (x - self.x) / dt


class DampedBackwardEuler(Damped, BackwardEuler):
    """Its damping is that of the velocities that it solves for."""

    def forces(self) -> np.ndarray:
        return super().forces() + self.damping()

    def step(self, dt: float) -> None:
        BackwardEuler.step(self, dt)


class DampedTrapezoidal(DampedBackwardEuler):
    theta, scheme, order = 0.5, "trapezoidal rule", 2


class Single(Toy):
    precision = "f4"

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        for name in ("x", "v", "mass", "k", "length", "gravity"):
            setattr(self, name, getattr(self, name).astype("f4"))

    def set_state(self, x: np.ndarray, v: np.ndarray, time: float) -> None:
        super().set_state(x.astype("f4"), v.astype("f4"), time)

    def step(self, dt: float) -> None:
        super().step(np.float32(dt))
