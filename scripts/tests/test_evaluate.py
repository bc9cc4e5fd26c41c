#!/usr/bin/python3
"""Tests of commands that read meshes, runs and numbers: inspect, crossings, golden, export.

scripts/tests/test_evaluate.py [--program FILE] [EvaluateTest.test_...]
--program: instead of build/foldproof
"""

import re
import subprocess
import sys
import unittest

import numpy as np

from program_case import ROOT, ProgramCase, run

HINGE_ROW = [0.03, 0.12, 0.01, 0.05, -0.09, 0.04, 0, 0, 0, 0.11, 0.005, -0.003]  # x1 x2 x3 x4


class EvaluateTest(ProgramCase):
    def test_inspect_says_what_a_mesh_is_good_for(self) -> None:
        done = run("inspect", str(ROOT / "cases/statue.ply"))
        self.assert_holds(done)
        self.assertIn("a solid: closed, oriented, without intersections; pieces 1", done.stdout)
        told = self.told("inspect", str(ROOT / "cases/skirt.obj"), codes=(1,))
        self.assertIn("a hole", told["refusal"])

    def test_crossings_names_what_crosses_in_runs_and_meshes(self) -> None:
        flat = self.write("flat.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 4 4 0\nf 1 2 3\nf 2 4 3\n")
        crossed = self.write("crossed.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 -1\nv 1 1 2\n"
                                            "v 9 9 9\nf 1 2 3\nf 4 5 6\n")
        self.assertEqual(run("crossings", flat).returncode, 0)
        done = run("crossings", flat, crossed)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("the first: edge from particle 3 to 4, triangle 0", done.stdout)
        self.assertIn("2 frames, 1 of them with crossings", done.stdout)
        self.assert_holds(self.simulate("hinge", "--set", "time.end=0.1"))
        told = self.told("crossings", str(self.path / "out/hinge.h5"))
        self.assertEqual([row["pairs"] for row in told], [0] * 7)

    def test_evaluate_crossings_judges_a_file_of_queries(self) -> None:
        triangle = [(0, 0, 0), (4, 0, 0), (0, 4, 0)]
        hits = [(1, 1, 3), *triangle, (1, 1, -1), *triangle]
        clear = [(1, 1, 3), *triangle, (1, 1, 1), *triangle]
        rows = [f"{x},1,{y},1,{2 * z},2,{truth}" for points, truth in ((hits, 1), (clear, 0))
                for x, y, z in points]

        def evaluate(name: str, lines: list[str]) -> subprocess.CompletedProcess[str]:
            file = self.write(name, "\n".join(lines) + "\n")
            return run("evaluate", "crossings", file, "--kind", "vertex-face")

        done = evaluate("queries.csv", rows)
        self.assert_holds(done)
        self.assertIn("2 queries; meeting, by the file: 1", done.stdout)
        self.assertIn("exact judge: 0 missed, 0 told though apart", done.stdout)
        wrong = evaluate("wrong.csv", [row[:-1] + "1" for row in rows])
        self.assertEqual(wrong.returncode, 1)
        self.assert_refused(evaluate("short.csv", rows[:-1]), "a query has 8")

    def test_golden_values_are_printed_as_csv_and_json(self) -> None:
        for table in ("bending", "springs", "integrator", "forecast", "friction", "projection",
                      "sticking"):
            words = ("golden", table, "--count", "4", "--seed", "3")
            lines, told = run(*words).stdout.splitlines(), self.told(*words)
            self.assertEqual(lines[0].split(","), [column["name"] for column in told["columns"]])
            self.assertEqual([[float(x) for x in line.split(",")] for line in lines[1:]],
                             told["rows"])
        heading, *golden = run("golden", "bending", "--count", "5").stdout.splitlines()
        hinges = self.write("hinges.csv", "\n".join(",".join(line.split(",")[:27])
                                                    for line in golden))
        evaluated = run("evaluate", "bending", hinges).stdout.splitlines()[1:]
        first = heading.split(",").index("elastic_current_weighted1_x")
        for mine, line in zip(evaluated, golden, strict=True):
            wanted = [float(x) for x in line.split(",")[first:first + 24]]
            size = max(map(abs, wanted))
            for a, b in zip(map(float, mine.split(",")), wanted, strict=True):
                self.assertLess(abs(a - b), 1e-12 * size)

    def test_the_examples_of_golden_values_run_as_they_are_printed(self) -> None:
        readme = (ROOT / "verification/GOLDEN.md").read_text(encoding="utf-8")
        python = re.search(r"```python\n(import csv.*?)```", readme, re.S).group(1)
        ran = subprocess.run([sys.executable, "-c", python], cwd=ROOT, capture_output=True,
                             text=True, check=True)
        self.assertLess(float(ran.stdout.split()[-1]), 1e-12)
        cpp = re.search(r"```cpp\n(// build/foldproof golden.*?)```", readme, re.S).group(1)
        program = self.path / "a.out"
        subprocess.run(["c++", self.write("a.cpp", cpp), "-o", program], check=True)
        command = cpp.splitlines()[0].removeprefix("// ").replace("./a.out", f"'{program}'")
        ran = subprocess.run(command, shell=True, cwd=ROOT, capture_output=True, text=True,
                             check=True)
        self.assertEqual(ran.stdout, "0 of 100 rows differ\n")

    def test_evaluate_bending(self) -> None:
        row = HINGE_ROW + [0.1, -0.2, 0.3, 0.2, 0.1, -0.1, 0, 0, 0.05, 0.02, 0, 0, 2e-3, 3e-4, 0.4]
        done = run("evaluate", "bending", self.write("rows.csv", ",".join(map(str, row)) + "\n"))
        self.assert_holds(done)
        forces = np.fromstring(done.stdout.splitlines()[1], sep=",").reshape(8, 3)
        elastic, damping = forces[:4], forces[4:]
        x = np.array(HINGE_ROW).reshape(4, 3)
        for part in (elastic, damping):
            scale = np.abs(part).max()
            self.assertGreater(scale, 0)
            self.assertLess(np.abs(part.sum(axis=0)).max(), 1e-15 * scale * 8)
            self.assertLess(np.abs(np.cross(x, part).sum(axis=0)).max(), 1e-15 * scale * 8)
        self.assertLess((damping * np.array(row[12:24]).reshape(4, 3)).sum(), 0)

    def test_evaluate_names_the_bad_line(self) -> None:
        self.assert_refused(run("evaluate", "bending", self.write("rows.csv", "# head\n1,2,x\n")),
                            "rows.csv:2")
        row = [1e160 * x for x in HINGE_ROW] + 12 * [0] + [1e300, 0, 0.4]
        huge = self.write("huge.csv", ",".join(map(str, row)) + "\n")  # beyond a double
        self.assert_refused(run("evaluate", "bending", huge), "huge.csv:1")
        for number, said in (("1" + 400 * "0", "a coordinate does not fit a double"),
                             (1001 * "1", "a number has more than 1000 digits")):
            large = self.write("large.csv", "\n".join([number + ",1,0,1,0,1,0"] * 8))
            done = run("evaluate", "crossings", large, "--kind", "edge-edge")
            self.assert_refused(done, f"large.csv:1: {said}")

    def test_a_stored_run_becomes_files_and_a_page(self) -> None:
        self.assert_holds(self.simulate("hinge", "--set", "time.end=0.1"))
        stored = str(self.path / "out/hinge.h5")
        self.assert_holds(run("export", stored, "--format", "obj", "--out", str(self.path / "f")))
        self.assertGreater(len(list((self.path / "f").glob("*.obj"))), 5)
        self.assertGreater(len(self.page_of(self.out)), 10000)
        for wrong in (
            ("export", stored + "5", "--format", "ply", "--out", str(self.path)),
            ("export", stored, "--format", "stl", "--out", "x"), ("film", stored + "5"),
            ("report", self.out, str(self.path / "three"))
        ):
            self.assert_rejected(*wrong)


if __name__ == "__main__":
    unittest.main()
