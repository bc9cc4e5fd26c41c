"""Adapter of MuJoCo 4: cloth as a flex or as tendons; `scripts/engines mujoco` installs it.

    build/engines/mujoco/bin/python THIS_FILE tendons --integrator RK4
"""
from __future__ import annotations

import argparse
import os
import re
import sys
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

sys.path[:0] = [str(Path(__file__).resolve().parents[1])]
from foldproof_solver import Declined, Scene, Solver, serve  # noqa: E402

MOST_TENDONS = 20000  # compiling the 49,000 of a sheet of 128 cells takes more than five minutes
ORDERS = {"Euler": 1, "RK4": 4, "implicit": 1, "implicitfast": 1, "discrete": 1}
AXES = "".join(f'<joint type="slide" axis="{axis}"/>' for axis in ("1 0 0", "0 1 0", "0 0 1"))


def text(numbers: Any) -> str:
    return " ".join(repr(float(n)) for n in np.ravel(numbers))


def geoms(header: dict[str, Any], options: argparse.Namespace) -> str:
    """The obstacles, whose friction and softness hold against any flex. At rest a particle is about
    g (2 dt)^2 (1 - d) deep, d the impedance: with d = 0.5 more than the g dt^2 of a free step, so
    that it does not chatter."""
    def geom(o: dict[str, Any], attributes: str) -> str:
        return (f'<geom friction="{o["friction"]} 0 0" priority="1" solref="{options.solref}" '
                f'solimp="{options.solimp}" {attributes}/>')

    rows = [geom(o, f'type="plane" pos="{text(o["point"])}" zaxis="{text(o["normal"])}" '
                 'size="0 0 1"') for o in header.get("planes", [])]
    rows += [geom(o, f'type="box" pos="{text(o["centre"])}" size="{text(o["half_extents"])}"')
             for o in header.get("boxes", [])]
    rows += [geom(o, f'type="sphere" pos="{text(o["centre"])}" size="{o["radius"]}"')
             for o in header.get("spheres", [])]
    rows += [geom(o, f'type="capsule" fromto="{text([o["a"], o["b"]])}" size="{o["radius"]}"')
             for o in header.get("capsules", [])]
    return "".join(rows)


