#!/usr/bin/python3
"""Tests of `foldproof precision --solver`: the price of an error with another solver.

scripts/tests/test_precision_solver.py [PrecisionSolverTest.test_...]
"""

import json
import sys
import unittest
from typing import Any

sys.dont_write_bytecode = True

from program_case import PROGRAM, ROOT, SHEET, ProgramCase, run  # noqa: E402

WRONG = f"/usr/bin/python3 '{ROOT / 'verification' / 'subjects' / 'bad' / 'wrong.py'}'"
SPINNING_PLANE = """
[[object]]
shape = "half_space"
move = [0, 0, -1]
angular_velocity = [0, 0, 90]
"""
SPRINGS = (
    *("--set", "bending.stiffness=0"), *("--set", "stretch.damping=0"),
    *("--set", "time.step=5e-4")
)


class PrecisionSolverTest(ProgramCase):
    def answer(self, solver: str, *words: str) -> dict[str, Any]:
        sheet = self.write("sheet.toml", SHEET)
        done = run(
            "precision", sheet, "--solver", solver, *words, "--json", "--out",
            str(self.path / "out")
        )
        self.assertIn(done.returncode, (0, 1), done.stderr)
        told: dict[str, Any] = json.loads(done.stdout)
        answered = all(price["because"] == "" for price in told["solver"]["prices"])
        answered &= all(row["methods"][0]["because"] == "" for row in told["prices"])
        self.assertEqual(done.returncode, 0 if answered else 1)
        return told

    def test_the_reference_over_the_pipe_pays_what_the_reference_pays(self) -> None:
        told = self.answer(
            f"'{PROGRAM}' serve --integrator backward-euler", "--method", "C,backward-euler",
            *("--set", "gravity.acceleration=[0, -6, 8]", "--errors", "1e-2")
        )
        there = told["solver"]["prices"][0]
        here = next(
            price for price in told["prices"][0]["methods"] if price["method"] == "backward-euler"
        )
        self.assertAlmostEqual(there["step"] / here["step"], 1, delta=0.1)
        self.assertAlmostEqual(told["solver"]["order"], 1, delta=0.1)
        self.assertIn("ke = 4 B", told["solver"]["mapping"]["bending"])
        # beside it, the reference's cheapest method
        self.assertIn("the reference with C h = ", told["solver"]["sentences"][0])
        self.assertIn("steps may explain it", told["solver"]["sentences"][-1])

    def test_steps_longer_than_the_case_s_are_tried(self) -> None:
        told = self.answer(
            f"'{PROGRAM}' serve --integrator C", "--method", "A,C", "--errors", "1e-2", "--set",
            "time.step=1e-4"
        )
        there = told["solver"]["prices"][0]
        here = next(
            price for price in told["prices"][0]["methods"] if price["method"] == "C"
        )
        self.assertGreater(there["step"], 20e-4)  # the search begins at four times the case's step
        # both searches narrow it to a quarter
        self.assertLess(abs(there["step"] / here["step"] - 1), 0.35)
        self.assertFalse(there["is_whole_frame"])

    def test_a_bound_is_told_as_a_bound(self) -> None:
        told = self.answer(
            f"'{PROGRAM}' serve --integrator RK4", "--method", "A,C", "--errors", "1e-1", "--set",
            "time.frames_per_second=500"
        )
        price = told["solver"]["prices"][0]
        self.assertTrue(price["is_whole_frame"])
        self.assertAlmostEqual(price["step"], 0.002)
        self.assertIn("h >= 2 ms (one step a frame", told["solver"]["sentences"][0])

    def test_a_limit_beside_the_truth_is_told_from_steps(self) -> None:
        told = self.answer(
            f"{WRONG} gravity_scaled", "--method", "A,C", *SPRINGS, "--errors", "1e-2"
        )
        self.assertIn("so the models differ", told["solver"]["sentences"][-1])
        self.assertAlmostEqual(
            told["solver"]["from_truth"] / told["truth"]["motion"], 0.02, delta=0.002
        )

    def test_the_report_has_the_solver_beside_the_reference(self) -> None:
        self.answer(f"{WRONG} none", "--method", "A,C", *SPRINGS, "--errors", "1e-2")
        done = run("report", str(self.path / "out"))
        self.assertEqual(done.returncode, 0, done.stderr)
        page = (self.path / "out" / "report.html").read_text(encoding="utf-8")
        for words in ("toy springs", "by the clock", "reference, "):
            self.assertIn(words, page)

    def test_what_the_solver_cannot_run_is_refused(self) -> None:
        sheet, toy = self.write("sheet.toml", SHEET), f"{WRONG} none"
        spins = self.write("spins.toml", SHEET + SPINNING_PLANE)
        for words, why in (
            ([spins, "--solver", toy], "which moves or deforms"),
            ([sheet, "--solver", toy], "capability 'damping'"),
            ([sheet, "--solver", toy, "--set", "stretch.damping=0", "--method", "A,C"],
             "declines: bending"),
            ([sheet, "--solver", "no_such_program"], "no_such_program"),
            ([sheet, "--seconds", "3"], "--seconds requires --solver"),
        ):
            with self.subTest(why=why):
                done = run("precision", *words, "--out", str(self.path / "out"))
                self.assertEqual((done.returncode, done.stdout), (2, ""))
                self.assertIn(why, done.stderr)


if __name__ == "__main__":
    unittest.main()
