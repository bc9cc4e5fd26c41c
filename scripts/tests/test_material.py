#!/usr/bin/python3
"""Tests of `foldproof material`: its numbers against others, and back again."""
from __future__ import annotations

import ast
import json
import re
import subprocess
import tempfile
import tomllib
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FABRICS = {row["name"]: row
           for row in tomllib.loads((ROOT / "cases/fabrics.toml").read_text())["fabric"]}
TWILL = FABRICS["cotton-twill"]
B, RHO, G = TWILL["rigidity"]["first"], TWILL["density"], TWILL["shear"]
ENGINES = ("newton-vbd", "newton-style3d", "mujoco", "jolt", "blender", "ppf")
# ppf-contact-solver's presets, and the bending lengths that its formula gives them
PRESETS = {"Silk": (1.42, 500, 12.3), "Leather": (1.8, 13000, 13.3), "Denim": (10, 10000, 23.5)}
ARCSIM = {"density": 0.324,
          "stretching": [[205.352005, 10.234077, 1013.88629, 53.387184]] * 6,
          "bending": [[64.196457e-6] * 5, [73.384567e-6] * 5, [96.951576e-6] * 5]}


def material(*words: str | Path, code: int = 0) -> str:
    done = subprocess.run([ROOT / "build/foldproof", "material", *words], capture_output=True,
                          text=True, check=False)
    if done.returncode != code:
        raise AssertionError(f"{words}: {done.returncode}: {done.stderr}")
    return done.stdout if code == 0 else done.stderr


def number(text: str, name: str) -> float:
    """The first number after the name: of code, its coefficient."""
    return float(re.search(rf'\b{name}["\']?[=:, ]+["\']?([-+.\de]+)', text)[1])


