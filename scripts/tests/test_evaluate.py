#!/usr/bin/python3
"""Tests of commands that read meshes, runs and numbers: inspect, crossings, golden, export.

scripts/tests/test_evaluate.py [--program FILE] [EvaluateTest.test_...]
--program: instead of build/foldproof
"""

import json
import re
import subprocess
import sys
import unittest

import numpy as np

from program_case import ROOT, ProgramCase, run

HINGE_ROW = [0.03, 0.12, 0.01, 0.05, -0.09, 0.04, 0, 0, 0, 0.11, 0.005, -0.003]  # x1 x2 x3 x4


class EvaluateTest(ProgramCase):
    def test_inspect_says_what_a_mesh_is_good_for(self) -> None:
        done = run("inspect", str(ROOT / "cases/statue.obj"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("a solid: closed, oriented, without intersections; pieces 1", done.stdout)
        done = run("inspect", str(ROOT / "cases/skirt.obj"), "--json")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("a hole", json.loads(done.stdout)["refusal"])

    def test_crossings_names_what_crosses_in_runs_and_meshes(self) -> None:
        flat = self.write("flat.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 4 4 0\nf 1 2 3\nf 2 4 3\n")
        crossed = self.write(
            "crossed.obj",
            "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 -1\nv 1 1 2\nv 9 9 9\nf 1 2 3\nf 4 5 6\n",
        )
        self.assertEqual(run("crossings", flat).returncode, 0)
        done = run("crossings", flat, crossed)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("the first: edge from particle 3 to 4, triangle 0", done.stdout)
        self.assertIn("2 frames, 1 of them with crossings", done.stdout)
        self.assertEqual(
            self.simulate(str(ROOT / "cases/hinge.toml"), "--set", "time.end=0.1").returncode, 0
        )
        told = json.loads(run("crossings", str(self.path / "out/hinge.h5"), "--json").stdout)
        self.assertEqual([row["pairs"] for row in told], [0] * 7)
        self.assertEqual(run("crossings", self.write("none.h5", "")).returncode, 2)

    def test_evaluate_crossings_judges_a_file_of_queries(self) -> None:
        triangle = [(0, 0, 0), (4, 0, 0), (0, 4, 0)]
        hits = [(1, 1, 3), *triangle, (1, 1, -1), *triangle]
        clear = [(1, 1, 3), *triangle, (1, 1, 1), *triangle]
        rows = [
            f"{x},1,{y},1,{2 * z},2,{truth}"
            for points, truth in ((hits, 1), (clear, 0))
            for x, y, z in points
        ]
        file = self.write("queries.csv", "\n".join(rows) + "\n")
        done = run("evaluate", "crossings", file, "--kind", "vertex-face")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("2 queries; meeting, by the file: 1", done.stdout)
        self.assertIn("exact judge: 0 missed, 0 told though apart", done.stdout)
        wrong = self.write("wrong.csv", "\n".join(row[:-1] + "1" for row in rows))
        self.assertEqual(run("evaluate", "crossings", wrong, "--kind", "vertex-face").returncode, 1)
        short = self.write("short.csv", "\n".join(rows[:-1]))
        assert_rejected = run("evaluate", "crossings", short, "--kind", "vertex-face")
        self.assertEqual(assert_rejected.returncode, 2)
        self.assertIn("a query has 8", assert_rejected.stderr)

    def test_golden_values_are_printed_as_csv_and_json(self) -> None:
        for table in (
            "bending", "springs", "integrator", "forecast", "friction", "projection", "sticking"
        ):
            lines = run("golden", table, "--count", "4", "--seed", "3").stdout.splitlines()
            told = json.loads(run("golden", table, "--count", "4", "--seed", "3", "--json").stdout)
            self.assertEqual(lines[0].split(","), [column["name"] for column in told["columns"]])
            self.assertEqual(
                [[float(x) for x in line.split(",")] for line in lines[1:]], told["rows"]
            )
        self.assertEqual(run("golden", "bend").returncode, 2)
        forces = run("golden", "bending", "--count", "5").stdout.splitlines()
        hinges = self.write(
            "hinges.csv", "\n".join(",".join(line.split(",")[:27]) for line in forces[1:])
        )
        evaluated = run("evaluate", "bending", hinges).stdout.splitlines()[1:]
        names = forces[0].split(",")
        first = names.index("elastic_current_weighted1_x")
        for mine, golden in zip(evaluated, forces[1:], strict=True):
            wanted = [float(x) for x in golden.split(",")[first : first + 24]]
            size = max(map(abs, wanted))
            for a, b in zip(map(float, mine.split(",")), wanted, strict=True):
                self.assertLess(abs(a - b), 1e-12 * size)

    def test_the_examples_of_golden_values_run_as_they_are_printed(self) -> None:
        readme = (ROOT / "verification/GOLDEN.md").read_text(encoding="utf-8")
        python = re.search(r"```python\n(import csv.*?)```", readme, re.S).group(1)
        ran = subprocess.run(
            [sys.executable, "-c", python], cwd=ROOT, capture_output=True, text=True, check=True
        )
        self.assertLess(float(ran.stdout.split()[-1]), 1e-12)
        cpp = re.search(r"```cpp\n(// build/foldproof golden.*?)```", readme, re.S).group(1)
        subprocess.run(
            ["c++", self.write("a.cpp", cpp), "-o", str(self.path / "a.out")], check=True
        )
        command = cpp.splitlines()[0].removeprefix("// ").replace("./a.out", f"'{self.path}/a.out'")
        ran = subprocess.run(
            command, shell=True, cwd=ROOT, capture_output=True, text=True, check=True
        )
        self.assertEqual(ran.stdout, "0 of 100 rows differ\n")

    def test_evaluate_bending(self) -> None:
        row = (
            HINGE_ROW + [0.1, -0.2, 0.3, 0.2, 0.1, -0.1, 0, 0, 0.05, 0.02, 0, 0] + [2e-3, 3e-4, 0.4]
        )
        done = run("evaluate", "bending", self.write("rows.csv", ",".join(map(str, row)) + "\n"))
        self.assertEqual(done.returncode, 0, done.stderr)
        forces = np.array(
            [float(value) for value in done.stdout.splitlines()[1].split(",")]
        ).reshape(8, 3)
        elastic, damping = forces[:4], forces[4:]
        x = np.array(HINGE_ROW).reshape(4, 3)
        for part in (elastic, damping):
            scale = np.abs(part).max()
            self.assertGreater(scale, 0)
            self.assertLess(np.abs(part.sum(axis=0)).max(), 1e-15 * scale * 8)
            self.assertLess(np.abs(np.cross(x, part).sum(axis=0)).max(), 1e-15 * scale * 8)
        self.assertLess((damping * np.array(row[12:24]).reshape(4, 3)).sum(), 0)

    def test_evaluate_names_the_bad_line(self) -> None:
        done = run("evaluate", "bending", self.write("rows.csv", "# heading\n1,2,x\n"))
        self.assertEqual(done.returncode, 2)
        self.assertIn("rows.csv:2", done.stderr)

    def test_evaluate_refuses_what_no_double_holds(self) -> None:
        row = [1e160 * x for x in HINGE_ROW] + 12 * [0] + [1e300, 0, 0.4]
        done = run("evaluate", "bending", self.write("huge.csv", ",".join(map(str, row)) + "\n"))
        self.assertEqual(done.returncode, 2, done.stdout)
        self.assertIn("huge.csv:1", done.stderr)
        large = "\n".join(["1" + 400 * "0" + ",1,0,1,0,1,0"] * 8)
        done = run("evaluate", "crossings", self.write("large.csv", large), "--kind", "edge-edge")
        self.assertEqual(done.returncode, 2, done.stdout)
        self.assertIn("large.csv:1: a coordinate does not fit a double", done.stderr)
        long = large.replace("1" + 400 * "0", 1001 * "1")
        done = run("evaluate", "crossings", self.write("long.csv", long), "--kind", "edge-edge")
        self.assertIn("long.csv:1: a number has more than 1000 digits", done.stderr)

    def test_a_stored_run_becomes_files_pages_and_a_comparison(self) -> None:
        for folder, stiffness in (("one", "1e-4"), ("two", "2e-4")):
            run(
                "simulate", str(ROOT / "cases" / "hinge.toml"), "--set", "time.end=0.1", "--set",
                f"bending.stiffness={stiffness}", "--out", str(self.path / folder)
            )
        stored = str(self.path / "one" / "hinge.h5")
        done = run("export", stored, "--format", "obj", "--out", str(self.path / "frames"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreater(len(list((self.path / "frames").glob("*.obj"))), 5)
        self.assertEqual(run("report", str(self.path / "one")).returncode, 0)
        self.assertGreater((self.path / "one" / "report.html").stat().st_size, 10000)
        for wrong in (
            ("export", stored + "5", "--format", "ply", "--out", str(self.path)),
            ("film", stored + "5"), ("report", str(self.path / "one"), str(self.path / "three"))
        ):
            done = run(*wrong)
            self.assertEqual(done.returncode, 2, wrong)
            self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertEqual(run("export", stored, "--format", "stl", "--out", "x").returncode, 2)


if __name__ == "__main__":
    unittest.main()
