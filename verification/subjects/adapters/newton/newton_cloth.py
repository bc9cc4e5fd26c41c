"""Adapter of Newton's four cloth solvers; `scripts/engines newton` installs them.

build/engines/newton/bin/python verification/subjects/adapters/newton/newton_cloth.py vbd
"""
from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

import numpy as np
import warp as wp

wp.config.quiet = True
wp.config.kernel_cache_dir = str(Path(sys.prefix) / "kernels")
import newton  # noqa: E402  (the cache's folder must be known first)

sys.path[:0] = [str(Path(__file__).resolve().parents[1])]
import newton_mapping  # noqa: E402
from foldproof_solver import Declined, Scene, Solver, serve  # noqa: E402

STRETCH = {"vbd": ("springs", "triangles"), "xpbd": ("springs", ),
           "semi_implicit": ("springs", "triangles"), "style3d": ("triangles", )}
CAPTURED_STEPS_KEPT = 8  # step lengths whose graphs are kept


class NewtonCloth(Solver):
    level, precision = "L1", "f4"

    def __init__(self, options: argparse.Namespace) -> None:
        self.options = options
        self.name = f"Newton {options.solver}"
        self.version = newton.__version__
        self.scheme = {"vbd": "backward Euler, block descent", "xpbd": "position based",
                       "semi_implicit": "symplectic Euler",
                       "style3d": "backward Euler, projective dynamics"}[options.solver]
        # iterations that stop before they converge have no order to claim
        self.order = 1 if options.solver == "semi_implicit" else 0
        self.capabilities = self.offered()
        self.tunables = {name: {"kind": name, "range": [1, 100000],
                                "value": getattr(options, name), "proportional": True}
                         for name in ("substeps", "iterations") if getattr(options, name)}
        if options.solver == "semi_implicit":
            self.level = "L2"

    def offered(self) -> tuple[str, ...]:
        names = ["set_state", "held", "planes", "boxes", "spheres", "capsules"]
        if self.options.mapping == "fair":
            names += ["masses"] + ["damping"] * (self.options.stretch == "springs")
            names += ["self_collision"] * (self.options.solver in ("vbd", "style3d"))
        return tuple(names)

    def prepare(self, scene: Scene) -> dict[str, str]:
        for name in self.tunables:
            setattr(self.options, name, int(self.tuned(scene, name)))
        newton_mapping.require_mapped(scene, self.options)
        self.model, mapping = newton_mapping.build(scene, self.options)
        self.mass, self.held = scene.mass, scene.held
        self.gravity = np.array(scene.header["scene"]["gravity"])
        self.thickness = scene.header["scene"].get("thickness", 0.0)
        self.states = self.model.state(), self.model.state()
        self.collides = self.model.shape_count > 0
        self.pipeline = self.contacts = None
        if self.collides or self.options.solver == "style3d":
            self.pipeline = newton.CollisionPipeline(
                self.model, broad_phase="nxn", soft_contact_gap=self.options.gap)
            self.contacts = self.pipeline.contacts()
        self.graphs: dict[float, Any] = {}
        self.solver = self.made_solver()
        self.set_state(scene.x, scene.v, 0.0)
        return mapping

    def made_solver(self) -> Any:
        options, model = self.options, self.model
        if options.solver == "semi_implicit":
            return newton.solvers.SolverSemiImplicit(model, enable_tri_contact=False)
        if options.solver == "xpbd":
            return newton.solvers.SolverXPBD(model, iterations=options.iterations)
        if options.solver == "vbd":
            return newton.solvers.SolverVBD(
                model, iterations=options.iterations, friction_epsilon=options.friction_epsilon,
                particle_enable_self_contact=self.thickness > 0,
                particle_self_contact_margin=self.thickness or 0.2,
                particle_self_contact_gap=0.5 * self.thickness)
        style3d = newton.solvers.SolverStyle3D
        solver = style3d(model, config=style3d.Config(
            iterations=options.iterations, linear_iterations=options.linear_iterations))
        if self.thickness > 0:
            solver.collision.radius = self.thickness / 2
        elif self.collides:
            solver.collision.stiff_vf = solver.collision.stiff_ee = solver.collision.stiff_ef = 0.0
        else:
            solver.collision = None
        if solver.collision:
            solver.collision.friction_epsilon = options.friction_epsilon
        return solver

    def set_state(self, x: np.ndarray, v: np.ndarray, time: float) -> None:
        self.x, self.v = x.astype(np.float32), v.astype(np.float32)
        self.v[self.held] = 0
        for state in self.states:
            state.particle_q.assign(self.x)
            state.particle_qd.assign(self.v)

    def substep(self, dt: float) -> None:
        """One step of the engine from states[0] to states[0]."""
        now, after = self.states
        now.clear_forces()
        if self.collides:
            self.pipeline.collide(now, self.contacts)
        self.solver.step(now, after, None, self.contacts, dt)
        wp.copy(now.particle_q, after.particle_q)
        wp.copy(now.particle_qd, after.particle_qd)

    def captured(self, dt: float) -> Any:
        """The launches of a step of dt as a graph: a tenth of the calls' own time."""
        if dt not in self.graphs:
            if len(self.graphs) == CAPTURED_STEPS_KEPT:
                self.graphs.pop(next(iter(self.graphs)))
            kept = self.x, self.v
            newton_mapping.set_contact_stiffness(self.model, self.options, dt)
            self.substep(dt)  # loads the kernels
            self.set_state(*kept, 0.0)
            with wp.ScopedCapture(device=self.model.device) as capture:
                for _ in range(self.options.substeps):
                    self.substep(dt / self.options.substeps)
            self.graphs[dt] = capture.graph
            self.set_state(*kept, 0.0)
        return self.graphs[dt]

    def advance(self, dt: float, steps: int) -> None:
        newton_mapping.set_contact_stiffness(self.model, self.options, dt)
        graph = self.captured(dt) if self.options.graph else None
        for k in range(steps):
            self.progress(k / steps)
            if graph:
                wp.capture_launch(graph)
                continue
            for _ in range(self.options.substeps):
                self.substep(dt / self.options.substeps)
        self.x, self.v = (a.numpy().copy() for a in (self.states[0].particle_q,
                                                     self.states[0].particle_qd))
        if not np.isfinite(self.x).all():
            raise FloatingPointError("positions that are not finite")

    def gained(self, v: np.ndarray) -> np.ndarray:
        """Forces on the state with these velocities: m times what a step of symplectic Euler adds
        to v, over dt."""
        kept, dt = (self.x, self.v), 1e-3
        self.set_state(self.x, v, 0.0)
        self.substep(dt)
        f = self.mass[:, None] * (self.states[0].particle_qd.numpy() - v.astype(np.float32)) / dt
        self.set_state(*kept, 0.0)
        return f

    def forces(self) -> np.ndarray:
        return self.gained(np.zeros_like(self.x))

    def damping(self) -> np.ndarray:
        return self.gained(self.v) - self.forces()

    def energy(self) -> float:
        raise Declined("the energy: Newton computes none of cloth")


