#!/usr/bin/python3
"""Tests of `foldproof converge --over` and `--runs`: how far a solver's settings can be trusted.

scripts/tests/test_converge_settings.py [SettingsTest.test_...]
"""

import math
import unittest
from collections.abc import Callable
from typing import Any

from judge_case import SPRINGS, bad
from program_case import PROGRAM, SHEET, ProgramCase, run

SWING = ("--set", "time.end=0.1", "--set", "gravity.acceleration=[0, -6, -8]", "--set",
         "cloth.columns=3", "--set", "cloth.rows=2", *SPRINGS)
FLOOR = """
[[object]]
shape = "half_space"
move = [0, 0, -0.02]
"""


class SettingsTest(ProgramCase):
    """Solvers that mislead whoever tunes them, and tables of runs."""

    def mapped(self, kind: str, *words: str, objects: str = "",
               over: str = "substeps,iterations") -> dict[str, Any]:
        sheet = self.write("sheet.toml", SHEET + objects)
        return self.told("converge", sheet, "--solver", bad("settings", kind), "--over", over,
                         *SWING, "--errors", "1e-2", *words, "--out", self.out)

    def test_a_right_solver_has_a_limit_near_the_truth_and_a_pair(self) -> None:
        told = self.mapped("kept", "--at", "4,8")
        positions = told["quantities"][0]
        self.assertEqual((positions["no_limit"], positions["unknown"]), ("", ""))
        self.assertLess(positions["limit_from_truth"], positions["bars"] + 1e-3)
        self.assertTrue(positions["pairs"][0]["was_run"])
        self.assertLessEqual(positions["pairs"][0]["error"], 0.01)
        self.assertLessEqual(told["cost"], told["cost_of_grid"] / 3)

    def test_multipliers_that_are_reset_leave_no_limit(self) -> None:
        told = self.mapped("resets_multipliers")
        self.assertIn("its limit depends on iterations", told["quantities"][0]["no_limit"])
        self.assertEqual(told["quantities"][0]["pairs"][0]["at"][0], None)

    def test_a_solve_that_stops_early_is_unconverged(self) -> None:
        told = self.mapped("stops_early", "--at", "4,10", "--set", "stretch.stiffness=4000",
                           "--set", "time.step=1e-4")
        strain = told["quantities"][3]
        self.assertEqual(strain["regime"], "unconverged solve")
        self.assertGreater(strain["left_by_second"], 10 * strain["left_by_first"])
        stiffness = told["material"][0]
        self.assertLess(stiffness["in_use"], 0.3 * stiffness["converged"])

    def test_substeps_that_do_not_refine_contact_are_named(self) -> None:
        for kind, words in (("contact_once_per_step", "do not refine all"),
                            ("kept", "they refine what a step does")):
            told = self.mapped(kind, objects=FLOOR)
            self.assertIn(words, told["step_check"], kind)

    def test_a_cap_on_substeps_is_named(self) -> None:
        told = self.mapped("caps_substeps")
        self.assertIn("substeps beyond 8 change nothing", told["quantities"][0]["ends"])

    def test_settings_in_use_may_have_no_run(self) -> None:
        told = self.told("converge", "hinge", "--solver", f"'{PROGRAM}' serve", "--over", "step",
                         "--at", "1", "--set", "stretch.stiffness=4000", "--set",
                         "stretch.damping=0", "--until", "1", "--errors", "1e-2", "--out", self.out)
        self.assertTrue(told["runs"][0]["stopped"])
        self.assertIn("no run of 1 came to an end", told["sentences"][0])
        self.assertTrue(told["quantities"][0]["pairs"][0]["was_run"])

    def write_run(self, name: str, sag: float) -> str:
        """Two frames of a square of nine vertices, whose middle sags."""
        faces = "".join(f"f {a} {a + 1} {a + 4}\nf {a} {a + 4} {a + 3}\n" for a in (1, 2, 4, 5))
        for frame, depth in enumerate((0.0, sag)):
            rows = "".join(f"v {i / 2} {j / 2} {-depth * (i == j == 1)}\n"
                           for j in range(3) for i in range(3))
            self.write(f"{name}/frame_{frame}.obj", rows + faces)
        return name

    def table(self, sag: Callable[[int, int], float], more: str = "") -> str:
        rows = "".join(f"{s},{n},{s * n / 1000},{self.write_run(f'run_{s}_{n}', sag(s, n))}\n"
                       for n in (2, 4, 8, 16) for s in (1, 2, 4, 8, 16))
        return self.write("runs.csv", "substeps,iterations,seconds,frames\n" + rows + more)

    def test_a_table_of_runs_gives_the_same_map(self) -> None:
        truth = f"truth,,0.1,{self.write_run('truth', 0.4)}\n"
        table = self.table(lambda s, n: 0.4 * (1 + 0.2 / s + 3 / (n**2 * s)), truth)
        told = self.told("converge", "--runs", table, "--at", "2,2", "--out", self.out)
        sag = told["quantities"][1]
        self.assertAlmostEqual(sag["limit"], 0.4, delta=sag["error_bar"] + 1e-9)
        self.assertAlmostEqual(sag["error"], 0.2 / 2 + 3 / 8, delta=0.01)
        self.assertAlmostEqual(sag["order"], 1, delta=0.05)
        self.assertEqual(sag["regime"], "unconverged solve")
        self.assertLess(sag["limit_from_truth"], 1e-3)
        pair = sag["pairs"][0]  # of an error of 2 %, which a row reaches between two runs
        self.assertTrue(math.isnan(pair["error"] or math.nan) or pair["error"] <= 0.01)
        page = self.page_of(self.out)
        self.assertIn("<h2>Your settings</h2>", page)
        self.assertIn("Error of positions over the settings", page)
        for sentence in told["sentences"]:
            if "e-" not in sentence:  # the page writes powers of ten
                self.assertIn(f"<li>{sentence}</li>", page)
        self.assertNotIn("<h2>Studies</h2>", page)

    def test_a_table_without_a_limit_says_so(self) -> None:
        table = self.table(lambda s, n: 0.4 / n + 0.1 / s)
        done = run("converge", "--runs", table, "--out", self.out)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("its limit depends on iterations", done.stdout)

    def test_tables_that_say_too_little_are_refused(self) -> None:
        frames = self.write_run("one", 0.1)
        for text, mention in (("substeps,seconds\n1,2\n", "no column 'frames'"),
                              (f"substeps,frames\n-1,{frames}\n", ":2: '-1' is no positive"),
                              (f"substeps,frames\n1\n", ":2: it has 1 cells"),
                              (f"a,b,c,frames\n1,1,1,{frames}\n", "one tunable, or two")):
            done = run("converge", "--runs", self.write("bad.csv", text), "--out", self.out)
            self.assert_refused(done, mention)
        self.assert_refused(run("converge", "--over", "substeps", "--out", self.out), "CASE")


if __name__ == "__main__":
    unittest.main()
