"""Dampers that are wrong, and forces and energies of level 2 that are not those of the motion."""
from __future__ import annotations

import numpy as np
from foldproof_solver import Scene
from materials import Damped
from toy import Toy
from toy_solver import ToySolver


class MeanDampers(Damped):
    """Every edge has the mean damper: momenta, and a triangle of equal sides, do not show it."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.c = np.full_like(self.c, self.c.mean())


class DampsLate(Damped):
    """Dampers act on the velocities of the step before, which a state that is set does not name."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.before = self.v

    def damp(self, dt: float) -> None:
        now, self.v = self.v, self.before
        push = self.damping()
        self.v, self.before = now + dt * push / self.mass[:, None], now


class StatesTwiceTheDamping(Damped):
    def damping(self) -> np.ndarray:
        return 2 * super().damping()

    def damp(self, dt: float) -> None:
        super().damp(dt / 2)


class StatesUnbalancedDamping(Damped):
    def damping(self) -> np.ndarray:
        f = super().damping()
        f[3] += 1e-9 * np.abs(f).max()
        return f

    def damp(self, dt: float) -> None:
        self.v = self.v + dt * super().damping() / self.mass[:, None]


class EnergyWithoutWeight(ToySolver):
    def energy(self) -> float:
        return super().energy() + np.sum(self.mass * (self.x @ self.gravity))


class StatesStaleForces(Toy):
    """States the forces of the last step, until the next one; no state can be set."""

    capabilities = ("held", "masses")

    def alter(self, scene: Scene) -> None:
        self.stale = self.springs()

    def forces(self) -> np.ndarray:
        now, self.springs = self.stale, lambda: now
        f = super().forces()
        del self.springs
        return f

    def step(self, dt: float) -> None:
        self.stale = self.springs()
        super().step(dt)


class ForgetsWhatIsSet(StatesStaleForces):
    """Forces after a motion are right; those of a state that is set are still of that motion."""

    capabilities = ToySolver.capabilities

    def advance(self, dt: float, steps: int) -> None:
        super().advance(dt, steps)
        self.stale = self.springs()
