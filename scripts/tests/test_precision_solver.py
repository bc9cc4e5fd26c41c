#!/usr/bin/python3
"""Tests of `foldproof precision --solver`: the price of an error with another solver.

scripts/tests/test_precision_solver.py [PrecisionSolverTest.test_...]
"""

import json
import unittest
from typing import Any

from judge_case import SPRINGS, bad
from program_case import PROGRAM, SHEET, ProgramCase, run

SERVED = f"'{PROGRAM}' serve --integrator"


def price_of(told: dict[str, Any], method: str) -> dict[str, Any]:
    """Of the reference with this method, at the first error."""
    return next(price for price in told["prices"][0]["methods"] if price["method"] == method)


class PrecisionSolverTest(ProgramCase):
    def answer(self, solver: str, *words: str) -> dict[str, Any]:
        ask = ("precision", self.write("sheet.toml", SHEET), "--solver", solver, *words, "--json",
               "--out", self.out)
        done = run(*ask)
        told: dict[str, Any] = json.loads(done.stdout)
        answered = all(price["because"] == "" for price in told["solver"]["prices"])
        answered &= all(row["methods"][0]["because"] == "" for row in told["prices"])
        self.assertEqual(done.returncode, 0 if answered else 1, done.stderr)
        return told

    def test_the_reference_over_the_pipe_pays_what_the_reference_pays(self) -> None:
        told = self.answer(
            f"{SERVED} backward-euler", "--method", "C,backward-euler", "--set",
            "gravity.acceleration=[0, -6, 8]", "--errors", "1e-2")
        there = told["solver"]["prices"][0]
        here = price_of(told, "backward-euler")
        self.assertAlmostEqual(there["step"] / here["step"], 1, delta=0.1)
        self.assertAlmostEqual(told["solver"]["order"], 1, delta=0.1)
        self.assertIn("ke = 4 B", told["solver"]["mapping"]["bending"])
        # beside it, the reference's cheapest method
        self.assertIn("the reference with C h = ", told["solver"]["sentences"][0])
        self.assertIn("steps may explain it", told["solver"]["sentences"][-1])

    def test_steps_longer_than_the_case_s_are_tried(self) -> None:
        told = self.answer(f"{SERVED} C", "--method", "A,C", "--errors", "1e-2", "--set",
                           "time.step=1e-4")
        there = told["solver"]["prices"][0]
        here = price_of(told, "C")
        self.assertGreater(there["step"], 20e-4)  # the search begins at four times the case's step
        # both searches narrow it to a quarter
        self.assertLess(abs(there["step"] / here["step"] - 1), 0.35)
        self.assertFalse(there["is_whole_frame"])

    def test_a_bound_is_told_as_a_bound(self) -> None:
        told = self.answer(f"{SERVED} RK4", "--method", "A,C", "--errors", "1e-1", "--set",
                           "time.frames_per_second=500")
        price = told["solver"]["prices"][0]
        self.assertTrue(price["is_whole_frame"])
        self.assertAlmostEqual(price["step"], 0.002)
        self.assertIn("h >= 2 ms (one step a frame", told["solver"]["sentences"][0])

    def test_a_limit_beside_the_truth_is_told_from_steps(self) -> None:
        told = self.answer(bad("wrong", "gravity_scaled"), "--method", "A,C", *SPRINGS,
                           "--errors", "1e-2")
        self.assertIn("so the models differ", told["solver"]["sentences"][-1])
        share = told["solver"]["from_truth"] / told["truth"]["motion"]
        self.assertAlmostEqual(share, 0.02, delta=0.002)

    def test_the_report_has_the_solver_beside_the_reference(self) -> None:
        self.answer(bad("wrong", "none"), "--method", "A,C", *SPRINGS, "--errors", "1e-2")
        page = self.page_of(self.out)
        for words in ("toy springs", "by the clock", "reference, "):
            self.assertIn(words, page)

    def test_what_the_solver_cannot_run_is_refused(self) -> None:
        sheet, toy = self.write("sheet.toml", SHEET), bad("wrong", "none")
        for words, why in (
            ([sheet, "--solver", toy], "capability 'damping'"),
            ([sheet, "--solver", toy, "--set", "stretch.damping=0", "--method", "A,C"],
             "declines: bending"),
            ([sheet, "--solver", "no_such_program"], "no_such_program"),
            ([sheet, "--seconds", "3"], "--seconds requires --solver"),
        ):
            with self.subTest(why=why):
                done = run("precision", *words, "--out", self.out)
                self.assert_refused(done, why)
                self.assertEqual(done.stdout, "")


if __name__ == "__main__":
    unittest.main()
