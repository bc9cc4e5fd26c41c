#!/usr/bin/python3
"""Tests of the program as a user meets it: commands, exit codes, messages, files.

scripts/tests/test_program.py [--program FILE] [ProgramTest.test_...]
--program: instead of build/foldproof
"""

import json
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import tomllib
import unittest
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(sys.argv.pop(2)) if sys.argv[1:2] == ["--program"] else ROOT / "build" / "foldproof"

HINGE_ROW = [0.03, 0.12, 0.01, 0.05, -0.09, 0.04, 0, 0, 0, 0.11, 0.005, -0.003]  # x1 x2 x3 x4

SECONDS = ("solver.cached-terms-save-time",)  # checks that measure time, and so never the same


def run(*arguments: str, folder: Path | None = None) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [str(PROGRAM), *arguments], cwd=folder, capture_output=True, text=True, check=False
    )


class ProgramTest(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = tempfile.TemporaryDirectory(prefix="foldproof test ")
        self.path = Path(self.folder.name)

    def tearDown(self) -> None:
        self.folder.cleanup()

    def write(self, name: str, text: str) -> str:
        (self.path / name).write_text(text)
        return str(self.path / name)

    def simulate(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        return run("simulate", *arguments, "--out", str(self.path / "out"))

    def test_help_shows_examples(self) -> None:
        shown = run("--help")
        self.assertEqual(shown.returncode, 0)
        self.assertIn("Examples:", shown.stdout)

    def test_list_names_checks_studies_and_integrators(self) -> None:
        shown = json.loads(run("list", "--json").stdout)
        self.assertIn("bending.forces-sum-to-zero", [row["name"] for row in shown["checks"]])
        self.assertIn("time-order.hinge", [row["name"] for row in shown["studies"]])
        names = [row["name"] for row in shown["integrators"]]
        self.assertEqual(names[:3], ["A", "B", "C"])
        self.assertIn("BDF2", names)

    def test_project_brings_a_stored_run_out_of_its_objects(self) -> None:
        case = self.write("sunk.toml", """
[cloth]
shape = "sheet"
pattern = "one_diagonal"
width = 0.4
height = 0.4
columns = 12
rows = 12
density = 0.2
move = [-0.2, -0.2, 0.23]
[start]
noise = 0.01
[[object]]
shape = "sphere"
radius = 0.25
[time]
end = 0.001
step = 0.001
""")
        self.assertEqual(self.simulate(case).returncode, 0)
        stored = str(self.path / "out/sunk.h5")
        done = run(
            "project", stored, "--map", "blend", "--tau", "0.02", "--subdivide", "1", "--out",
            str(self.path / "out"), "--json"
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        told = json.loads(done.stdout)
        before, plain, blend = (row["deviation"] for row in told["wrinkles"])
        self.assertLess(plain, 1e-9)
        self.assertGreater(blend, 0.1 * before)
        with h5py.File(self.path / "out/sunk_projected.h5") as file:
            x = file["frames/positions"][-1]
            self.assertEqual(len(x), 25 * 25)
            self.assertGreaterEqual(np.linalg.norm(x, axis=1).min(), 0.25)
        assert_rejected = run(
            "project", stored, "--map", "blend", "--tau", "-1", "--out", str(self.path / "out")
        )
        self.assertEqual(assert_rejected.returncode, 2)
        self.assertIn("0 <= eps < tau", assert_rejected.stderr)

    def test_a_body_of_ones_own_is_kept_deformed_and_projected_beside_its_case(self) -> None:
        shutil.copy(ROOT / "cases/statue.obj", self.path / "body.obj")
        text = (ROOT / "cases/deforming_body.toml").read_text().replace("statue.obj", "body.obj")
        case = self.write("mine.toml", text)
        options = (
            "--set", "time.end=0.1", "--set", "object.cells=12", "--cache", str(self.path / "kept")
        )
        first, second = self.simulate(case, *options), self.simulate(case, *options)
        self.assertIn("level sets kept in", first.stderr)
        self.assertIn("level sets loaded from", second.stderr)
        with h5py.File(self.path / "out/mine.h5") as file:
            vertices = len(file["objects/0/vertices"])
            self.assertEqual(
                file["objects/0/positions"].shape, (len(file["frames/time"]), vertices, 3)
            )
        done = run(
            "project", str(self.path / "out/mine.h5"), "--map", "plain", "--tau", "0.01", "--out",
            str(self.path / "out"), folder=ROOT
        )
        self.assertEqual(done.returncode, 0, done.stderr)

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
        self.assertIn("2 queries, 1 of which meet", done.stdout)
        self.assertIn("exact judge: 0 missed, 0 told though apart", done.stdout)
        wrong = self.write("wrong.csv", "\n".join(row[:-1] + "1" for row in rows))
        self.assertEqual(run("evaluate", "crossings", wrong, "--kind", "vertex-face").returncode, 1)
        short = self.write("short.csv", "\n".join(rows[:-1]))
        assert_rejected = run("evaluate", "crossings", short, "--kind", "vertex-face")
        self.assertEqual(assert_rejected.returncode, 2)
        self.assertIn("a query has 8", assert_rejected.stderr)

    def test_simulate_writes_frames_at_their_times(self) -> None:
        done = self.simulate(str(ROOT / "cases/hinge.toml"), "--set", "time.end=0.25", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads(done.stdout)["time"], 0.25)
        with h5py.File(self.path / "out/hinge.h5") as file:
            times = file["frames/time"][:]
            self.assertEqual(len(times), 16)
            np.testing.assert_array_equal(times[:-1], np.arange(15) * (1 / 60))
            self.assertEqual(file["frames/positions"].shape, (16, 4, 3))
            self.assertEqual(file["diagnostics/time"][-1], 0.25)
            self.assertIn("gravity", list(file.attrs["built"].astype(str)))
            np.testing.assert_array_equal(file["gravity"][:], [0, -9.80665, 0])
            self.assertEqual(file["gravity"].attrs["unit"], "m/s^2")
        self.assertFalse(list((self.path / "out").glob("*.partial")))
        self.assertIn("hinge.h5:/frames/positions", (self.path / "out/hinge.xdmf").read_text())

    def test_a_misspelt_key_is_refused_with_its_place(self) -> None:
        text = (
            (ROOT / "cases/hinge.toml").read_text().replace("stiffness = 3e-3", "stifness = 3e-3")
        )
        done = self.simulate(self.write("wrong.toml", text))
        self.assertEqual(done.returncode, 2)
        line = 1 + [k for k, row in enumerate(text.splitlines()) if "stifness" in row][0]
        self.assertIn("wrong.toml:", done.stderr)
        self.assertIn("stiffness", done.stderr)
        self.assertTrue(
            f":{line}:" in done.stderr or "[bending] needs the key 'stiffness'" in done.stderr,
            done.stderr,
        )

    def test_missing_files_are_named(self) -> None:
        self.assertEqual(self.simulate("nowhere.toml").returncode, 2)
        done = self.simulate(str(ROOT / "cases/any_mesh.toml"), "--set", "cloth.mesh=none.obj")
        self.assertEqual(done.returncode, 2)
        self.assertIn("none.obj", done.stderr)

    def test_a_case_is_named_by_its_file_or_as_a_shipped_one(self) -> None:
        def simulate_case(name: str) -> subprocess.CompletedProcess[str]:
            return run("simulate", name, "--set", "time.end=0.02", "--out", "out", folder=self.path)

        for name in ("hinge", "hinge.toml", "any_mesh", "hard/sharp_fold"):
            done = simulate_case(name)
            self.assertTrue((self.path / "out" / f"{Path(name).stem}.h5").is_file(), done.stderr)
        (self.path / "mine").mkdir()  # a folder is no case
        self.write("mine.toml", (ROOT / "cases/hinge.toml").read_text())
        self.write("any_mesh.toml", (ROOT / "cases/hinge.toml").read_text())
        for name in ("mine", "any_mesh", "any_mesh.toml"):
            self.assertIn("4 particles, 2 triangles", simulate_case(name).stderr)
        done = run(
            "converge", "hinge", "--until", "0.02", "--levels", "3", "--out", "out",
            folder=self.path
        )
        self.assertIn(done.returncode, (0, 1), done.stderr)
        for name in ("nowhere", "hard/../hinge", "needs", "/hinge"):
            done = simulate_case(name)
            self.assertEqual(done.returncode, 2)
            self.assertIn(
                f"{name}: there is no such case file, and no shipped case of that name", done.stderr
            )

    def test_converge_tells_how_long_positions_are_predictable(self) -> None:
        asked = ("converge", "hinge", "--until", "0.1", "--levels", "3", "--out", "out")
        done = run(*asked, folder=self.path)
        self.assertIn("predictable to its end (t = 0.1 s)", done.stdout, done.stderr)
        told = json.loads(run(*asked, "--json", folder=self.path).stdout)["predictability"]
        self.assertIsNone(told["horizon"])
        self.assertEqual(
            [len(twin["distances"]) for twin in told["twins"]], [len(told["times"])] * 2
        )
        self.assertLess(told["twins"][0]["disturbance"], 1e-11)
        self.assertAlmostEqual(
            told["twins"][1]["distances"][0] / told["twins"][1]["disturbance"], 1, 6
        )
        strict = run(*asked, "--fraction", "1e-9", "--ensemble", "3", "--json", folder=self.path)
        told = json.loads(strict.stdout)
        self.assertLess(told["predictability"]["horizon"], 0.1)
        self.assertEqual(told["predictability"]["ensemble"], 3)
        self.assertEqual(len(told["predictability"]["statistics"][0]["levels"]), 3)
        self.assertIn("only statistics are predictable", told["quantities"][-1]["because"])
        for words in ("--fraction 1", "--fraction 0", "--ensemble -1"):
            self.assert_rejected("converge", "hinge", *words.split())

    def test_precision_names_the_cheapest_integrator_and_keeps_its_runs(self) -> None:
        ask = (
            "precision", "hinge", "--until", "0.2", "--method", "A,RK4,backward-euler", "--errors",
            "0.02", "--out", str(self.path / "out"), "--json"
        )
        first, again = run(*ask), run(*ask)
        self.assertEqual(first.returncode, 0, first.stderr)
        # the seconds too: nothing was run again
        answers = [json.loads(done.stdout) for done in (first, again)]
        for answer in answers:
            del answer["program"]["date"]  # when it was asked
        self.assertEqual(answers[0], answers[1])
        starts = [
            line
            for file in (self.path / "out/store/shards").iterdir()
            for line in file.read_text().splitlines()
            if '"start"' in line
        ]
        told = json.loads(first.stdout)
        runs = [run for method in told["methods"] for run in method["runs"]]
        self.assertEqual(len(starts), len(runs))
        self.assertEqual(
            [method["method"] for method in told["methods"]], ["A", "RK4", "backward-euler"]
        )
        (prices,) = told["prices"]
        self.assertEqual((prices["error"], prices["methods"][0]["over_cheapest"]), (0.02, 1))
        self.assertLess(told["truth"]["good_down_to"], 0.02)
        self.assertIn("hinge at 2 %: " + prices["methods"][0]["method"], told["sentences"][0])
        with h5py.File(self.path / "out/precision.h5") as file:
            curves = file["studies/precision.hinge/figures/hinge-work/curves"]
            self.assertEqual(len(curves), 3)
        report = run("report", str(self.path / "out"))
        self.assertEqual(report.returncode, 0, report.stderr)
        self.assertIn("Error against work: hinge", (self.path / "out/report.html").read_text())
        unknown = run(*ask[:-2], str(self.path / "new"), "--errors", "1e-9", "--effort", "0.01")
        self.assertEqual(unknown.returncode, 1, unknown.stderr)
        self.assertIn(
            "no price, since the truth is not known to a tenth of this error", unknown.stdout
        )
    def test_converge_refines_the_mesh(self) -> None:
        asked = (
            "converge", "hinge", "--in", "space", "--until", "0.02", "--levels", "3", "--out", "out"
        )
        done = run(*asked, folder=self.path)
        self.assertIn(
            "refined by middles of edges, since shape 'hinge' has no finer one", done.stdout,
            done.stderr
        )
        told = json.loads(run(*asked, "--json", folder=self.path).stdout)
        self.assertEqual(told["particles"], [4, 9, 25])
        self.assertEqual(told["level_overrides"], [[], ["cloth.refine=1"], ["cloth.refine=2"]])
        both = json.loads(
            run(
                *asked[:3], "both", *asked[4:], "--method", "C,BDF2", "--json", folder=self.path
            ).stdout
        )
        self.assertEqual([(ladder["in"], ladder["method"]) for ladder in both["ladders"]],
                         [("time", "C"), ("space", "C"), ("time", "BDF2"), ("space", "BDF2")])
        self.assert_rejected(*asked, "--method", "D")
        self.assert_rejected("converge", "hinge", "--in", "height")

    def test_any_obj_mesh_runs(self) -> None:
        quad = "v 0 0 0\nv 1 0 0\nv 1 1 0.1\nv 0 1 0\nv 0 2 0.2\nv 1 2 0\nf 1 2 3 4\nf 4 3 6 5\n"
        done = self.simulate(
            str(ROOT / "cases/any_mesh.toml"), "--set",
            "cloth.mesh=" + self.write("quad.obj", quad), "--set", "time.end=0.05"
        )
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_case_with_a_mesh_of_ones_own_is_not_failed_by_bounds_for_the_shipped_one(
        self,
    ) -> None:
        shutil.copy(ROOT / "cases/skirt.obj", self.path / "skirt.obj")
        text = (
            ROOT / "cases/any_mesh.toml"
        ).read_text() + '[expect.takes_steps]\nat_least = 1e9\nwhy = "a trial"\n'
        case, quad = self.write("mine.toml", text), self.write(
            "quad.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0.1\nv 0 1 0\nf 1 2 3 4\n"
        )
        short = ("--set", "time.end=0.02")
        self.assertEqual(self.simulate(case, *short).returncode, 1)
        self.assertEqual(
            self.simulate(case, *short, "--set", "bending.stiffness=0.2").returncode, 1
        )
        mine = ("--set", f"cloth.mesh={quad}", *short)
        done = self.simulate(case, *mine)
        self.assertEqual(done.returncode, 0, done.stderr)
        reason = f"written for skirt.obj; this run uses {quad}"
        self.assertRegex(done.stdout, f"not applicable +case.mine.takes-steps +{reason}\n")
        self.assertRegex(done.stdout, "holds +case.mine.never-crosses-itself ")
        told = json.loads(self.simulate(case, *mine, "--json").stdout)["findings"]
        self.assertEqual(
            [(f["outcome"], f["note"]) for f in told if f["name"] == "case.mine.takes-steps"],
            [("not applicable", reason)],
        )
        with h5py.File(self.path / "out/mine.h5") as file:
            self.assertEqual(file["findings/case.mine.takes-steps"].attrs["note"], reason)
        stated = self.simulate(case, *mine, "--set", "expect.takes_steps.at_least=1e8")
        self.assertEqual(stated.returncode, 1, stated.stdout)

    def test_a_run_that_diverges_says_when_and_where_and_keeps_its_frames(self) -> None:
        done = self.simulate(
            str(ROOT / "cases/hanging_sheet.toml"), "--set", "time.step=0.02", "--set",
            "time.frames_per_second=50"
        )
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, r"stopped: .*step \d+, after t = .* s, particle \d+")
        with h5py.File(self.path / "out/hanging_sheet.h5") as file:
            self.assertGreaterEqual(file["frames/positions"].shape[0], 1)
            self.assertTrue(np.isfinite(file["frames/positions"][:]).all())
            self.assertIn("step", file.attrs["stopped"])

    def test_a_case_says_what_must_hold(self) -> None:
        text = (
            ROOT / "cases/hinge.toml"
        ).read_text() + '[expect.takes_steps]\nat_least = 1e9\nwhy = "a trial"\n'
        case = self.write("mine.toml", text)
        done = self.simulate(case, "--set", "time.end=0.05")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertRegex(
            done.stdout,
            (
                r"fails +case\.mine\.takes-steps +\S+ <= 0 +steps short of 1e\+09\n +The run takes"
                r" as many .*\n +The bound: a trial"
            ),
        )
        with h5py.File(self.path / "out/mine.h5") as file:
            self.assertEqual(file["findings/case.mine.takes-steps"].attrs["outcome"], "fails")
        done = self.simulate(
            case, "--set", "time.end=0.05", "--set", "expect.takes_steps.at_least=3", "--json"
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(
            json.loads(done.stdout)["findings"],
            [
                {
                    "name": "case.mine.takes-steps",
                    "measured": -15.0,
                    "bound": 0.0,
                    "unit": "steps short of 3",
                    "note": "reached 18 steps; measured is what lacks of 3",
                    "outcome": "holds",
                }
            ],
        )

    def test_the_two_shells_of_the_paper_differ_in_one_number(self) -> None:
        cases = [
            tomllib.loads((ROOT / f"cases/{name}.toml").read_text())
            for name in ("water_bottle", "balloon")
        ]
        strong, weak = (case["bending"].pop("stiffness") for case in cases)
        self.assertEqual(round(strong / weak, 9), 100)
        for case in cases:
            for words in ("title", "about", "expect", "ablation"):
                case.pop(words, None)
        self.assertEqual(*cases)

    def test_expectations_of_shipped_cases_are_asked_for_by_name(self) -> None:
        done = run("check", "case.sharp_fold.folds-back-to")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"holds +case\.sharp_fold\.folds-back-to")
        self.assertIn(
            "case.sharp_fold.folds-back-to",
            json.loads(run("list", "--json").stdout)["case_findings"],
        )

    def test_claims_are_ruled_by_the_findings_that_a_run_has(self) -> None:
        out = str(self.path / "out")
        self.assertEqual(run("claims", "--out", out).returncode, 2)
        done = run(
            "check", "dynamics.solves-are-counted", "bending.mode-is-minus-gradient-of-theta",
            "--out", out
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        shown = run("claims", "--out", out)
        self.assertEqual(
            [line.split()[:2] for line in shown.stdout.splitlines()],
            [["T19", "confirmed"], ["B10", "refuted"]],
        )
        one = run("claims", "B10", "--out", out)
        self.assertRegex(
            one.stdout, r"contradicts +holds +bending\.mode-is-minus-gradient-of-theta +\S+ <= 32"
        )
        self.assertNotIn("{", one.stdout)
        self.assertEqual(
            json.loads(run("claims", "T19", "--json", "--out", out).stdout)[0]["ruling"],
            "confirmed",
        )
        self.assertIn("no claim 'T99'", run("claims", "T99", "--out", out).stderr)
        with h5py.File(self.path / "out/run.h5") as file:
            self.assertEqual(file["claims/B10"].attrs["ruling"], "refuted")
            self.assertEqual(list(file["claims/B10"].attrs["roles"].astype(str)), ["contradicts"])

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

    def test_checks_measure_the_same_on_any_number_of_threads_and_in_any_order(self) -> None:
        def measure(*how: str) -> dict[str, tuple[float, float, float]]:
            told = json.loads(run("check", *how, "--json").stdout)
            rows = [
                row
                for row in told["findings"]
                if row["kind"] == "check" and row["name"] not in SECONDS
            ]
            return {
                row["name"]: (row["measured"], row["uncertainty"], row["bound"]) for row in rows
            }

        alone = measure("--threads", "1")
        self.assertGreater(len(alone), 300)
        self.assertEqual(alone, measure("--threads", "2", "--order", "1"))

    def test_a_shift_of_seeds_gives_other_samples_and_is_recorded(self) -> None:
        told = [
            json.loads(
                run(
                    "check", "bending.forces-sum-to-zero", "--seed", seed, "--json", "--out",
                    str(self.path / "out")
                ).stdout
            )
            for seed in ("0", "7")
        ]
        self.assertEqual([one["program"]["seed"] for one in told], [0, 7])
        self.assertNotEqual(*(one["findings"][0]["measured"] for one in told))
        with h5py.File(self.path / "out/run.h5") as file:
            self.assertEqual(file.attrs["seed"], 7)

    def test_study_runs_studies_only(self) -> None:
        done = run("study", "bending.torques-sum-to-zero")
        self.assertEqual(done.returncode, 2)
        self.assertIn(
            "names checks or cases, and no study; type `foldproof check bending.torques",
            done.stderr,
        )

    def test_the_shell_completes_commands_names_options_and_files(self) -> None:
        def complete(*words: str) -> list[str]:
            lines = [
                "source scripts/completion.bash",
                f"COMP_WORDS=({' '.join(map(repr, (str(PROGRAM), *words)))})",
                f"COMP_CWORD={len(words)}", "_foldproof", 'printf "%s\\n" "${COMPREPLY[@]}"'
            ]
            return subprocess.run(
                ["bash", "-c", "\n".join(lines)], cwd=ROOT, capture_output=True, text=True,
                check=True
            ).stdout.split()

        self.assertEqual(complete("abl"), ["ablate"])
        self.assertEqual(complete("check", "bending.torq"), ["bending.torques-sum-to-zero"])
        self.assertIn("time-order", complete("study", "time"))
        self.assertEqual(complete("check", "case.tw"), ["case.twist"])
        self.assertNotIn("bending", complete("study", "bend"))
        self.assertEqual(complete("simulate", "--res"), ["--restart", "--resume"])
        self.assertEqual(complete("simulate", "cases/garm"), ["cases/garment.toml"])
        self.assertEqual(complete("simulate", "garm"), ["garment"])
        self.assertEqual(complete("ablate", "hard/tw"), ["hard/twist"])
        self.assertEqual(complete("inspect", "cas"), ["cases/"])
        self.assertEqual(complete("golden", "fri"), ["friction"])
        self.assertEqual(complete("campaign", "sta"), ["status"])

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

    def test_an_unknown_check_is_refused_with_neighbours(self) -> None:
        done = run("check", "bending.forces-sum-to-zer")
        self.assertEqual(done.returncode, 2)
        self.assertIn("bending.forces-sum-to-zero", done.stderr)
        for typed, meant in (
            ("bendnig", "bending"), ("case.twsit", "case.twist"), ("robes", "case.robe"),
            ("monotonicty", "monotonicity")
        ):
            self.assertRegex(run("check", typed).stderr, rf"did you mean {re.escape(meant)}[?, ]")

    def assert_rejected(self, *arguments: str) -> str:
        """The one line on standard error of a command that is refused and leaves nothing behind."""
        before = sorted(self.path.rglob("*"))
        done = run(*arguments, folder=self.path)
        self.assertEqual(
            (done.returncode, done.stdout, done.stderr.count("\n")), (2, "", 1), (arguments, done)
        )
        self.assertEqual(sorted(self.path.rglob("*")), before, arguments)
        return done.stderr

    def test_a_mistyped_word_is_named_with_what_may_be_meant(self) -> None:
        sheet = "and no shipped case of that name; did you mean hanging_sheet?"
        for typed, said in {
            "simualte cases/hinge.toml": "unknown command 'simualte'; did you mean simulate?",
            "frobnicate": "known: simulate, verify,",
            "evaluate bendig": "did you mean bending?",
            "evaluate": "a command is missing, one of bending, crossings",
            "": "a command is missing, one of simulate,",
            "simulate hinge.toml --resum": "unknown option '--resum'; did you mean --resume?",
            "export run.h5 --fromat obj --out f": "did you mean --format?",
            "list checks now": "unexpected word 'checks'; usage: foldproof list",
            "golden sprigns": "did you mean springs?",
            "simulate hangin_sheet": sheet,
            "ablate cases/hanging_shet.toml": sheet,
            "converge hnige": "did you mean hinge?",
            "simulate twist": "did you mean hard/twist?",
            "simulate nowhere/at_all_like.toml": "list` shows the shipped ones",
            "inspect nowhere/at_all_like.obj": "there is no such file; check the path",
        }.items():
            self.assertIn(said, self.assert_rejected(*typed.split()), typed)
        self.write("flag.csv", "1,2")
        self.assertIn(
            "did you mean flag.csv?", self.assert_rejected("evaluate", "bending", "flg.csv")
        )

    def test_wrong_input_is_refused_in_a_line_and_leaves_nothing(self) -> None:
        for name in ("empty.toml", "empty.obj", "empty.h5", "empty.csv"):
            self.write(name, "")
        self.write("notes.txt", "hello")
        self.write("hinge.toml", (ROOT / "cases/hinge.toml").read_text())
        for typed, said in {
            "simulate": "CASE is missing; usage: foldproof simulate CASE",
            "simulate empty.toml": "empty.toml: is empty; give a case file",
            "simulate empty.h5": "is a stored run by its name; give a case file",
            "simulate .": "is a folder; give a case file",
            "simulate hinge.toml --set": "--set needs a value: --set TABLE.KEY=VALUE",
            "simulate hinge.toml --set time.end=abc": (
                "--set time.end=abc: 'end' in [time] must be a finite number"
            ),
            "simulate hinge.toml --set time.edn=1": "known here: end,",
            "simulate hinge.toml --out --json": "--out: a value is missing",
            "simulate hinge.toml --out notes.txt": (
                "notes.txt: cannot make this folder: Not a directory"
            ),
            "simulate hinge.toml --out new/a/b --set bending.stiffness=x": (
                "must be a finite number"
            ),
            "simulate hinge.toml --json=3": "--json takes no value",
            "simulate hinge.toml --cache": "--cache needs a value: --cache DIR",
            "converge hinge --levels 2": "'2' is not a whole number from 3 to 12",
            "converge hinge --until -1": "'-1' is not a number above 0",
            "precision hinge --method A,D": "unknown integrator 'D'; known: A, B,",
            "precision hinge --methods A": "unknown option '--methods'; did you mean --method?",
            "precision hinge --errors 0": "'0' is not a number above 0",
            "precision hinge --effort x": "'x' is not a number above 0",
            "converge hinge --out notes.txt": "notes.txt: cannot make this folder",
            "check bending --seed x": "'x' is not a whole number from 0 to 1000000000",
            "check bending --tier fast": "'fast' is not one of quick, full",
            "check bending --out notes.txt": "notes.txt: cannot make this folder",
            "bench --out notes.txt": "notes.txt: cannot make this folder",
            "report": "DIR is missing; usage: foldproof report DIR [DIR]",
            "film empty.h5": "is empty; give a stored run",
            "film notes.txt --size axb": "'axb' is not WIDTHxHEIGHT",
            "film notes.txt --fps many": "'many' is not a whole number from 1 to 120",
            "export notes.txt --format obj --out new": "notes.txt",
            "export notes.txt --format --out new": (
                "--format: a value is missing; give one of obj, ply, xdmf"
            ),
            "inspect empty.obj": "is empty; give a mesh",
            "inspect empty.obj --cells 1": "'1' is not a whole number from 4 to 1000",
            "crossings empty.obj empty.h5": "is empty",
            "golden springs --count 1.5": "'1.5' is not a whole number",
            "evaluate bending empty.csv": "is empty; give a table of numbers",
            "evaluate crossings empty.csv --keep x": "'x' is not a finite number",
            "project empty.h5 --map blend": (
                "--tau is missing; usage: foldproof project RUN.h5 --map MAP --tau LENGTH"
            ),
            "project empty.h5 --map blend --tau nan": "'nan' is not a finite number",
        }.items():
            self.assertIn(said, self.assert_rejected(*typed.split()), typed)

    def test_a_command_shows_its_own_help(self) -> None:
        def commands_in(text: str) -> list[str]:
            return re.findall(
                r"^  ([a-z]+) ", text.partition("\nCommands:\n")[2].partition("\n\n")[0], re.M
            )

        commands = [[name] for name in commands_in(run("--help").stdout)]
        commands += [["evaluate", name] for name in commands_in(run("evaluate", "--help").stdout)]
        commands += [["campaign", name] for name in commands_in(run("campaign", "--help").stdout)]
        self.assertEqual(len(commands), 35)
        for command in commands:
            text = run(*command, "--help").stdout
            self.assertNotRegex(text, r"\b(TEXT|U?INT|FLOAT|REQUIRED)\b|\(\dx\)", command)
            self.assertLessEqual(max(map(len, text.splitlines())), 100, command)
            self.assertIn("\nExit codes:\n  0 ", text)
            examples = re.findall(r"^  foldproof (.*)", text.partition("\nExamples:\n")[2], re.M)
            self.assertIn(len(examples), (1, 2), command)
            for words in (example.split("   ")[0].split() for example in examples):
                if command != ["serve"]:  # that one is started by another command
                    self.assertEqual(words[:len(command)], command)
                for word in words:
                    self.assertTrue(not word.startswith("cases/") or (ROOT / word).is_file(), word)
                    self.assertTrue(not word.startswith("--") or f"{word} " in text, word)
        self.assertEqual(run("check", "--seed", "x", "--help").returncode, 0)

    def interrupt(self, how: int) -> subprocess.CompletedProcess[str]:
        """A run of the hinge that the signal reaches after its second frame."""
        out = self.path / "out"
        command = [
            str(PROGRAM), "simulate", "cases/hinge.toml", "--set", "time.end=3", "--out", str(out)
        ]
        running = subprocess.Popen(
            command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        while running.poll() is None and not (out / "hinge.checkpoints/000002.h5").exists():
            time.sleep(0.001)
        running.send_signal(how)
        printed, said = running.communicate()
        return subprocess.CompletedProcess(command[1:], running.returncode, printed, said)

    def test_an_interrupted_run_says_how_to_resume_it(self) -> None:
        for how in (signal.SIGINT, signal.SIGTERM):
            done = self.interrupt(how)
            self.assertEqual(done.returncode, -how, done.stderr)
            self.assertRegex(
                done.stderr,
                r"interrupted at frame \d+, t = \S+ s of 3 s; resume with: .* --resume\n$",
            )
            command = done.stderr.splitlines()[-1].split("resume with: ")[1]
            again = subprocess.run(
                command, shell=True, cwd=ROOT, capture_output=True, text=True, check=False
            )
            self.assertEqual(again.returncode, 0, again.stderr)
            self.assertIn("resumed from frame", again.stderr)
            shutil.rmtree(self.path / "out")

    def test_an_interrupted_run_is_deleted_only_on_request(self) -> None:
        command = self.interrupt(signal.SIGKILL).args
        kept = {
            path.name: path.read_bytes()
            for path in (self.path / "out/hinge.checkpoints").glob("*.h5")
        }
        for more, mentions in (((), ("interrupted at frame", "--resume`")),
                               (("--set", "time.end=2"), ("another case text", "another --out"))):
            done = run(*command, *more, folder=ROOT)
            self.assertEqual(done.returncode, 2)
            self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
            for part in (*mentions, "t = ", "--restart"):
                self.assertIn(part, done.stderr)
            for name, content in kept.items():
                self.assertEqual((self.path / "out/hinge.checkpoints" / name).read_bytes(), content)
        self.assertEqual(run(*command, "--resume", "--restart", folder=ROOT).returncode, 2)
        done = run(*command, "--restart", folder=ROOT)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("resumed", done.stderr)
        self.assertFalse((self.path / "out/hinge.checkpoints").exists())

    def test_a_run_that_is_killed_leaves_no_verdict(self) -> None:
        out = self.path / "out"
        command = [str(PROGRAM), "verify", "--no-report", "--no-bench", "--out", str(out)]
        running = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while not (out / "junit.xml").is_file() and running.poll() is None:
            time.sleep(0.05)
        running.kill()
        running.wait()
        outcomes = {
            finding["outcome"]
            for finding in json.loads((out / "verdicts.json").read_text())["findings"]
        }
        self.assertEqual(outcomes, {"did not run"})
        self.assertRegex((out / "junit.xml").read_text(), r'errors="[1-9][0-9]*"')

    def test_a_check_writes_its_results(self) -> None:
        done = run("check", "bending.forces-sum-to-zero", "--json", "--out", str(self.path / "out"))
        self.assertEqual(done.returncode, 0, done.stderr)
        finding = json.loads(done.stdout)["findings"][0]
        self.assertEqual(finding["outcome"], "holds")
        self.assertTrue(finding["faults"])
        with h5py.File(self.path / "out/run.h5") as file:
            self.assertEqual(file["findings/bending.forces-sum-to-zero"].attrs["outcome"], "holds")
        self.assertIn("testcase", (self.path / "out/junit.xml").read_text())


if __name__ == "__main__":
    if sys.argv[1:2] == ["--program"]:
        del sys.argv[1]  # its file is taken out above
    unittest.main()
