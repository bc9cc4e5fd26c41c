#!/usr/bin/python3
"""Tests of `foldproof judge` as the author of an adapter meets it.

scripts/tests/test_judge.py [--program FILE] [Judge.test_...]
--program: instead of build/foldproof
"""
from __future__ import annotations

import functools
import json
import math
import os
import re
import shlex
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path
from typing import Any

import h5py

from judge_case import SUBJECTS, TOY, JudgeCase, bad
from program_case import PROGRAM, ROOT, run

WRONG = bad("wrong", "gravity_scaled")
WRONG_FAILS = ["gravity.is-that-of-the-scene", "gravity.speed-grows-by-g-t",
               "gravity.fall-is-as-exact-as-the-order-claims", "forces.weight-is-mass-times-g"]
CRASHING = bad("broken", "crash")
ORDER = "order.observed-is-as-claimed"


@functools.cache
def trial_of(solver: str) -> Path:
    """The folder of its trial by all laws, which is run once; nobody changes it."""
    folder = tempfile.TemporaryDirectory(prefix="foldproof trial ")
    unittest.addModuleCleanup(folder.cleanup)
    run("judge", "--solver", solver, "--name", "my solver", "--out", folder.name)
    return Path(folder.name)


def baseline_of(solver: str) -> tuple[str, str]:
    return "--baseline", str(trial_of(solver) / "verdicts.json")


def findings_in(folder: Path) -> list[dict[str, Any]]:
    return json.loads((folder / "verdicts.json").read_text(encoding="utf-8"))["findings"]


def count_of_laws() -> int:
    return len(run("list", "laws").stdout.splitlines())


