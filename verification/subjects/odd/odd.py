#!/usr/bin/python3
"""Right but unusual solvers, which no law may fail: odd.py KIND

They declare what is unusual about them (PROTOCOL.md, "The declaration"). All share one toy:
springs, dampers, bending, every kind of obstacle, symplectic Euler.
"""
from __future__ import annotations

import os
import sys
from pathlib import Path

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import numpy as np  # noqa: E402

FOLDER = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(FOLDER / "adapters"), str(FOLDER / "bad")]
from foldproof_solver import Declined, Scene, serve  # noqa: E402
from materials import Bends, Damped  # noqa: E402
from round_bodies import OnRoundBodies  # noqa: E402
from schemes import BackwardEuler, SingleForDouble  # noqa: E402
from toy_solver import ToySolver  # noqa: E402


class Whole(OnRoundBodies, Damped, Bends):
    """The shared toy."""

    capabilities = (*ToySolver.capabilities, "damping", "planes", "boxes", "spheres", "capsules")
    contact_offset = 0.0  # m, declared where it is not 0

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.boxes = scene.header["scene"].get("boxes", [])

    def meet_obstacles(self) -> None:
        for plane in self.planes:
            self.respond(plane)
        for box in self.boxes:
            self.meet_box(box)
        super().meet_obstacles()

    def meet_box(self, box: dict) -> None:
        """Along the way to the nearest point of its surface."""
        half = np.array(box["half_extents"])
        from_middle = self.before + self.dt * self.v - np.array(box["centre"])
        beyond = np.abs(from_middle) - half  # (N, 3)
        outside = np.linalg.norm(np.maximum(beyond, 0), axis=1)
        nearest = np.eye(3)[np.argmax(beyond, axis=1)]
        normals = np.where(outside[:, None] > 0, np.maximum(beyond, 0), nearest)
        normals *= np.sign(from_middle) / np.linalg.norm(normals, axis=1)[:, None]
        self.touch(normals, np.where(outside > 0, outside, beyond.max(axis=1)), box["friction"])

    def touch(self, normals: np.ndarray, gap: np.ndarray, friction: float) -> None:
        super().touch(normals, gap - self.contact_offset, friction)


class Shell1mm(Whole):
    contact_offset = 1e-3
    more = {"contact_offset": contact_offset}


class Shell2mm(Whole):
    contact_offset = 2e-3
    more = {"contact_offset": contact_offset}


class Shell5mm(Whole):
    contact_offset = 5e-3
    more = {"contact_offset": contact_offset}


class Single(SingleForDouble, Whole):
    precision = "f4"


class RandomSums(Whole):
    """Sums forces in another order each time, as threads do."""

    more = {"deterministic": False}
    random = np.random.default_rng()  # unseeded

    def forces(self) -> np.ndarray:
        order = self.random.permutation(len(self.edges))
        self.edges, self.k, self.c = self.edges[order], self.k[order], self.c[order]
        self.length = self.length[order]
        return super().forces()


class Substeps(Whole):
    """Divides a step into equal ones that are not longer than its own."""

    substep = 7e-4  # s
    more = {"substep": substep}

    def advance(self, dt: float, steps: int) -> None:
        parts = int(np.ceil(dt / self.substep * (1 - 1e-9)))
        super().advance(dt / parts, steps * parts)


class ConsistentMass(Damped, Bends):
    """Of linear triangles, in two steps for one: its highest frequency is twice as high."""

    capabilities = ("set_state", "held", "damping")
    more = {"mass_matrix": "consistent"}

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        if scene.header["scene"]["own_masses"]:
            raise Declined("masses other than the density's")
        matrix, t = np.zeros((len(self.x), len(self.x))), scene.triangles
        a, b, c = (scene.rest[t[:, k]] for k in range(3))
        area = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
        share = scene.header["scene"]["material"]["density"] * area / 12
        for i in range(3):
            for j in range(3):
                np.add.at(matrix, (t[:, i], t[:, j]), share * (2 if i == j else 1))
        self.free = np.setdiff1d(np.arange(len(self.x)), self.held)
        self.inverse = np.linalg.inv(matrix[np.ix_(self.free, self.free)])

    def step(self, dt: float) -> None:
        for _ in range(2):
            f = self.forces() + self.damping()
            self.v[self.free] += dt / 2 * self.inverse @ f[self.free]
            self.v[self.held] = 0
            self.x = self.x + dt / 2 * self.v


class LinearisedBackwardEuler(BackwardEuler):
    """One linear solve a step."""

    scheme, tolerance = "linearised backward Euler", 1e-10

    def step(self, dt: float) -> None:
        blocks, mass = self.blocks(), self.mass[:, None]
        kept = mass * self.v * self.is_free[:, None] - self.times_matrix(blocks, dt * dt, self.v)
        b = dt * self.forces() * self.is_free[:, None] + kept
        self.v = self.v + self.solve(blocks, dt * dt, b)
        self.x = self.x + dt * self.v


class LooseSolves(LinearisedBackwardEuler):
    """Declares that its linear systems are solved to a thousandth."""

    solve_tolerance = tolerance = 1e-3


KINDS = {
    "double": Whole, "single": Single, "shell_1mm": Shell1mm, "shell_2mm": Shell2mm,
    "shell_5mm": Shell5mm, "random_sums": RandomSums, "substeps": Substeps,
    "consistent_mass": ConsistentMass, "linearised": LinearisedBackwardEuler,
    "loose_solves": LooseSolves,
}

if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1] not in KINDS:
        print("usage: odd.py KIND, below foldproof;", *KINDS)
        sys.exit(2)
    serve(KINDS[sys.argv[1]]())
