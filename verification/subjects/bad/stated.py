"""Dampers that are wrong, and forces and energies of level 2 that are not those of the motion."""
from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "adapters"))
from foldproof_solver import Scene  # noqa: E402
from materials import Damped  # noqa: E402
from toy_solver import ToySolver  # noqa: E402


class MeanDampers(Damped):
    """Every edge has the mean damper: momenta, and a triangle of equal sides, do not show it."""

    def prepare(self, scene: Scene) -> dict[str, str]:
        mapping = super().prepare(scene)
        self.c = np.full_like(self.c, self.c.mean())
        return mapping


class DampsLate(Damped):
    """Dampers act on the velocities of the step before, which a state that is set does not name."""

    def prepare(self, scene: Scene) -> dict[str, str]:
        mapping = super().prepare(scene)
        self.before = self.v
        return mapping

    def advance(self, dt: float, steps: int) -> None:
        for _ in range(steps):
            now, self.v = self.v, self.before
            push = self.damping()
            self.v, self.before = now + dt * push / self.mass[:, None], now
            ToySolver.advance(self, dt, 1)


class StatesTwiceTheDamping(Damped):
    def damping(self) -> np.ndarray:
        return 2 * super().damping()

    def advance(self, dt: float, steps: int) -> None:
        for _ in range(steps):
            self.v = self.v + dt / 2 * self.damping() / self.mass[:, None]
            ToySolver.advance(self, dt, 1)


class StatesUnbalancedDamping(Damped):
    def damping(self) -> np.ndarray:
        f = super().damping()
        f[3] += 1e-9 * np.abs(f).max()
        return f

    def advance(self, dt: float, steps: int) -> None:
        for _ in range(steps):
            self.v = self.v + dt * super().damping() / self.mass[:, None]
            ToySolver.advance(self, dt, 1)


class EnergyWithoutWeight(ToySolver):
    def energy(self) -> float:
        return super().energy() + np.sum(self.mass * (self.x @ self.gravity))


class StatesStaleForces(ToySolver):
    """States the forces of the last step, until the next one; no state can be set."""

    capabilities = ("held", "masses")

    def prepare(self, scene: Scene) -> dict[str, str]:
        mapping = super().prepare(scene)
        self.stale = self.springs()
        return mapping

    def forces(self) -> np.ndarray:
        now, self.springs = self.stale, lambda: now
        f = super().forces()
        del self.springs
        return f

    def advance(self, dt: float, steps: int) -> None:
        for _ in range(steps):
            self.stale = self.springs()
            super().advance(dt, 1)


class ForgetsWhatIsSet(StatesStaleForces):
    """Forces after a motion are right; those of a state that is set are still of that motion."""

    capabilities = ToySolver.capabilities

    def advance(self, dt: float, steps: int) -> None:
        super().advance(dt, steps)
        self.stale = self.springs()