class MuJoCoCloth(Solver):
    version, level, precision = mujoco.__version__, "L2", "f8"
    capabilities = ("set_state", "held", "masses", "damping", "planes", "boxes", "spheres",
                    "capsules")

    def __init__(self, options: argparse.Namespace) -> None:
        self.options = options
        self.name = f"MuJoCo {options.model}"
        self.tunables = {"substeps": {"kind": "substeps", "range": [1, 100000],
                                      "value": options.substeps, "proportional": True}}
        self.scheme, self.order = options.integrator, ORDERS[options.integrator]

    def elasticity(self, material: dict[str, float]) -> tuple[str, dict[str, str]]:
        """Of the flex; a plate as thick as its two stiffnesses say."""
        o, young, b = self.options, material["young"], material["bending_rigidity"]
        if o.snippet:
            text = Path(o.snippet).read_text()
            return re.search("<elasticity .*?/>", text)[0], {"all": f"elasticity of {o.snippet}"}
        kinds = ["stretch"] * (o.model == "flex") + ["bend"] * (b > 0)
        if not kinds:
            return "", {"bending": "none"}
        thickness = 1e-3
        if len(kinds) == 2:
            thickness = float(np.sqrt(12 * b * (1 - o.poisson**2) / young))
        solid = young / thickness if o.model == "flex" else (
            12 * b * (1 - o.poisson**2) / thickness**3)
        damping = material["stretch_damping"] / young if o.model == "flex" else 0.0
        words = (f"a plate {thickness:.3g} m thick, {solid:.6g} Pa, Poisson's ratio "
                 f"{o.poisson:.3f}")
        return (f'<elasticity young="{solid!r}" poisson="{o.poisson!r}" thickness="{thickness!r}" '
                f'damping="{damping!r}" elastic2d="{"both" if len(kinds) == 2 else kinds[0]}"/>'
                ), {kind: words for kind in kinds}

    def tendons(self, scene: Scene, material: dict[str, float]) -> str:
        share = material["stretch_damping"] / material["young"]
        rows = (f'<spatial stiffness="{k!r}" damping="{share * k!r}" springlength="{length!r}">'
                f'<site site="s{i}"/><site site="s{j}"/></spatial>' for (i, j), k, length in zip(
                    scene.edges.tolist(), scene.edge_stiffness.tolist(),
                    scene.rest_lengths.tolist(), strict=True))
        return f'<tendon>{"".join(rows)}</tendon>'

    def require_mapped(self, scene: Scene, material: dict[str, float]) -> None:
        if material.get("bending_damping", 0) > 0:
            raise Declined("bending damping: not mapped")
        if material["bending_rigidity"] > 0 and np.abs(scene.rest_angles).max(initial=0) > 1e-9:
            raise Declined("rest angles: not mapped")
        if self.options.model == "tendons" and len(scene.edges) > MOST_TENDONS:
            raise Declined(f"more than {MOST_TENDONS} edges: MuJoCo takes minutes to compile them")
        if self.options.model == "flex" and material["rest_length_scale"] != 1:
            raise Declined("rest lengths that no rest shape has")

    def prepare(self, scene: Scene) -> dict[str, str]:
        header = scene.header["scene"]
        material, o = header["material"], self.options
        o.substeps = int(self.tuned(scene, "substeps"))
        self.require_mapped(scene, material)
        self.moves = np.ones(len(scene.mass), bool)
        self.moves[scene.held] = False
        self.rest, self.has_bending = scene.rest, material["bending_rigidity"] > 0
        bodies = "".join(
            f'<body name="b{i}" pos="{text(p)}"><inertial pos="0 0 0" mass="{m!r}" '
            f'diaginertia="1e-9 1e-9 1e-9"/><site name="s{i}"/>{AXES if moves else ""}</body>'
            for i, (p, m, moves) in enumerate(
                zip(scene.rest, scene.mass.tolist(), self.moves, strict=True)))
        obstacles = geoms(header, o)
        meets = int(bool(obstacles))
        elasticity, mapping = self.elasticity(material)
        tendons = self.tendons(scene, material) if o.model == "tendons" else ""
        flags = "" if meets else '<flag contact="disable" constraint="disable"/>'
        self.model = mujoco.MjModel.from_xml_string(f"""<mujoco>
          <compiler boundmass="0" boundinertia="0"/>
          <option integrator="{o.integrator}" gravity="{text(header["gravity"])}" cone="elliptic">
            {flags}</option>
          <worldbody>{obstacles}{bodies}</worldbody>
          <deformable><flex name="sheet" dim="2" radius="{o.radius!r}"
            body="{" ".join(f"b{i}" for i in range(len(scene.mass)))}"
            element="{" ".join(map(str, scene.triangles.ravel()))}">{elasticity}
            <contact selfcollide="none" contype="{meets}" conaffinity="{meets}"/></flex>
          </deformable>{tendons}</mujoco>""")
        # the flex has taken its rest shape from where the bodies were; body 0 is the world
        self.model.body_pos[1 + scene.held] = scene.x[scene.held]
        self.model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY
        self.data = mujoco.MjData(self.model)
        self.set_state(scene.x, scene.v, 0.0)
        if tendons:
            mapping["stretch"] = "a tendon per edge, of its own stiffness, length and damper"
        return {**mapping, "step": o.integrator,
                "contact": f"soft: solref {o.solref}, solimp {o.solimp}; elliptic friction cones"}

    def set_state(self, x: np.ndarray, v: np.ndarray, time: float) -> None:
        self.x, self.v = x.copy(), v.copy()
        self.v[~self.moves] = 0
        mujoco.mj_resetData(self.model, self.data)
        self.data.qpos[:] = (self.x - self.rest)[self.moves].ravel()
        self.data.qvel[:] = self.v[self.moves].ravel()

    def advance(self, dt: float, steps: int) -> None:
        self.model.opt.timestep = dt / self.options.substeps
        for k in range(steps):
            self.progress(k / steps)
            mujoco.mj_step(self.model, self.data, self.options.substeps)
        self.require_no_warning()
        self.x[self.moves] = self.rest[self.moves] + self.data.qpos.reshape(-1, 3)
        self.v[self.moves] = self.data.qvel.reshape(-1, 3)

    def require_no_warning(self) -> None:
        """MuJoCo resets an unstable motion to its start, and goes on."""
        for kind, warning in enumerate(self.data.warning):
            if warning.number > 0:
                raise FloatingPointError(f"MuJoCo warns: {mujoco.mjtWarning(kind).name}")

    def spread(self, numbers: np.ndarray) -> np.ndarray:
        all_of_them = np.zeros_like(self.x)
        all_of_them[self.moves] = numbers.reshape(-1, 3)
        return all_of_them

    def forces(self) -> np.ndarray:
        mujoco.mj_forward(self.model, self.data)
        data = self.data
        return self.spread(data.qfrc_passive - data.qfrc_damper - data.qfrc_bias)

    def damping(self) -> np.ndarray:
        mujoco.mj_forward(self.model, self.data)
        return self.spread(self.data.qfrc_damper)

    def energy(self) -> float:
        if self.options.model == "flex" or self.has_bending:
            raise Declined("the energy: MuJoCo's leaves out the elastic one of flexes")
        mujoco.mj_forward(self.model, self.data)
        return float(self.data.energy[0])


def main() -> None:
    parser = argparse.ArgumentParser(description="Adapter of MuJoCo's cloth.")
    parser.add_argument("model", choices=("flex", "tendons"))
    parser.add_argument("--integrator", choices=list(ORDERS), default="Euler")
    parser.add_argument("--substeps", type=int, default=1)
    parser.add_argument("--poisson", type=float, default=1 / 3)
    parser.add_argument("--radius", type=float, default=1e-4, help="of the flex [m]")
    parser.add_argument("--solref", default="1e-4 1", help="of contacts; raised to two steps")
    parser.add_argument("--solimp", default="0.5 0.5 0.001", help="of contacts")
    parser.add_argument("--snippet", help="a file of `foldproof material`")
    options = parser.parse_args()
    if options.snippet:
        options.snippet = os.path.abspath(options.snippet)
    if "FOLDPROOF_FOLDER" in os.environ:
        os.chdir(os.environ["FOLDPROOF_FOLDER"])  # MuJoCo writes MUJOCO_LOG.TXT where it runs
    serve(MuJoCoCloth(options))


if __name__ == "__main__":
    main()
