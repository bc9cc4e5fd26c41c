#!/usr/bin/python3
"""Position-based springs that are tuned by substeps and iterations: settings.py KIND

"kept" is right. The others mislead whoever tunes them, each in one way that the map of
`foldproof converge --over substeps,iterations` must name.
"""
from __future__ import annotations

import os
import sys
from pathlib import Path

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # before numpy: small systems, and other jobs beside

import numpy as np  # noqa: E402

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "adapters"))
from foldproof_solver import Scene, serve  # noqa: E402
from toy_solver import ToySolver  # noqa: E402


def coloured(edges: np.ndarray) -> list[np.ndarray]:
    """Edges in groups that share no particle."""
    groups: list[tuple[set[int], list[int]]] = []
    for e, (a, b) in enumerate(edges.tolist()):
        for taken, group in groups:
            if a not in taken and b not in taken:
                break
        else:
            taken, group = set(), []
            groups.append((taken, group))
        taken.update((a, b))
        group.append(e)
    return [np.array(group) for _, group in groups]


class Kept(ToySolver):
    """A multiplier for each spring, kept over the sweeps of a substep."""

    name, scheme, order, level = "position-based springs", "XPBD", 1, "L1"
    capabilities = ("set_state", "held", "masses", "planes")
    tunables = {name: {"kind": name, "range": [1, 4096], "value": value, "proportional": True}
                for name, value in (("substeps", 4), ("iterations", 8))}

    def prepare(self, scene: Scene) -> dict[str, str]:
        mapping = super().prepare(scene)
        self.substeps, self.sweeps = (int(self.tuned(scene, name)) for name in self.tunables)
        self.colours = coloured(self.edges)
        self.w = 1 / self.mass
        self.w[self.held] = 0
        self.planes = scene.header["scene"].get("planes", [])
        return mapping

    def advance(self, dt: float, steps: int) -> None:
        for k in range(steps):
            self.progress(k / steps)
            for _ in range(self.substeps):
                self.substep(dt / self.substeps)
                self.collide()

    def substep(self, h: float) -> None:
        before = self.x.copy()
        self.v = self.v + h * self.gravity
        self.v[self.held] = 0
        self.x = before + h * self.v
        self.solve(h)
        self.v = (self.x - before) / h

    def solve(self, h: float) -> None:
        multipliers = np.zeros(len(self.k))
        for _ in range(self.sweeps):
            self.sweep(h, multipliers)

    def sweep(self, h: float, multipliers: np.ndarray) -> None:
        for group in self.colours:
            a, b = self.edges[group].T
            d = self.x[b] - self.x[a]
            now = np.linalg.norm(d, axis=1)
            softness = 1 / (self.k[group] * h * h)
            change = -(now - self.length[group] + softness * multipliers[group]) / (
                self.w[a] + self.w[b] + softness)
            multipliers[group] += change
            pull = (change / now)[:, None] * d
            self.x[a] -= self.w[a, None] * pull
            self.x[b] += self.w[b, None] * pull

    def collide(self) -> None:
        """No friction; what is below a plane is put on it, and stops."""
        for plane in self.planes:
            normal = np.array(plane["normal"])
            depth = np.minimum((self.x - np.array(plane["point"])) @ normal, 0)
            self.x = self.x - depth[:, None] * normal
            into = np.where(depth < 0, np.minimum(self.v @ normal, 0), 0)
            self.v = self.v - into[:, None] * normal


class ResetsMultipliers(Kept):
    """Springs are as many times as stiff as there are sweeps: no limit."""

    def solve(self, h: float) -> None:
        for _ in range(self.sweeps):
            self.sweep(h, np.zeros(len(self.k)))


class StopsEarly(Kept):
    """A few sweeps of Gauss and Seidel for one long step, however many are asked: a tenth."""

    def solve(self, h: float) -> None:
        multipliers = np.zeros(len(self.k))
        for _ in range(max(1, self.sweeps // 10)):
            self.sweep(h, multipliers)


class ContactOncePerStep(Kept):
    """Substeps refine the springs alone."""

    def advance(self, dt: float, steps: int) -> None:
        for _ in range(steps):
            for _ in range(self.substeps):
                self.substep(dt / self.substeps)
            self.collide()


class CapsSubsteps(Kept):
    def prepare(self, scene: Scene) -> dict[str, str]:
        mapping = super().prepare(scene)
        self.substeps = min(self.substeps, 8)
        return mapping


class SingleFloor(Kept):
    """Its state is rounded to single precision after each substep; it declares double."""

    def substep(self, h: float) -> None:
        super().substep(h)
        self.x, self.v = self.x.astype("f4").astype("f8"), self.v.astype("f4").astype("f8")


KINDS = {"kept": Kept, "resets_multipliers": ResetsMultipliers, "stops_early": StopsEarly,
         "contact_once_per_step": ContactOncePerStep, "caps_substeps": CapsSubsteps,
         "single_floor": SingleFloor}

if __name__ == "__main__":
    serve(KINDS[sys.argv[1]]())
