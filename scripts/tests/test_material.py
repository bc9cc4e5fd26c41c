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

    def close(self, found: float, right: float) -> None:
        self.assertAlmostEqual(found / right, 1, delta=1e-5)

    def test_vbd_stores_half_ke_length_angle_squared(self) -> None:
        text, length, area = material("cotton-twill", "--engine", "newton-vbd"), 0.013, 7e-5
        self.assertIn("* length / area", text)
        ke = number(text, "edge_ke") * length / area
        self.close(ke * length / 2, B * length**2 / (4 * area))  # B w angle^2
        self.close(number(text, "tri_ke"), G)
        self.close(number(text, "tri_ka"), G)  # lambda of plane stress for nu = 1/3
        self.close(number(text, "density"), RHO)

    def test_style3d_stores_three_quarters_of_ke_length_squared_over_area(self) -> None:
        text = material("cotton-twill", "--engine", "newton-style3d")
        self.close(3 * number(text, "default_edge_ke"), B)
        self.close(number(text, "shear"), G)
        self.close(number(text, "warp"), 8 / 3 * G)

    def test_mujoco_is_a_plate(self) -> None:
        root = ElementTree.fromstring(material("cotton-twill", "--engine", "mujoco").partition(
            "\n<mujoco>")[2].join(("<mujoco>", "")))
        given = {k: float(v) for k, v in root.find(".//elasticity").attrib.items()
                 if k != "elastic2d"}
        young, nu, t = (given[name] for name in ("young", "poisson", "thickness"))
        self.close(young * t**3 / (12 * (1 - nu**2)), B)
        self.close(young * t / (2 * (1 + nu)), G)
        self.close(float(root.find(".//flexcomp").attrib["mass"]), RHO)

    def test_jolt_stores_angle_squared_over_twice_the_compliance(self) -> None:
        text, length, area = material("cotton-twill", "--engine", "jolt"), 0.013, 7e-5
        compliance = number(text, "hinge_compliance") * area / length**2
        self.close(1 / (2 * compliance), B * length**2 / (4 * area))
        self.close(number(text, "edge_compliance"), 1 / (8 / 3 * G))

    def test_blender_pushes_with_a_third_of_hundred_stiffness_length_angle(self) -> None:
        text, length, area = material("cotton-twill", "--engine", "blender"), 0.013, 7e-5
        force = 100 / 3 * number(text, "bending_stiffness") * length**2 / area**2 * length
        # far corner of the hinge: the moment 2 B w angle over its height
        self.close(force, 2 * B * length**2 / (4 * area) / (2 * area / length))

    def test_ppf_scales_with_density(self) -> None:
        text = material("cotton-twill", "--engine", "ppf")
        self.close(1.28e-5 * number(text, "bend") * number(text, "density"), B)
        young, nu = number(text, "young-mod"), number(text, "poiss-rat")
        self.close(RHO * young * nu / ((1 + nu) * (1 - 2 * nu)), G)
        self.close(RHO * young / (2 * (1 + nu)), 8 / 3 * G)

    def test_one_number_for_a_mesh_is_the_hinges_own_where_all_are_alike(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "sheet.obj"
            file.write_text(equilateral(24, 0.01))
            text = material("cotton-twill", "--engine", "newton-vbd", "--mesh", file)
        one = float(re.search(r"one edge_ke for all hinges of \S+: (\S+) N", text)[1])
        self.assertAlmostEqual(one / (2 * B / 3**0.5 / 0.01), 1, delta=0.04)  # its border has none


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
