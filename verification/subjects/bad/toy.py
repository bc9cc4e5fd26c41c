"""The toy of adapters/, with two places where a solver may differ from it."""
from __future__ import annotations

import numpy as np
from foldproof_solver import Scene
from toy_solver import ToySolver


class Toy(ToySolver):
    def prepare(self, scene: Scene) -> dict[str, str]:
        mapping = super().prepare(scene)
        self.alter(scene)
        return mapping

    def alter(self, scene: Scene) -> None:
        """At the end of `prepare`."""

    def advance(self, dt: float, steps: int) -> None:
        for _ in range(steps):
            self.step(dt)

    def step(self, dt: float) -> None:
        super().advance(dt, 1)


def add_pulls(f: np.ndarray, edges: np.ndarray, pull: np.ndarray) -> None:
    """Of springs or dampers (E, 3) on both of their ends."""
    np.add.at(f, edges[:, 0], pull)
    np.add.at(f, edges[:, 1], -pull)
