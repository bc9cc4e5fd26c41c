#!/usr/bin/python3
"""Tests of commands that run a case, as a user meets them: simulate, converge, precision, project.

scripts/tests/test_simulate.py [--program FILE] [SimulateTest.test_...]
--program: instead of build/foldproof
"""

import json
import shutil
import signal
import subprocess
import time
import tomllib
import unittest
from pathlib import Path

import h5py
import numpy as np

from program_case import PROGRAM, ROOT, ProgramCase, run


class SimulateTest(ProgramCase):
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

    def test_smooth_gives_a_stored_run_a_surface_without_crossings(self) -> None:
        case = self.write("bumpy.toml", """
[cloth]
shape = "sheet"
pattern = "jittered"
width = 0.3
height = 0.3
columns = 6
rows = 6
jitter = 0.2
density = 0.2
[start]
noise = 0.01
[time]
end = 0.001
step = 0.001
""")
        self.assertEqual(self.simulate(case).returncode, 0)
        done = run(
            "smooth", str(self.path / "out/bumpy.h5"), "--levels", "2", "--out",
            str(self.path / "out"), "--json"
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        frames = json.loads(done.stdout)["frames"]
        self.assertEqual([frame["crossings"] for frame in frames], [0] * len(frames))
        self.assertEqual({frame["mean_share"] for frame in frames}, {1.0})
        with h5py.File(self.path / "out/bumpy.h5") as file:
            coarse = len(file["mesh/triangles"])
        with h5py.File(self.path / "out/bumpy_smooth.h5") as file:
            self.assertEqual(len(file["mesh/triangles"]), 16 * coarse)

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
        # the steps that win or tie are asked of a longer run, and so is half of each
        longer = {
            (method["method"], round(run["step"] / part, 9))
            for method in told["methods"]
            for run in method["longer_runs"]
            for part in (1, 2)
        }
        self.assertEqual(len(starts), len(runs) + len(longer))
        winner = told["prices"][0]["methods"][0]
        self.assertAlmostEqual(winner["longer_run_energy_gain"], 1, delta=0.1)
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
                r"fails +case\.mine\.takes-steps +\S+ > +0 +steps short of 1e\+09\n +The run takes"
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
                    "note": "reached 18 steps; measured is what is missing from 3",
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


if __name__ == "__main__":
    unittest.main()