def read_options(words: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description="Adapter of Newton's cloth solvers.")
    parser.add_argument("solver", choices=list(STRETCH))
    parser.add_argument("--stretch", choices=("springs", "triangles"))
    parser.add_argument("--mapping", choices=("fair", "defaults"), default="fair",
                        help="defaults: parameters as in the engine's own helper functions")
    parser.add_argument("--snippet", help="a file of `foldproof material` that builds the cloth")
    parser.add_argument("--iterations", type=int)
    parser.add_argument("--linear-iterations", type=int, default=20, help="of Style3D")
    parser.add_argument("--substeps", type=int)
    parser.add_argument("--friction-epsilon", type=float, default=1e-2,
                        help="slip speed below which friction is regularised [m/s]; VBD, Style3D")
    parser.add_argument("--contact", type=float,
                        help="stiffness of contacts over least mass/substep^2 [1]")
    parser.add_argument("--gap", type=float, default=0.1, help="distance of detection [m]")
    parser.add_argument("--poisson", type=float, default=1 / 3, help="of triangles; Style3D: 0")
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--no-graph", dest="graph", action="store_false")
    parser.add_argument("--measure", action="store_true",
                        help="print the constants, compile what else is needed, and end")
    options = parser.parse_args(words)
    usual = newton_mapping.USUAL[options.solver]
    for name, value in usual.items():
        if getattr(options, name) is None:
            setattr(options, name, value)
    options.stretch = options.stretch or (
        STRETCH[options.solver][-1 if options.mapping == "defaults" else 0])
    if options.stretch not in STRETCH[options.solver]:
        parser.error(f"{options.solver} has no {options.stretch}")
    return options


def main() -> None:
    options = read_options(sys.argv[1:])
    with wp.ScopedDevice(options.device):
        if options.mapping == "fair":
            for line in newton_mapping.require_constants(NewtonCloth, options):
                if options.measure:
                    print(line)
        if options.measure:
            newton_mapping.meet_obstacles(NewtonCloth, options)
        if not options.measure:
            serve(NewtonCloth(options))


if __name__ == "__main__":
    main()
