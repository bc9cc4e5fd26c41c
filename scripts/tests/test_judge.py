#!/usr/bin/python3
"""Tests of `foldproof judge` as the author of an adapter meets it.

scripts/tests/test_judge.py [--program FILE] [Judge.test_...]
--program: instead of build/foldproof
"""
from __future__ import annotations

import json
import math
import os
import re
import shlex
import subprocess
import sys
import unittest
from pathlib import Path

sys.dont_write_bytecode = True

import h5py  # noqa: E402

from judge_case import SUBJECTS, TOY, JudgeCase, bad  # noqa: E402
from program_case import PROGRAM, ROOT, run  # noqa: E402

LAWS = len(json.loads(run("list", "--json").stdout)["laws"])
TOY_DECLINES = {
    "rest.curved-sheet-keeps-its-rest-angles", "order.with-damping-is-as-claimed",
    "momentum.linear-under-damping-is-conserved",
    "damping.edges-damp-in-proportion-to-their-stiffness",
    "damping.stated-forces-sum-to-zero",
    "game-step.static-stretch-is-that-of-short-steps",
    "damping.stated-forces-are-those-of-the-motion",
    "contact.fall-gains-no-energy", "floor.pressed-strip-slips-as-the-elastica",
    "floor.clamped-fold-stands-as-high-as-the-elastica",
    "forces.of-a-bent-sheet-sum-to-zero",
    "forces.of-a-bent-sheet-exert-no-torque",
    "forces.of-a-bent-sheet-are-minus-the-energy-gradient",
    "calibration.bending-rigidity-is-the-scene-s",
    "calibration.rigidity-survives-refinement", "contact.sheet-rests-on-a-plane",
    "contact.resting-sheet-is-still", "contact.slides-as-coulomb-says",
    "contact.slips-at-coulomb-s-slope", "ball.falling-sheet-stays-outside",
    "ball.fall-gains-no-energy", "box.fall-gains-no-energy",
    "capsule.fall-gains-no-energy", "ball.sheet-comes-to-rest",
    "ball.slides-as-coulomb-says", "capstan.strip-lies-on-the-capsule",
    "capstan.slips-at-euler-s-ratio",
    "buckling.upright-strip-falls-at-greenhill-s-load",
    "buckling.strip-on-edge-tips-at-its-load",
    "drape.stiff-ring-sags-as-a-plate", "drape.heavier-ring-hangs-lower",
    "drape.heavier-disc-hangs-lower", "wrinkles.grow-as-tension-and-rigidity-say",
    "strip.loops-hang-as-the-elastica", "strip.rings-take-the-elastica-s-shape",
    "strip.wrinkles-take-the-elastica-s-shape",
    "strip.folds-take-the-elastica-s-shape",
    "vibration.damped-decays-as-its-damping-says",
    "cantilever.heavy-strip-hangs-as-the-elastica",
    "tunnelling.thin-box-stops-a-slow-sheet",
    "self-collision.folded-sheet-never-passes-through-itself"
}