class Judge(JudgeCase):
    def judge(self, solver: str, *words: str) -> subprocess.CompletedProcess[str]:
        return run("judge", "--solver", solver, *words)

    def test_the_toy_meets_every_law_and_its_results_are_written(self) -> None:
        out = self.path / "toy"
        done = self.judge(TOY, "--name", "my toy", "--out", str(out))
        self.assert_holds(done)
        self.assertRegex(done.stdout, r"\d\d hold, 0 fail, 0 inconclusive, \d+ not applicable")
        self.assertIn("mapping of stretch: a spring per edge", done.stdout)
        self.assertEqual({path.name for path in out.iterdir()},
                         {"run.h5", "verdicts.json", "junit.xml", "solver.json"})
        with h5py.File(out / "run.h5") as file:
            self.assertEqual((file.attrs["subject"], file.attrs["subject_version"]),
                             ("my toy", "1.0"))
            seconds = float(file.attrs["seconds"])
            figure = file["studies/solver.error-against-cost/figures/error_against_cost"]
            self.assertEqual([curve.attrs["label"] for curve in figure["curves"].values()],
                             ["my toy"])
        of_laws = sum(row["seconds"] for row in findings_in(out))
        self.assertGreater(of_laws, 0)
        self.assertTrue(of_laws <= seconds < of_laws + 10, (of_laws, seconds))
        facts = json.loads((out / "solver.json").read_text(encoding="utf-8"))
        self.assertTrue(facts["calibration"])
        for table in facts["calibration"]:
            self.assertTrue(table["law"].startswith("calibration."))

    def test_the_reference_can_be_asked_like_any_other(self) -> None:
        done = self.judge(f"exec '{PROGRAM}' serve --integrator backward-euler --precision f4")
        self.assert_holds(done)
        self.assertIn("foldproof reference", done.stdout)
        self.assertIn("L2, f4, backward Euler of order 1", done.stdout)

    def test_a_wrong_solver_fails_by_the_name_of_the_law(self) -> None:
        self.assertEqual([row["name"] for row in findings_in(trial_of(WRONG))
                          if row["outcome"] == "fails"], WRONG_FAILS)

    def test_a_failed_start_is_told_once_and_the_other_laws_did_not_run(self) -> None:
        out, starts, laws = self.path / "none", self.path / "starts", count_of_laws()
        done = self.judge(f"echo start >> '{starts}'; echo no licence >&2; exit 3", "--out",
                          str(out))
        self.assertEqual(done.returncode, 1)
        self.assertEqual(starts.read_text(), "start\n")
        for told in ("exited with code 3", "its last words: no licence", "did not start",
                     "suspect the adapter before the engine"):
            self.assertEqual(done.stdout.count(told), 1, told)
        self.assertLess(len(done.stdout.splitlines()), 10)
        self.assertIn(f"1 fail, 0 inconclusive, 0 not applicable, {laws - 1} did not run",
                      done.stdout)
        rows = findings_in(out)
        self.assertEqual([row["outcome"] for row in rows], ["fails"] + ["did not run"] * (laws - 1))
        self.assertIn("the trial ended during smoke.sheet-at-rest-stays", rows[-1]["note"])
        self.assertEqual((out / "junit.xml").read_text().count("<error "), laws - 1)
        text = self.page_of(out)
        self.assertIn("did not start</h1>", text)
        self.assertNotIn("did not finish", text)

    def test_failing_lines_say_what_is_true(self) -> None:
        done = self.judge(WRONG, "gravity")
        self.assertRegex(done.stdout, r"fails +gravity\.speed-grows-by-g-t .*; [\d.e+]+ >  1")
        self.assertNotRegex(done.stdout, r"fails .*<=")
        done = self.judge(CRASHING, "smoke")
        self.assertRegex(done.stdout, r"fails +smoke\.\S+ +no number")
        self.assertNotIn("nan", done.stdout)

    def test_single_laws_and_groups_are_judged(self) -> None:
        done = self.judge(TOY, "momentum.linear-is", ORDER, "--json", *baseline_of(TOY))
        self.assert_holds(done)
        self.assertEqual([row["name"] for row in json.loads(done.stdout)["findings"]],
                         ["momentum.linear-is-conserved", ORDER])
        self.assertTrue(done.stderr.endswith("against the baseline: 0 worse, 0 better\n"))
        for typed, told in {
            "contcat": "did you mean contact?", "adapter.py": "is CMD in quotes?",
            "order.observed-is-as-claimd": f"did you mean {ORDER}?",
        }.items():
            self.assertIn(told, self.assert_rejected("judge", "--solver", TOY, "held", typed))
        self.assert_rejected("judge", "--frames", ".", "--case", "hanging_sheet", "held")

    def test_the_laws_are_listed(self) -> None:
        def shown(law: dict[str, Any]) -> str:
            return law["claim"] + (f" [{law['needs']}]" if law.get("needs") else "")
        listed, all_kinds = json.loads(run("list", "--json").stdout), run("list").stdout
        for laws, kind in ((listed["laws"], "laws"), (listed["frame_laws"], "frame-laws")):
            lines = run("list", kind).stdout.replace(" (trial)", "").splitlines()
            self.assertRegex(all_kinds, rf"(?m)^{kind} +{len(lines)} ")
            self.assertEqual([line.split(maxsplit=1) for line in lines],
                             [[law["name"], shown(law)] for law in laws])

    def test_the_example_of_the_help_works(self) -> None:
        told = run("subject", "--help").stdout
        example = re.search(r"^  foldproof (subject --check .*)$", told, re.M).group(1)
        self.assert_holds(subprocess.run(f"'{PROGRAM}' {example}", shell=True, cwd=ROOT,
                                         capture_output=True, text=True, check=False))

    def test_the_same_failure_is_told_once_and_names_its_laws(self) -> None:
        out = self.path / "crash"
        done = self.judge(CRASHING, "--out", str(out))
        self.assertEqual(done.returncode, 1)
        self.assertEqual(done.stdout.count("about to touch address 0"), 1)
        self.assertIn("crashed with signal 11 (Segmentation fault) during 'advance' by 20 steps of "
                      "0.002 s, after 0 of 20 steps, in the scene 'sheet at rest'", done.stdout)
        shared = re.search(r"The same in (\d+) more laws:(.*?)\n(?! )", done.stdout, re.S)
        names = re.findall(r"[a-z-]+\.[a-z0-9-]+", shared.group(2))
        self.assertEqual(len(names), int(shared.group(1)))
        failed = [row for row in findings_in(out) if row["outcome"] == "fails"]
        self.assertEqual([row["name"] for row in failed][1:], names)
        self.assertTrue(all("crashed with signal 11" in row["note"] for row in failed))
        xml = (out / "junit.xml").read_text(encoding="utf-8")
        self.assertEqual(xml.count("<failure "), len(failed))
        self.assertNotIn("nan", xml)

    def test_laws_beyond_the_total_time_did_not_run_and_fail_the_command(self) -> None:
        done = self.judge(TOY, "--total-seconds", "0.5")
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertRegex(done.stdout, r" 0 fail, 0 inconclusive, .* did not run\n$")
        self.assertIn("the time of the trial was up during", done.stdout)

    def test_the_report_repeats_what_was_typed(self) -> None:
        self.judge(TOY, "smoke", "--seconds", "7.5", "--total-seconds", "90", "--settings",
                   "a=b c", "--out", self.out)
        self.assertIn("--settings &#39;a=b c&#39; --seconds 7.5 --total-seconds 90 "
                      "smoke.sheet-at-rest-stays", self.page_of(self.out))

    def test_a_named_law_that_the_baseline_lacks_is_refused(self) -> None:
        baseline = ("--baseline", self.out + "/verdicts.json")
        self.judge(TOY, "smoke", "held", "--out", self.out)
        self.assertIn("has no verdict on 'gravity'", self.assert_rejected(
            "judge", "--solver", TOY, "held", "gravity", *baseline))
        looser = f"exec '{PROGRAM}' serve --integrator A"
        self.judge(looser, "smoke", "--out", self.out)
        done = self.judge(looser + " --precision f4", "smoke", *baseline)
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn("worse: the solver declares f4; the baseline f8: bounds are wider",
                      done.stdout)

    def test_judged_solvers_stand_on_one_page(self) -> None:
        """The toys, a wrong one and the reference, as `foldproof report` shows them."""
        solvers = {
            "python": (TOY, "iterations=20"), "cpp": (f"exec '{ROOT}/build/toy_solver'", "n=1"),
            "wrong": (WRONG, "n=2"), "none": ("exit 3", "n=3"),
            "reference": (f"exec '{PROGRAM}' serve --integrator A --precision f4", "n=4"),
        }
        folders = [self.path / name for name in solvers]
        for folder, (command, setting) in zip(folders, solvers.values()):
            self.judge(command, "--out", str(folder), "--settings", setting)
        text = self.page_of(*folders, name="compare.html")
        told = json.loads((folders[-1] / "compare.json").read_text(encoding="utf-8"))
        self.assertEqual(len(told["laws"]), count_of_laws())
        for solver, (command, setting) in zip(told["solvers"], solvers.values()):
            self.assertEqual(solver["command"], command)
            self.assertEqual(solver["settings"], dict([setting.split("=")]))
        self.assertEqual([one["counts"]["fails"] for one in told["solvers"]], [0, 0, 4, 1, 0])
        for number, folder in enumerate(folders):
            for law, row in zip(told["laws"], findings_in(folder), strict=True):
                self.assertEqual(law["name"], row["name"])
                for key in ("outcome", "measured", "bound", "unit", "note"):
                    self.assertEqual(law["answers"][number][key], row[key])
        self.assertIn('Differences from a law <span class="quiet">5</span>', text)
        rows = told["error_against_cost"]
        self.assertEqual(len(rows), 4 * 4)  # of the four that started
        self.assertTrue(all(row["has_limit"] and row["seconds by the clock"] > 0 for row in rows))
        self.assertEqual([row["steps"] for row in rows[:4]], [20, 40, 80, 160])
        for words in ("5 solvers on trial", "f4", "Seconds are by the clock of one machine",
                      "a spring per edge", "iterations</b> 20", "m below the ball"):
            self.assertIn(words, text)
        for folder in folders:
            facts = json.loads((folder / "solver.json").read_text(encoding="utf-8"))
            portrait = facts["portrait"]
            if "x" not in portrait:
                self.assertNotIn("spheres", facts["capabilities"])
                continue
            away = [math.dist(x, portrait["centre"]) for x in portrait["x"]]
            self.assertEqual(len(away), 21 * 21)
            self.assertTrue(0.99 < min(away) / portrait["radius"] < 1.02)

    def test_folders_that_are_not_all_trials_are_refused(self) -> None:
        (self.path / "empty").mkdir()
        kept = str(trial_of(TOY))
        self.assertIn("only if `foldproof judge --out` wrote each of them", self.assert_rejected(
            "report", kept, kept, str(self.path / "empty")))
        shutil.copytree(trial_of(TOY), self.out)
        self.write("out/solver.json", "[]")
        self.assert_refused(run("report", self.out, self.out), "solver.json")

    def test_what_is_worse_than_the_baseline_fails_by_name_and_the_rest_does_not(self) -> None:
        laws = count_of_laws()
        for solver, kept, code, mentions in (
            (WRONG, WRONG, 0, ["4 fail", ": 0 worse, 0 better\n"]),
            (TOY, WRONG, 0, [f"better: {WRONG_FAILS[0]}: holds; was: fails",
                             ": 0 worse, 4 better\n"]),
            (WRONG, TOY, 1, [f"worse: {WRONG_FAILS[0]}: fails, measured/bound",
                             ": 4 worse, 0 better\n"])
        ):
            done = self.judge(solver, *baseline_of(kept))
            self.assertEqual(done.returncode, code, done.stdout)
            for said in mentions:
                self.assertIn(said, done.stdout)
        done = self.judge(WRONG, "--json", *baseline_of(TOY))
        self.assertEqual(len(json.loads(done.stdout)["findings"]), laws)
        self.assertTrue(done.stderr.endswith("against the baseline: 4 worse, 0 better\n"))
        neither = sum(row["outcome"] == "not applicable" for row in findings_in(trial_of(TOY)))
        done = self.judge("exit 3", *baseline_of(TOY))
        self.assertEqual(done.returncode, 1)
        self.assertIn(f": {laws - neither} worse, 0 better, {neither} neither\n", done.stdout)

    def test_verdicts_kept_as_the_page_says_are_a_baseline(self) -> None:
        page = (SUBJECTS / "CI.md").read_text(encoding="utf-8")
        keep = re.search(r"^foldproof judge .*$", page, re.M).group()
        adapter = self.path / "adapter"
        for program, command in ((TOY, keep), (WRONG, "foldproof judge --solver ./adapter "
                                                      "--baseline baseline.json --out judged")):
            adapter.write_text(f"#!/bin/sh\n{program}\n", encoding="utf-8")
            adapter.chmod(0o755)
            done = subprocess.run(
                command, shell=True, cwd=self.path, capture_output=True, text=True, check=False,
                env={**os.environ, "PATH": f"{PROGRAM.parent}:{os.environ['PATH']}"})
            self.assertEqual(done.returncode, int(program != TOY), done.stdout + done.stderr)
        self.assertIn("against the baseline: 4 worse", done.stdout)
        self.assertTrue((self.path / "judged" / "junit.xml").is_file())

    def test_bad_input_is_one_line_and_exit_code_2(self) -> None:
        toy = ("judge", "--solver", TOY)
        for words, told in (
            (("judge",), "--solver"), (("judge", "--solver", ""), "--solver"),
            (("judge", "--solver", "/nowhere/solver"), "cannot start /nowhere/solver: "),
            (("subject", "--check", "/nowhere/solver"), "cannot start /nowhere/solver: "),
            ((*toy, "--settings", "iterations"), "write KEY=VALUE"),
            ((*toy, "--settings", "=3"), "write KEY=VALUE"),
            ((*toy, "--seconds", "0"), "--seconds"), (("subject",), "--check"),
            ((*toy, "--baseline", "none.json"), "none.json"),
            ((*toy, "--baseline", str(PROGRAM)), "no verdicts.json"),
            (("serve",), "FOLDPROOF_IN is not set"),
            (("serve", "--integrator", "X"), "known: A, B, C"),
            (("serve", "--precision", "f2"), "--precision"),
        ):
            self.assertIn(told, self.assert_rejected(*words))

    def test_settings_reach_the_solver_and_the_command_can_be_typed_again(self) -> None:
        command, _ = self.logging_solver()
        words = ["--settings", "iterations=20", "--out", str(self.path / "a folder's")]
        done = self.judge(command, "smoke", *words)
        self.assertIn("setting iterations = 20", done.stdout)
        self.assertIn("mapping of iterations: 20", done.stdout)
        kept = json.loads((self.path / "a folder's/verdicts.json").read_text(encoding="utf-8"))
        self.assertEqual(shlex.split(kept["program"]["command"])[1:],
                         ["judge", "--solver", command, "smoke", *words])


if __name__ == "__main__":
    unittest.main()
