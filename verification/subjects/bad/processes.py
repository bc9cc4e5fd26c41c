"""Solvers that remember what they should forget, and correct ones that are slow."""
from __future__ import annotations

import time

import numpy as np
from foldproof_solver import Scene
from toy import Toy
from toy_solver import ToySolver


class StateNotRestored(ToySolver):
    """What a warm start of an iteration leaves behind: the last velocity is kept over set_state."""

    kept = 0.0

    def set_state(self, x: np.ndarray, v: np.ndarray, time: float) -> None:
        super().set_state(x, v + 1e-9 * self.kept, time)

    def advance(self, dt: float, steps: int) -> None:
        super().advance(dt, steps)
        self.kept = float(np.abs(self.v).max())


class SceneLeavesTraces(ToySolver):
    steps_so_far = 0

    def advance(self, dt: float, steps: int) -> None:
        super().advance(dt, steps)
        self.steps_so_far += steps
        self.x = self.x * (1 + 1e-15 * self.steps_so_far)


class Random(ToySolver):
    def advance(self, dt: float, steps: int) -> None:
        super().advance(dt, steps)
        self.x = self.x * (1 + 1e-14 * np.random.default_rng().random(self.x.shape))


class RestLengthsKept(Toy):
    """Takes the rest lengths of the last scene that had the same edges."""

    def __init__(self) -> None:
        self.known: dict[bytes, np.ndarray] = {}

    def alter(self, scene: Scene) -> None:
        self.length = self.known.setdefault(self.edges.tobytes(), self.length)


class Sleeps(ToySolver):
    """Right, and slow: a millisecond more a step."""

    def advance(self, dt: float, steps: int) -> None:
        super().advance(dt, steps)
        time.sleep(1e-3 * steps)


class AsksAllPairs(ToySolver):
    """Right, and slow on large sheets: it computes for 400 ns a pair of particles, its own step
    included."""

    def advance(self, dt: float, steps: int) -> None:
        done = time.process_time() + 4e-7 * steps * len(self.x) ** 2
        super().advance(dt, steps)
        while time.process_time() < done:
            np.hypot(self.x[:64, 0], self.x[:64, 1])


class WaitsForAllPairs(ToySolver):
    """Likewise, somewhere else: an answer takes 400 ns a pair, as from a computer that it asks."""

    def advance(self, dt: float, steps: int) -> None:
        answered = time.monotonic() + 4e-7 * steps * len(self.x) ** 2
        super().advance(dt, steps)
        time.sleep(max(0, answered - time.monotonic()))