class Judge(JudgeCase):
    def test_the_toy_meets_every_law_and_its_results_are_written(self) -> None:
        out = self.path / "toy"
        done = run("judge", "--solver", TOY, "--name", "my toy", "--out", str(out))
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertRegex(done.stdout, r"\d\d hold, 0 fail, 0 inconclusive, 41 not applicable")
        self.assertIn("mapping of stretch: a spring per edge", done.stdout)
        self.assertEqual(
            {path.name for path in out.iterdir()},
            {"run.h5", "verdicts.json", "junit.xml", "solver.json"},
        )
        with h5py.File(out / "run.h5") as file:
            self.assertEqual(
                (file.attrs["subject"], file.attrs["subject_version"]), ("my toy", "1.0")
            )
            seconds = float(file.attrs["seconds"])
            figure = file["studies/solver.error-against-cost/figures/error_against_cost"]
            self.assertEqual(
                [curve.attrs["label"] for curve in figure["curves"].values()], ["my toy"]
            )
        verdicts = json.loads((out / "verdicts.json").read_text(encoding="utf-8"))
        of_laws = sum(row["seconds"] for row in verdicts["findings"])
        self.assertGreater(of_laws, 0)
        self.assertTrue(of_laws <= seconds < of_laws + 10, (of_laws, seconds))
        declined = {
            row["name"] for row in verdicts["findings"] if row["outcome"] == "not applicable"
        }
        self.assertEqual(declined, TOY_DECLINES)
        facts = json.loads((out / "solver.json").read_text(encoding="utf-8"))
        self.assertEqual(
            [table["law"] for table in facts["calibration"]],
            ["calibration.young-s-modulus-is-the-scene-s",
             "calibration.modulus-survives-refinement",
             "calibration.tension-grows-with-strain"],
        )

    def test_the_reference_can_be_asked_like_any_other(self) -> None:
        done = run(
            "judge", "--solver",
            f"exec '{PROGRAM}' serve --integrator backward-euler --precision f4"
        )
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("foldproof reference", done.stdout)
        self.assertIn("L2, f4, backward Euler of order 1", done.stdout)

    def test_a_wrong_solver_fails_by_the_name_of_the_law(self) -> None:
        done = run("judge", "--solver", bad("wrong", "gravity_scaled"), "--json")
        self.assertEqual(done.returncode, 1)
        failed = [
            row["name"] for row in json.loads(done.stdout)["findings"] if row["outcome"] == "fails"
        ]
        self.assertEqual(
            failed,
            [
                "gravity.speed-grows-by-g-t", "gravity.fall-is-as-exact-as-the-order-claims",
                "forces.weight-is-mass-times-g"
            ],
        )

    def test_a_command_without_a_program_is_refused(self) -> None:
        for words in (("judge", "--solver"), ("subject", "--check")):
            done = run(*words, "/nowhere/solver")
            self.assertEqual((done.returncode, done.stdout), (2, ""), done)
            self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
            self.assertIn("cannot start /nowhere/solver: ", done.stderr)

    def test_a_solver_that_ends_at_its_start_is_a_failure_and_no_crash(self) -> None:
        done = run("judge", "--solver", "exit 3")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("exit 3: did not start", done.stdout)
        self.assertIn("suspect the adapter before the engine", done.stdout)

    def test_a_failed_start_is_told_once_and_the_other_laws_did_not_run(self) -> None:
        out, starts = self.path / "none", self.path / "starts"
        words = f"echo start >> '{starts}'; echo no licence >&2; exit 3"
        done = run("judge", "--solver", words, "--out", str(out))
        self.assertEqual(done.returncode, 1)
        self.assertEqual(starts.read_text(), "start\n")
        for told in ("exited with code 3", "its last words: no licence"):
            self.assertEqual(done.stdout.count(told), 1)
        self.assertLess(len(done.stdout.splitlines()), 10)
        self.assertTrue(done.stdout.endswith(
            f"\n0 hold, 1 fail, 0 inconclusive, 0 not applicable, {LAWS - 1} did not run\n"
        ))
        self.assertEqual(done.stderr, "fails smoke.sheet-at-rest-stays\n")
        rows = json.loads((out / "verdicts.json").read_text(encoding="utf-8"))["findings"]
        self.assertEqual(
            [row["outcome"] for row in rows], ["fails"] + ["did not run"] * (LAWS - 1)
        )
        self.assertEqual(rows[-1]["note"], "the trial ended during smoke.sheet-at-rest-stays")
        self.assertEqual((out / "junit.xml").read_text().count("<error "), LAWS - 1)
        done = run("report", str(out))
        self.assertEqual(done.returncode, 0, done.stderr)
        text = (out / "report.html").read_text(encoding="utf-8")
        self.assertIn("did not start</h1>", text)
        self.assertNotIn("did not finish", text)

    def test_failing_lines_say_what_is_true(self) -> None:
        done = run("judge", "--solver", bad("wrong", "gravity_scaled"), "gravity")
        self.assertRegex(
            done.stdout, r"fails +gravity\.speed-grows-by-g-t +the mean velocity along gravity, "
            r"error 0\.02 g t; [\d.e+]+ >  1"
        )
        self.assertNotRegex(done.stdout, r"fails .*<=")
        done = run("judge", "--solver", bad("broken", "crash"), "smoke")
        self.assertRegex(done.stdout, r"fails +smoke\.\S+ +no number")
        self.assertNotIn("nan", done.stdout)

    def test_single_laws_and_groups_are_judged(self) -> None:
        kept = str(self.keep_baseline(TOY))
        order = "order.observed-is-as-claimed"
        done = run("judge", "--solver", TOY, "held", order, "--json", "--baseline", kept)
        self.assertEqual(done.returncode, 0, done.stderr)
        names = [row["name"] for row in json.loads(done.stdout)["findings"]]
        self.assertEqual(names, ["held.particles-stay", order])
        self.assertEqual(done.stderr, "against the baseline: 0 worse, 0 better\n")
        for typed, told in {
            "contcat": "did you mean contact?", "adapter.py": "is CMD in quotes?",
            "order.observed-is-as-claimd": f"did you mean {order}?", "order.": "there is no law",
        }.items():
            done = run("judge", "--solver", TOY, "held", typed)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertIn(told, done.stderr)
            self.assertEqual(done.stderr.count("\n"), 1)
        done = run("judge", "--frames", str(self.path), "--case", "hanging_sheet", "held")
        self.assertEqual((done.returncode, done.stdout), (2, ""))

    def test_the_laws_are_listed(self) -> None:
        listed = json.loads(run("list", "--json").stdout)
        for laws, kind in ((listed["laws"], "laws"), (listed["frame_laws"], "frame-laws")):
            lines = run("list", kind).stdout.splitlines()
            self.assertRegex(run("list").stdout, rf"(?m)^{kind} +{len(lines)} ")
            for law, line in zip(laws, lines, strict=True):
                self.assertEqual(line.split(maxsplit=1), [law["name"], law["claim"]])

    def test_the_example_of_the_help_works(self) -> None:
        told = run("subject", "--help").stdout
        example = re.search(r"^  foldproof (subject --check .*)$", told, re.M).group(1)
        done = subprocess.run(
            f"'{PROGRAM}' {example}", shell=True, cwd=ROOT, capture_output=True, text=True,
            check=False
        )
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_a_crash_is_told_with_signal_and_last_words(self) -> None:
        done = run("judge", "--solver", bad("broken", "crash"))
        self.assertEqual(done.returncode, 1)
        self.assertIn(
            (
                "crashed with signal 11 (Segmentation fault) during 'advance' by 20 steps of 0.002 "
                "s, after 0 of 20 steps, in the scene 'sheet at rest'; its last words: about to "
                "touch address 0"
            ),
            done.stdout,
        )

    def test_the_same_failure_is_told_once_and_names_its_laws(self) -> None:
        out = self.path / "crash"
        done = run("judge", "--solver", bad("broken", "crash"), "--out", str(out))
        self.assertEqual(done.stdout.count("about to touch address 0"), 1)
        shared = re.search(r"The same in (\d+) more laws:(.*?)\n(?! )", done.stdout, re.S)
        names = re.findall(r"[a-z-]+\.[a-z0-9-]+", shared.group(2))
        self.assertEqual(len(names), int(shared.group(1)))
        rows = json.loads((out / "verdicts.json").read_text(encoding="utf-8"))["findings"]
        failed = [row for row in rows if row["outcome"] == "fails"]
        self.assertEqual([row["name"] for row in failed][1:], names)
        self.assertTrue(all("crashed with signal 11" in row["note"] for row in failed))
        xml = (out / "junit.xml").read_text(encoding="utf-8")
        self.assertEqual(xml.count("<failure "), len(failed))
        self.assertNotIn("nan", xml)

    def test_laws_beyond_the_total_time_did_not_run_and_fail_the_command(self) -> None:
        done = run("judge", "--solver", TOY, "--total-seconds", "0.5")
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertRegex(done.stdout, r" 0 fail, 0 inconclusive, .* did not run\n$")
        self.assertIn("the time of the trial was up during", done.stdout)

    def test_the_report_repeats_what_was_typed(self) -> None:
        out = self.path / "typed"
        run("judge", "--solver", TOY, "smoke", "--seconds", "7.5", "--total-seconds", "90",
            "--settings", "a=b c", "--out", str(out))
        self.assertEqual(run("report", str(out)).returncode, 0)
        text = (out / "report.html").read_text(encoding="utf-8")
        self.assertIn(
            "--settings &#39;a=b c&#39; --seconds 7.5 --total-seconds 90 smoke.sheet-at-rest-stays",
            text,
        )

    def test_a_named_law_that_the_baseline_lacks_is_refused(self) -> None:
        kept = self.path / "few"
        run("judge", "--solver", TOY, "smoke", "held", "--out", str(kept))
        baseline = str(kept / "verdicts.json")
        done = run("judge", "--solver", TOY, "held", "gravity", "--baseline", baseline)
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("has no verdict on 'gravity'", done.stderr)
        looser = f"exec '{PROGRAM}' serve --integrator A"
        run("judge", "--solver", looser, "smoke", "--out", str(kept))
        done = run("judge", "--solver", looser + " --precision f4", "smoke", "--baseline", baseline)
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn("worse: the solver declares f4; the baseline f8: bounds are wider",
                      done.stdout)

    def test_judged_solvers_stand_on_one_page(self) -> None:
        """The toys, a wrong one and the reference, as `foldproof report` shows them."""
        solvers = {
            "python": (TOY, "iterations=20"), "cpp": (f"exec '{ROOT}/build/toy_solver'", "n=1"),
            "wrong": (bad("wrong", "gravity_scaled"), "n=2"), "none": ("exit 3", "n=3"),
            "reference": (f"exec '{PROGRAM}' serve --integrator A --precision f4", "n=4"),
        }
        for name, (command, setting) in solvers.items():
            run("judge", "--solver", command, "--out", str(self.path / name), "--settings", setting)
        done = run("report", *(str(self.path / name) for name in solvers))
        self.assertEqual(done.returncode, 0, done.stderr)
        page = self.path / "reference" / "compare.html"
        self.assertEqual(done.stdout.strip(), str(page))
        said = json.loads(page.with_suffix(".json").read_text(encoding="utf-8"))
        self.assertEqual(len(said["laws"]), LAWS)
        for solver, (command, setting) in zip(said["solvers"], solvers.values()):
            self.assertEqual(solver["command"], command)
            self.assertEqual(solver["settings"], dict([setting.split("=")]))
        self.assertEqual([one["counts"]["fails"] for one in said["solvers"]], [0, 0, 3, 1, 0])
        self.assertEqual(said["solvers"][0]["version"], "1.0")
        for number, name in enumerate(solvers):
            verdicts = json.loads((self.path / name / "verdicts.json").read_text(encoding="utf-8"))
            for law, row in zip(said["laws"], verdicts["findings"]):
                answer = law["answers"][number]
                self.assertEqual(law["name"], row["name"])
                for key in ("outcome", "measured", "bound", "unit", "note"):
                    self.assertEqual(answer[key], row[key])
        text = page.read_text(encoding="utf-8")
        self.assertIn('Differences from a law <span class="quiet">4</span>', text)
        rows = said["error_against_cost"]
        self.assertEqual(len(rows), 4 * 4)  # of the four that started
        self.assertTrue(all(row["has_limit"] and row["seconds by the clock"] > 0 for row in rows))
        self.assertEqual(
            [row["steps"] for row in rows if row["solver"] == said["solvers"][0]["name"]],
            [20, 40, 80, 160],
        )
        for words in (
            "5 solvers on trial", "f4", "Seconds are by the clock of one machine",
            "a spring per edge", "iterations</b> 20",
            "calibration.modulus-survives-refinement", "m below the ball"
        ):
            self.assertIn(words, text)
        for name in solvers:
            facts = json.loads((self.path / name / "solver.json").read_text(encoding="utf-8"))
            portrait = facts["portrait"]
            if "x" not in portrait:
                self.assertNotIn("spheres", facts["capabilities"])
                continue
            away = [math.dist(x, portrait["centre"]) for x in portrait["x"]]
            self.assertEqual(len(away), 21 * 21)
            self.assertGreater(min(away), 0.99 * portrait["radius"])
            self.assertLess(min(away), 1.02 * portrait["radius"])

    def test_folders_that_are_not_all_trials_are_refused(self) -> None:
        kept = self.keep_baseline(TOY).parent
        (self.path / "empty").mkdir()
        done = run("report", str(kept), str(kept), str(self.path / "empty"))
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("only if `foldproof judge --out` wrote each of them", done.stderr)
        (kept / "solver.json").write_text("[]", encoding="utf-8")
        done = run("report", str(kept), str(kept))
        self.assertEqual(done.returncode, 2)
        self.assertIn("solver.json", done.stderr)

    def keep_baseline(self, solver: str) -> Path:
        """The verdicts.json of a solver, kept."""
        out = self.path / "kept"
        run("judge", "--solver", solver, "--out", str(out))
        return out / "verdicts.json"

    def test_known_failures_of_the_baseline_do_not_fail(self) -> None:
        wrong = bad("wrong", "gravity_scaled")
        kept = str(self.keep_baseline(wrong))
        done = run("judge", "--solver", wrong, "--baseline", kept)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertIn("3 fail", done.stdout)
        self.assertEqual(
            done.stdout.splitlines()[-1], "against the baseline: 0 worse, 0 better"
        )
        done = run("judge", "--solver", TOY, "--baseline", kept)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertIn("better: gravity.speed-grows-by-g-t: holds; was: fails", done.stdout)
        self.assertTrue(done.stdout.endswith("against the baseline: 0 worse, 3 better\n"))

    def test_what_got_worse_fails_by_name(self) -> None:
        kept = str(self.keep_baseline(TOY))
        wrong = bad("wrong", "gravity_scaled")
        done = run("judge", "--solver", wrong, "--baseline", kept, "--json")
        self.assertEqual(done.returncode, 1)
        self.assertEqual(len(json.loads(done.stdout)["findings"]), LAWS)
        self.assertRegex(done.stderr, r"worse: gravity.speed-grows-by-g-t: fails, measured/bound")
        self.assertTrue(done.stderr.endswith("against the baseline: 3 worse, 0 better\n"))
        done = run("judge", "--solver", "exit 3", "--baseline", kept)
        self.assertEqual(done.returncode, 1)
        self.assertTrue(done.stdout.endswith(
            f"against the baseline: {LAWS - 41} worse, 0 better, 41 neither\n"  # 41 did not apply
        ))

    def test_the_job_of_the_page_judges_against_its_baseline(self) -> None:
        """The commands of CI.md, in a repository as it describes."""
        page = (SUBJECTS / "CI.md").read_text(encoding="utf-8")
        job = re.search(r"```yaml\n(.*?)```", page, re.S).group(1)
        self.assertLessEqual(len(job.splitlines()), 10)
        keep = re.search(r"^foldproof judge .*$", page, re.M).group()
        judge = re.search(r"run: (foldproof judge .*)$", job, re.M).group(1)
        adapter = self.path / "adapter"
        for program in (TOY, bad("wrong", "gravity_scaled")):
            adapter.write_text(f"#!/bin/sh\n{program}\n", encoding="utf-8")
            adapter.chmod(0o755)
            command = judge if program != TOY else f"{keep} && {judge}"
            done = subprocess.run(
                command, shell=True, cwd=self.path, capture_output=True, text=True, check=False,
                env={**os.environ, "PATH": f"{PROGRAM.parent}:{os.environ['PATH']}"},
            )
            self.assertEqual(done.returncode, int(program != TOY), done.stdout + done.stderr)
        self.assertIn("against the baseline: 3 worse", done.stdout)
        self.assertTrue((self.path / "judged" / "junit.xml").is_file())

    def test_bad_input_is_one_line_and_exit_code_2(self) -> None:
        for words, told in (
            (["judge"], "--solver"), (["judge", "--solver", ""], "--solver"),
            (["judge", "--solver", TOY, "--settings", "iterations"], "write KEY=VALUE"),
            (["judge", "--solver", TOY, "--settings", "=3"], "write KEY=VALUE"),
            (["judge", "--solver", TOY, "--seconds", "0"], "--seconds"), (["subject"], "--check"),
            (["judge", "--solver", TOY, "--baseline", "none.json"], "none.json"),
            (["judge", "--solver", TOY, "--baseline", str(PROGRAM)], "no verdicts.json"),
            (["serve"], "FOLDPROOF_IN is not set"),
            (["serve", "--integrator", "X"], "known: A, B, C"),
            (["serve", "--precision", "f2"], "--precision"),
        ):
            done = run(*words)
            self.assertEqual((done.returncode, done.stdout), (2, ""), words)
            self.assertIn(told, done.stderr)
            self.assertEqual(done.stderr.count("\n"), 1, done.stderr)

    def test_settings_reach_the_solver(self) -> None:
        command, _ = self.logging_solver()
        done = run("judge", "--solver", command, "--settings", "iterations=20")
        self.assertIn("setting iterations = 20", done.stdout)
        self.assertIn("mapping of iterations: 20", done.stdout)

    def test_the_command_that_is_kept_can_be_typed_again(self) -> None:
        out = self.path / "a folder's"
        command, _ = self.logging_solver()
        run("judge", "--solver", command, "--out", str(out))
        kept = json.loads((out / "verdicts.json").read_text(encoding="utf-8"))["program"]["command"]
        self.assertEqual(
            shlex.split(kept)[-5:], ["judge", "--solver", command, "--out", str(out)]
        )


if __name__ == "__main__":
    unittest.main()
