#!/usr/bin/python3
"""Tests of commands that run a case, as a user meets them: simulate, converge, precision, project.

scripts/tests/test_simulate.py [--program FILE] [SimulateTest.test_...]
--program: instead of build/foldproof
"""

import shlex
import shutil
import signal
import subprocess
import tomllib
import unittest
from pathlib import Path

import h5py
import numpy as np

from program_case import ROOT, ProgramCase, run, run_until

TAKES_STEPS = '[expect.takes_steps]\nat_least = 1e9\nwhy = "a trial"\n'
FLAT = """
[cloth]
shape = "sheet"
pattern = "{pattern}"
jitter = 0.2
width = {width}
height = {width}
columns = {columns}
rows = {columns}
density = 0.2
[start]
noise = 0.01
[time]
end = 0.001
step = 0.001
"""


class SimulateTest(ProgramCase):
    def test_project_brings_a_stored_run_out_of_its_objects(self) -> None:
        text = FLAT.format(pattern="one_diagonal", width=0.4, columns=12)
        case = self.write("sunk.toml", text.replace("jitter = 0.2", "move = [-0.2, -0.2, 0.23]")
                          + '[[object]]\nshape = "sphere"\nradius = 0.25\n')
        self.assert_holds(self.simulate(case))
        words = ("project", self.out + "/sunk.h5", "--map", "blend", "--out", self.out)
        told = self.told(*words, "--tau", "0.02", "--subdivide", "1", codes=(0,))
        before, plain, blend = (row["deviation"] for row in told["wrinkles"])
        self.assertLess(plain, 1e-9)
        self.assertGreater(blend, 0.1 * before)
        with h5py.File(self.path / "out/sunk_projected.h5") as file:
            x = file["frames/positions"][-1]
            self.assertEqual(len(x), 25 * 25)
            self.assertGreaterEqual(np.linalg.norm(x, axis=1).min(), 0.25)
        self.assert_refused(run(*words, "--tau", "-1"), "0 <= eps < tau")

    def test_smooth_gives_a_stored_run_a_surface_without_crossings(self) -> None:
        case = self.write("bumpy.toml", FLAT.format(pattern="jittered", width=0.3, columns=6))
        self.assert_holds(self.simulate(case))
        frames = self.told("smooth", self.out + "/bumpy.h5", "--levels", "2", "--out", self.out,
                           codes=(0,))["frames"]
        self.assertEqual({(frame["crossings"], frame["mean_share"]) for frame in frames}, {(0, 1)})
        with (h5py.File(self.path / "out/bumpy.h5") as coarse,
              h5py.File(self.path / "out/bumpy_smooth.h5") as file):
            self.assertEqual(len(file["mesh/triangles"]), 16 * len(coarse["mesh/triangles"]))

    def test_a_body_of_ones_own_is_kept_deformed_and_projected_beside_its_case(self) -> None:
        shutil.copy(ROOT / "cases/statue.ply", self.path / "body.ply")
        text = (ROOT / "cases/deforming_body.toml").read_text().replace("statue.ply", "body.ply")
        case = self.write("mine.toml", text)
        options = ("--set", "time.end=0.1", "--set", "object.cells=12", "--cache",
                   str(self.path / "kept"))
        for said in ("level sets kept in", "level sets loaded from"):
            self.assertIn(said, self.simulate(case, *options).stderr)
        with h5py.File(self.path / "out/mine.h5") as file:
            vertices, frames = len(file["objects/0/vertices"]), len(file["frames/time"])
            self.assertEqual(file["objects/0/positions"].shape, (frames, vertices, 3))
        self.assert_holds(run("project", self.out + "/mine.h5", "--map", "plain", "--tau", "0.01",
                              "--out", self.out))

    def test_simulate_writes_frames_at_their_times(self) -> None:
        told = self.told("simulate", "hinge", "--set", "time.end=0.25", "--out", self.out)
        self.assertEqual(told["time"], 0.25)
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

    def test_a_misspelt_key_or_a_missing_file_is_refused_by_name(self) -> None:
        text = (ROOT / "cases/hinge.toml").read_text()
        case = self.write("wrong.toml", text.replace("stiffness = 3e-3", "stifness = 3e-3"))
        self.assert_refused(self.simulate(case), "wrong.toml:", "stiffness")
        self.assert_refused(self.simulate("any_mesh", "--set", "cloth.mesh=none.obj"), "none.obj")

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
        for name in ("nowhere", "hard/../hinge", "needs", "/hinge"):
            self.assert_refused(
                simulate_case(name),
                f"{name}: there is no such case file, and no shipped case of that name")

    def test_settle_hangs_one_s_own_fabric_as_the_elastica(self) -> None:
        typed = ("fabric", "mine", "--weight", "180", "--bending-length", "19,16")
        mine = self.write("mine.toml", run(*typed).stdout)
        (read,) = self.told("fabric", "--fabrics", mine)
        self.assertAlmostEqual(read["rigidity"][1], 0.18 * 9.80665 * 0.016**3, 9)
        told = self.told("settle", "cantilever", "--set", f'cloth.fabrics="{mine}"', "--set",
                         "cloth.fabric=mine", "--out", self.out)
        self.assertEqual({row["outcome"] for row in told["findings"]}, {"holds"})
        strip = told["cantilever"]
        self.assertAlmostEqual(strip["drop"] / strip["elastica_drop"], 1, 2)
        moved = run("settle", "hanging_sheet", "--set", "hold.velocity=[0,1,0]", "--out", self.out)
        self.assert_refused(moved, "a prescribed particle moves")
        self.assert_refused(run("settle", "hanging_sheet", "--set", "strain_limits.extension=0.1",
                                "--out", self.out), "strain limits")

    def test_converge_tells_how_long_positions_are_predictable(self) -> None:
        asked = ("converge", "hinge", "--until", "0.1", "--levels", "3", "--out", self.out)
        done = run(*asked)
        self.assertIn("predictable to its end (t = 0.1 s)", done.stdout, done.stderr)
        told = self.told(*asked)["predictability"]
        self.assertIsNone(told["horizon"])
        round_off, nudged = told["twins"]
        for twin in told["twins"]:
            self.assertEqual(len(twin["distances"]), len(told["times"]))
        self.assertLess(round_off["disturbance"], 1e-11)
        self.assertAlmostEqual(nudged["distances"][0] / nudged["disturbance"], 1, 6)
        told = self.told(*asked, "--fraction", "1e-9", "--ensemble", "3")
        self.assertLess(told["predictability"]["horizon"], 0.1)
        self.assertEqual(told["predictability"]["ensemble"], 3)
        self.assertEqual(len(told["predictability"]["statistics"][0]["levels"]), 3)
        self.assertIn("only statistics are predictable", told["quantities"][-1]["because"])
        for words in ("--fraction 1", "--fraction 0", "--ensemble -1"):
            self.assert_rejected("converge", "hinge", *words.split())

    def test_precision_names_the_cheapest_integrator_and_keeps_its_runs(self) -> None:
        ask = ("precision", "hinge", "--until", "0.2", "--method", "A,RK4,backward-euler")
        first, again = (self.told(*ask, "--errors", "0.02", "--out", self.out, codes=(0,))
                        for _ in range(2))
        # the seconds too: nothing was run again
        for one in (first, again):
            del one["program"]["date"]  # when it was asked
        self.assertEqual(first, again)
        starts = [line for file in (self.path / "out/store/shards").iterdir()
                  for line in file.read_text().splitlines() if '"start"' in line]
        methods = first["methods"]
        # the steps that win or tie are asked of a longer run, and so is half of each
        longer = {(method["method"], round(run["step"] / part, 9)) for method in methods
                  for run in method["longer_runs"] for part in (1, 2)}
        runs = sum(len(method["runs"]) for method in methods)
        self.assertEqual(len(starts), runs + len(longer))
        self.assertEqual([one["method"] for one in methods], ["A", "RK4", "backward-euler"])
        (prices,) = first["prices"]
        winner = prices["methods"][0]
        self.assertAlmostEqual(winner["longer_run_energy_gain"], 1, delta=0.1)
        self.assertEqual((prices["error"], winner["over_cheapest"]), (0.02, 1))
        self.assertLess(first["truth"]["good_down_to"], 0.02)
        self.assertIn("hinge at 2 %: " + winner["method"], first["sentences"][0])
        with h5py.File(self.path / "out/precision.h5") as file:
            curves = file["studies/precision.hinge/figures/hinge-work/curves"]
            self.assertEqual(len(curves), 3)
        self.assertIn("Error against work: hinge", self.page_of(self.out))
        unknown = run(*ask, "--errors", "1e-9", "--effort", "0.01", "--out", self.out + "2")
        self.assertEqual(unknown.returncode, 1, unknown.stderr)
        self.assertIn("no price, since the truth is not known to a tenth of this error",
                      unknown.stdout)

    def test_converge_refines_the_mesh(self) -> None:
        asked = ("converge", "hinge", "--until", "0.02", "--levels", "3", "--out", self.out)
        done = run(*asked, "--in", "space")
        self.assertIn("refined by middles of edges, since shape 'hinge' has no finer one",
                      done.stdout, done.stderr)
        told = self.told(*asked, "--in", "space")
        self.assertEqual(told["particles"], [4, 9, 25])
        self.assertEqual(told["level_overrides"], [[], ["cloth.refine=1"], ["cloth.refine=2"]])
        both = self.told(*asked, "--in", "both", "--method", "C,BDF2")["ladders"]
        self.assertEqual([(ladder["in"], ladder["method"]) for ladder in both],
                         [("time", "C"), ("space", "C"), ("time", "BDF2"), ("space", "BDF2")])
        self.assert_rejected(*asked, "--method", "D")
        self.assert_rejected("converge", "hinge", "--in", "height")

    def test_a_case_with_a_mesh_of_ones_own_is_not_failed_by_bounds_for_the_shipped_one(
            self) -> None:
        shutil.copy(ROOT / "cases/skirt.obj", self.path / "skirt.obj")
        case = self.write("mine.toml", (ROOT / "cases/any_mesh.toml").read_text() + TAKES_STEPS)
        quad = self.write("quad.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0.1\nv 0 1 0\nv 0 2 0.2\nv 1 2 0\n"
                                      "f 1 2 3 4\nf 4 3 6 5\n")
        short = (case, "--set", "time.end=0.02")
        self.assertEqual(self.simulate(*short).returncode, 1)
        self.assertEqual(self.simulate(*short, "--set", "bending.stiffness=0.2").returncode, 1)
        mine = (*short, "--set", f"cloth.mesh={quad}")
        done = self.simulate(*mine)
        self.assert_holds(done)
        reason = f"written for skirt.obj; this run uses {quad}"
        self.assertRegex(done.stdout, f"not applicable +case.mine.takes-steps +{reason}\n")
        self.assertRegex(done.stdout, "holds +case.mine.never-crosses-itself ")
        with h5py.File(self.path / "out/mine.h5") as file:
            finding = file["findings/case.mine.takes-steps"].attrs
            self.assertEqual((finding["outcome"], finding["note"]), ("not applicable", reason))
        stated = self.simulate(*mine, "--set", "expect.takes_steps.at_least=1e8")
        self.assertEqual(stated.returncode, 1, stated.stdout)

    def test_a_run_that_diverges_says_when_and_where_and_keeps_its_frames(self) -> None:
        done = self.simulate("hanging_sheet", "--set", "time.step=0.02", "--set",
                             "time.frames_per_second=50")
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, r"stopped: .*step \d+, after t = .* s, particle \d+")
        with h5py.File(self.path / "out/hanging_sheet.h5") as file:
            self.assertGreaterEqual(file["frames/positions"].shape[0], 1)
            self.assertTrue(np.isfinite(file["frames/positions"][:]).all())
            self.assertIn("step", file.attrs["stopped"])

    def test_a_case_says_what_must_hold(self) -> None:
        case = self.write("mine.toml", (ROOT / "cases/hinge.toml").read_text() + TAKES_STEPS)
        asked = (case, "--set", "time.end=0.05")
        done = self.simulate(*asked)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertRegex(done.stdout, r"fails +case\.mine\.takes-steps +\S+ > +0 +steps short of "
                                      r"1e\+09\n +The run takes as many .*\n +The bound: a trial")
        with h5py.File(self.path / "out/mine.h5") as file:
            self.assertEqual(file["findings/case.mine.takes-steps"].attrs["outcome"], "fails")
        told = self.told("simulate", *asked, "--set", "expect.takes_steps.at_least=3", "--out",
                         self.out, codes=(0,))
        self.assertEqual(told["findings"], [{
            "name": "case.mine.takes-steps", "measured": -15.0, "bound": 0.0,
            "unit": "steps short of 3", "outcome": "holds",
            "note": "reached 18 steps; measured is what is missing from 3"
        }])

    def test_the_two_shells_of_the_paper_differ_in_one_number(self) -> None:
        cases = [tomllib.loads((ROOT / f"cases/{name}.toml").read_text())
                 for name in ("water_bottle", "balloon")]
        strong, weak = (case["bending"].pop("stiffness") for case in cases)
        self.assertEqual(round(strong / weak, 9), 100)
        for case in cases:
            for words in ("title", "about", "expect", "ablation"):
                case.pop(words, None)
        self.assertEqual(*cases)

    def interrupt(self, how: int) -> subprocess.CompletedProcess[str]:
        """A run of the hinge that the signal reaches after its second frame."""
        checkpoint = self.path / "out/hinge.checkpoints/000002.h5"
        return run_until(lambda _: checkpoint.exists(), "simulate", "hinge", "--set", "time.end=3",
                         "--out", self.out, how=how)

    def test_an_interrupted_run_says_how_to_resume_it(self) -> None:
        for how in (signal.SIGINT, signal.SIGTERM):
            done = self.interrupt(how)
            self.assertEqual(done.returncode, -how, done.stderr)
            self.assertRegex(
                done.stderr,
                r"interrupted at frame \d+, t = \S+ s of 3 s; resume with: .* --resume\n$")
            command = shlex.split(done.stderr.splitlines()[-1].split("resume with: ")[1])
            again = run(*command[1:])
            self.assert_holds(again)
            self.assertIn("resumed from frame", again.stderr)
            shutil.rmtree(self.path / "out")

    def test_an_interrupted_run_is_deleted_only_on_request(self) -> None:
        command, folder = self.interrupt(signal.SIGKILL).args, self.path / "out/hinge.checkpoints"
        kept = {path.name: path.read_bytes() for path in folder.glob("*.h5")}
        for more, mentions in (((), ("interrupted at frame", "--resume`")),
                               (("--set", "time.end=2"), ("another case text", "another --out"))):
            done = run(*command, *more)
            self.assert_refused(done, *mentions, "t = ", "--restart")
            self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
            for name, content in kept.items():
                self.assertEqual((folder / name).read_bytes(), content)
        self.assertEqual(run(*command, "--resume", "--restart").returncode, 2)
        done = run(*command, "--restart")
        self.assert_holds(done)
        self.assertNotIn("resumed", done.stderr)
        self.assertFalse(folder.exists())


if __name__ == "__main__":
    unittest.main()