class Formulas(unittest.TestCase):
    """Twill's numbers, from each engine's energy as its source states it."""

    def test_numbers_store_the_energy_of_the_fabric(self) -> None:
        edge, size = 0.013, 7e-5  # of a hinge [m], of a triangle [m^2]
        weight = edge**2 / (4 * size)  # it stores B weight angle^2
        for engine, pairs in {
                # half ke length angle^2; Lame's constants of plane stress
                "newton-vbd": lambda n: [(n("edge_ke") * edge / size * edge / 2, B * weight),
                                         (n("tri_ke"), G), (n("tri_ka"), G), (n("density"), RHO)],
                # 3 ke edge^2/(4 A) angle^2; Baraff and Witkin's
                "newton-style3d": lambda n: [(3 * n("default_edge_ke"), B), (n("shear"), G),
                                             (n("warp"), 8 / 3 * G), (n("density"), RHO)],
                # a plate
                "mujoco": lambda n: [
                    (n("young") * n("thickness")**3 / (12 * (1 - n("poisson")**2)), B),
                    (n("young") * n("thickness") / (2 * (1 + n("poisson"))), G), (n("mass"), RHO)],
                # angle^2 over twice the compliance; a spring of Y (A1 + A2)/L^2
                "jolt": lambda n: [(1 / (2 * n("hinge_compliance") * size / edge**2), B * weight),
                                   (n("edge_compliance"), 1 / (8 / 3 * G))],
                # pushes a far corner with a third of 100 stiffness, edge and angle
                "blender": lambda n: [
                    (100 / 3 * n("bending_stiffness") * edge**2 / size**2 * edge,
                     2 * B * weight / (2 * size / edge))],
                "ppf": lambda n: [
                    (1.28e-5 * n("bend") * n("density"), B),
                    (RHO * n("young-mod") * n("poiss-rat") / (
                        (1 + n("poiss-rat")) * (1 - 2 * n("poiss-rat"))), G),
                    (RHO * n("young-mod") / (2 * (1 + n("poiss-rat"))), 8 / 3 * G)],
        }.items():
            text = material("cotton-twill", "--engine", engine)
            for found, right in pairs(lambda name, text=text: number(text, name)):
                self.assertAlmostEqual(found / right, 1, delta=1e-5, msg=engine)

    def test_one_number_for_a_mesh_is_the_hinges_own_where_all_are_alike(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "sheet.obj"
            file.write_text(equilateral(24, 0.01))
            text = material("cotton-twill", "--engine", "newton-vbd", "--mesh", file)
        one = float(re.search(r"one edge_ke for all hinges of \S+: (\S+) N", text)[1])
        self.assertAlmostEqual(one / (2 * B / 3**0.5 / 0.01), 1, delta=1e-5)


def equilateral(rows: int, side: float) -> str:
    lines = [f"v {side * (i + j / 2)} {side * j * 0.75**0.5} 0"
             for j in range(rows + 1) for i in range(rows + 1)]
    for j in range(rows):
        for i in range(rows):
            a, b = j * (rows + 1) + i + 1, (j + 1) * (rows + 1) + i + 1
            lines += [f"f {a} {a + 1} {b}", f"f {a + 1} {b + 1} {b}"]
    return "\n".join(lines) + "\n"


class Snippets(unittest.TestCase):
    def test_every_fabric_can_be_pasted(self) -> None:
        for fabric in FABRICS:
            for engine in ENGINES:
                text = material(fabric, "--engine", engine)
                self.assertNotRegex(text, r"\{[a-z_-]+\}")
                self.assertIn("cannot represent: ", text)
                if engine in ("newton-vbd", "newton-style3d", "blender", "ppf"):
                    ast.parse(text)
                elif engine == "mujoco":
                    ElementTree.fromstring("<all>" + text + "</all>")

    def test_what_no_source_measured_is_marked(self) -> None:
        self.assertIn("tri_ke=50,  # N/m, # assumed", material("denim", "--engine", "newton-vbd"))
        self.assertIn("tri_ke=126,  # N/m, from the measured shear",
                      material("cotton-twill", "--engine", "newton-vbd"))

    def test_a_pair_is_the_user_s(self) -> None:
        self.assertIn("iterations=20", material("wool", "--engine", "newton-vbd"))
        text = material("wool", "--engine", "newton-vbd", "--pair", "4,8")
        self.assertRegex(text, r"# 4 a frame as typed\n.*iterations=8")

    def test_wrong_words_are_refused(self) -> None:
        self.assertIn("unknown engine 'mujocco'; known: newton-vbd",
                      material("wool", "--engine", "mujocco", code=2))
        self.assertIn("--engine NAME, or --from", material("wool", code=2))
        self.assertIn("leave out --pair",
                      material("wool", "--engine", "mujoco", "--pair", "4,8", code=2))
        self.assertIn("no rigidity follows from its numbers of newton-vbd: density = 0.2",
                      self.read("newton-vbd", "x.add(density=0.2, edge_ke=1)", code=2))

    def read(self, engine: str, text: str, *more: str, code: int = 0) -> str:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "file"
            file.write_text(text)
            return material("mine", "--from", engine, file, *more, code=code)

    def fabric(self, engine: str, text: str, *more: str) -> dict[str, object]:
        """As `foldproof fabric` takes it."""
        printed = self.read(engine, text, *more)
        with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
            file.write(printed)
            file.flush()
            done = subprocess.run(
                [ROOT / "build/foldproof", "fabric", "mine", "--json", "--fabrics", file.name],
                capture_output=True, text=True, check=True)
        return json.loads(done.stdout)[0]

    def test_snippets_are_read_back(self) -> None:
        for engine in ("newton-vbd", "newton-style3d", "mujoco", "ppf"):
            found = self.fabric(engine, material("cotton-twill", "--engine", engine))
            for name, right in (("density", RHO), ("shear", G)):
                self.assertAlmostEqual(found[name] / right, 1, delta=1e-4, msg=engine + name)
            self.assertAlmostEqual(found["rigidity"][0] / B, 1, delta=1e-4, msg=engine)

    def test_a_number_that_depends_on_the_mesh_needs_it(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            mesh = Path(folder) / "sheet.obj"
            mesh.write_text(equilateral(10, 0.01))
            found = self.fabric("newton-vbd", "add(density=0.2, tri_ke=40, edge_ke=1e-3)", "--mesh",
                                str(mesh))
        self.assertAlmostEqual(found["rigidity"][0] / (1e-3 * 0.01 * 3**0.5 / 2), 1, delta=1e-3)

    def test_ppf_s_presets_have_these_bending_lengths(self) -> None:
        for name, (bend, young, length) in PRESETS.items():
            found = self.fabric("ppf", f'"density": 1.0, "young-mod": {young}, "bend": {bend}')
            self.assertAlmostEqual(1e3 * (found["rigidity"][0] / 9.80665)**(1 / 3), length,
                                   delta=0.06, msg=name)

    def test_arcsim_s_denim_is_the_shipped_one(self) -> None:
        found = self.fabric("arcsim", json.dumps(ARCSIM))
        self.assertEqual(found["density"], 0.324)
        self.assertAlmostEqual(found["rigidity"][1], 96.951576e-6 / 4, delta=1e-12)
        self.assertAlmostEqual(found["shear"], 53.3872, delta=1e-3)


if __name__ == "__main__":
    unittest.main()
