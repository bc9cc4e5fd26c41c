#!/usr/bin/python3
"""Tests of the adapters of Newton and MuJoCo 4, and of what their pages record:
`scripts/engines newton mujoco` installs them."""
from __future__ import annotations

import json
import os
import subprocess
import unittest
from pathlib import Path

from script_module import script
from test_engines import ADAPTERS, ROOT, judge, require_engine, run

LAWS = ("smoke", "held", "momentum", "symmetry.mirror",
        "calibration.young-s-modulus-is-the-scene-s",
        "contact.slides-as-coulomb-says", "contact.sheet-rests-on-a-plane")
SAME_BITS = """
import sys
import numpy as np
import newton_cloth
import newton_mapping as mapping
ends = []
for words in ([], ["--no-graph"]):
    options = newton_cloth.read_options([sys.argv[1], *words])
    solver = newton_cloth.NewtonCloth(options)
    scene = mapping.kite({"young": 100.0, "bending_rigidity": 0.01}, np.zeros((4, 3)))
    plane = {"point": [0, 0, -0.01], "normal": [0, 0, 1], "friction": 0.5}
    scene.header["scene"].update(gravity=[0.0, 0.0, -10.0], planes=[plane])
    solver.prepare(scene)
    solver.advance(1e-3, 60)
    solver.advance(2e-3, 10)
    ends.append(np.concatenate([solver.x, solver.v]))
assert (ends[0] == ends[1]).all() and abs(ends[0][0, 2]) > 1e-3, ends
"""
WRONG_WEIGHTS = """
import newton_cloth
import newton_mapping
right = newton_mapping.kite
def wrong(material, x):
    scene = right(material, x)
    scene.arrays["hinge_weights"] = 1.1 * scene.hinge_weights
    return scene
newton_mapping.kite = wrong
newton_cloth.main()
"""


class PythonEngine:
    """An engine in a virtual environment."""

    name, version, settings, snippets = "", "", (), ()

    @classmethod
    def setUpClass(cls) -> None:
        require_engine(cls.name)

    def python(self, *words: str | Path) -> subprocess.CompletedProcess[str]:
        folder = ROOT / "build/engines" / self.name
        paths = os.pathsep.join(map(str, (ADAPTERS, ADAPTERS / self.name)))
        environment = os.environ | {"WARP_CACHE_PATH": str(folder / "kernels"), "PYTHONPATH": paths}
        return subprocess.run([folder / "bin/python", *words], cwd=ROOT / "build/engines",
                              env=environment, capture_output=True, text=True, check=False)

    def command(self, settings: str) -> str:
        return (f"exec build/engines/{self.name}/bin/python "
                f"verification/subjects/adapters/{self.name}/{self.name}_cloth.py {settings}")

    def test_the_adapter_keeps_to_the_protocol(self) -> None:
        for settings in self.settings:
            done = run("build/foldproof", "subject", "--check", self.command(settings))
            self.assertEqual(done.returncode, 0, done.stdout)
            self.assertIn(f" {self.version}: ", done.stdout)

    def test_laws_end_as_the_page_records(self) -> None:
        for settings in self.settings:
            file = ROOT / f"reports/standing/{self.name}-{self.version}-{settings}.json"
            recorded = json.loads(file.read_text())["laws"]
            found = judge(self.command(settings), *LAWS, "--seconds", "300")
            asked = recorded.keys() & found.keys()  # laws may be newer than the record
            self.assertGreater(len(asked), 8)
            for law in asked:
                self.assertEqual(found[law], recorded[law][0], (settings, law))

    def test_snippets_bend_and_stretch_as_the_page_records(self) -> None:
        back = script("run_back")
        twill = next(row for row in back.fabrics() if row["name"] == "cotton-twill")
        for engine in self.snippets:
            kept = json.loads(back.DATA.read_text())[engine]["cotton-twill"]
            found = back.run_cell(engine, twill)
            self.assertLess(abs(found["rigidity"] - 1), back.TOLERANCE)
            for quantity in ("rigidity", "young"):
                self.assertAlmostEqual(found[quantity], kept[quantity], delta=0.003, msg=engine)

    def lines(self, name: str) -> dict[str, tuple[float, float]]:
        """What a reproduction prints: measured, and right."""
        done = self.python(ADAPTERS / self.name / "reproductions" / f"{name}.py")
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = (line.rsplit(": ", 1) for line in done.stdout.splitlines() if ": " in line)
        pairs = {what: tuple(map(float, numbers.split())) for what, numbers in rows
                 if numbers.count(".") == 2}
        self.assertGreater(len(pairs), 2)
        return pairs


class Newton(PythonEngine, unittest.TestCase):
    name, version, settings = "newton", "1.8.0", ("xpbd", )
    snippets = ("newton-vbd", "newton-style3d")

    def test_a_graph_gives_the_same_bits(self) -> None:
        for solver in ("vbd", "xpbd", "semi_implicit", "style3d"):
            done = self.python("-c", SAME_BITS, solver)
            self.assertEqual(done.returncode, 0, solver + done.stderr)

    def test_other_constants_than_assumed_are_refused(self) -> None:
        done = self.python("-c", WRONG_WEIGHTS, "xpbd", "--measure")
        self.assertIn("hinge [N]: measured", done.stderr)
        self.assertNotEqual(done.returncode, 0)

    def test_hinges_of_unequal_triangles_exert_a_torque(self) -> None:
        found = self.lines("hinges")
        for solver, torque in (("SemiImplicit", 0.5769), ("XPBD", 0.5769), ("VBD", 0.0)):
            self.assertAlmostEqual(found[solver][0], torque, delta=1e-3)

    def test_style3d_scales_velocities_in_each_step(self) -> None:
        found = self.lines("style3d")
        speeds = [measured for what, (measured, _) in found.items() if what.startswith("speed")]
        for speed, steps in zip(speeds, (20, 200), strict=True):
            self.assertAlmostEqual(speed, 0.998**steps, delta=1e-3)


class MuJoCo(PythonEngine, unittest.TestCase):
    name, version, settings = "mujoco", "4.0.0", ("flex", "tendons")
    snippets = ("mujoco", )

    def test_a_flex_is_a_plate_that_is_flat_at_rest(self) -> None:
        for what, (measured, right) in self.lines("flex").items():
            if "curved" in what:
                self.assertAlmostEqual(measured, 0.0577, delta=1e-4)
            else:
                self.assertAlmostEqual(measured, right, delta=1e-4, msg=what)


class Tables(unittest.TestCase):
    def test_pages_are_as_their_data(self) -> None:
        for words in ("scripts/run_back", "scripts/price"):
            done = run(words, "--check")
            self.assertEqual(done.returncode, 0, words + done.stderr)


if __name__ == "__main__":
    unittest.main()
