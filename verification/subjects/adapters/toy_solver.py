#!/usr/bin/python3
"""A mass-spring solver in forty lines, as an example: springs along the edges, symplectic Euler.

foldproof judge --solver "/usr/bin/python3 verification/subjects/adapters/toy_solver.py"
"""
from __future__ import annotations

import numpy as np
from foldproof_solver import Declined, Scene, Solver, serve


class ToySolver(Solver):
    name, version, level, precision = "toy springs (Python)", "1.0", "L2", "f8"
    scheme, order = "symplectic Euler", 1
    capabilities = ("set_state", "held", "masses")

    def prepare(self, scene: Scene) -> dict[str, str]:
        if scene.header["scene"]["material"]["bending_rigidity"] > 0:
            raise Declined("bending")
        self.x, self.v, self.mass, self.held = scene.x, scene.v.copy(), scene.mass, scene.held
        self.edges, self.k, self.length = scene.edges, scene.edge_stiffness, scene.rest_lengths
        self.v[self.held] = 0  # even if the scene gives them a velocity
        self.gravity = np.array(scene.header["scene"]["gravity"])
        return {
            "stretch": "a spring per edge, of the edge's own stiffness [N/m]",
            "damping": "none",
        }

    def springs(self) -> tuple[np.ndarray, np.ndarray]:
        """Directions (E, 3) [1] and elongations (E) [m]."""
        d = self.x[self.edges[:, 1]] - self.x[self.edges[:, 0]]
        length = np.linalg.norm(d, axis=1)
        return d / length[:, None], length - self.length

    def forces(self) -> np.ndarray:
        direction, elongation = self.springs()
        pull = (self.k * elongation)[:, None] * direction
        f = self.mass[:, None] * self.gravity
        np.add.at(f, self.edges[:, 0], pull)
        np.add.at(f, self.edges[:, 1], -pull)
        return f

    def energy(self) -> float:
        _, elongation = self.springs()
        return 0.5 * np.sum(self.k * elongation**2) - np.sum(self.mass * (self.x @ self.gravity))

    def damping(self) -> np.ndarray:
        return np.zeros_like(self.x)

    def advance(self, dt: float, steps: int) -> None:
        for k in range(steps):
            self.progress(k / steps)
            self.v = self.v + dt * self.forces() / self.mass[:, None]
            self.v[self.held] = 0
            self.x = self.x + dt * self.v


if __name__ == "__main__":
    serve(ToySolver())
