#!/usr/bin/python3
"""Tests of `foldproof converge --solver`: another solver on a case, beside the reference.

scripts/tests/test_converge_solver.py [SolverTest.test_...]
"""

import unittest
from typing import Any

from judge_case import SPRINGS, bad
from program_case import PROGRAM, SHEET, SPINNING_PLANE, ProgramCase

SERVED = f"'{PROGRAM}' serve --integrator"

RING = """
[[object]]
shape = "torus"
ring_radius = 0.2
tube_radius = 0.1
move = [0, 0, -1]
"""

BALL_AND_ARM = """
[[object]]
shape = "sphere"
radius = 0.1
move = [0.08, 0.05, -0.105]
friction = 0.4

[[object]]
shape = "capsule"
radius = 0.05
length = 0.2
turn = { axis = [0, 1, 0], angle = 95 }
move = [0.22, 0.08, -0.065]
"""

LED = """
[[hold]]
box = [[-1, -1, -1], [0.01, 0.01, 1]]
amplitude = [0, 0.01, 0.02]
frequency = 4
from = 0.013
"""

TURNING_BOX = """
[[object]]
shape = "box"
size = [0.2, 0.2, 0.04]
turn = { axis = [1, 0, 0], angle = 20 }
move = [0.08, 0.05, -0.05]
velocity = [0, 0.1, 0]
angular_velocity = [0, 0, 90]
friction = 0.4
"""

TWO_FABRICS = """
[[fabric]]
box = [[-1, -1, -1], [0.15, 1, 1]]
density = 0.35
[fabric.stretch]
stiffness = 20.0
damping = 0.01
[fabric.bending]
stiffness = 4e-3
"""

LIMITS = """
[strain_limits]
extension = 0.001
"""

WIND = """
[air]
wind = [0, 0, 6]
"""


class SolverTest(ProgramCase):
    """`converge --solver`: another solver's steps, beside the reference's."""

    def ladders(self, solver: str, *words: str, objects: str = "") -> list[dict[str, Any]]:
        sheet = self.write("sheet.toml", SHEET + objects)
        return self.told("converge", sheet, "--solver", solver, *words, "--out",
                         self.out)["ladders"]

    def test_the_reference_over_the_pipe_is_the_reference(self) -> None:
        for method, order in (("C", 2), ("backward-euler", 1)):
            here, there = self.ladders(
                f"{SERVED} {method}", "--method", method, "--set", "time.step=1e-3",
                "--set", "gravity.acceleration=[0, -6, 8]")  # which bends the sheet, too
            self.assertTrue(there["method"].startswith("foldproof reference"))
            self.assertLess(there["from_reference"], 1e-10)
            self.assertFalse(there["beyond_steps"])
            self.assertIn("ke = 4 B", there["mapping"]["bending"])
            self.assertEqual(there["mean_step"], here["mean_step"])
            for ours, theirs in zip(here["quantities"], there["quantities"], strict=True):
                self.assertEqual(theirs["reading"], ours["reading"])
                self.assertAlmostEqual(theirs["error_bar"], ours["error_bar"], delta=1e-9)
            self.assertAlmostEqual(there["quantities"][0]["order"], order, delta=0.15)

    def test_balls_and_capsules_are_the_same_over_the_pipe(self) -> None:
        words = ("--set", "time.step=1e-3", "--set", "gravity.acceleration=[0, -6, -8]")
        free, hit = (self.ladders(f"{SERVED} C", *words, objects=objects)
                     for objects in ("", BALL_AND_ARM))
        self.assertLess(hit[1]["from_reference"], 1e-10)
        self.assertNotEqual(hit[0]["quantities"], free[0]["quantities"])  # it meets them

    def test_what_moves_and_what_cloth_has_is_the_same_over_the_pipe(self) -> None:
        plain = self.ladders(f"{SERVED} C", "--set", "time.step=1e-3", "--set",
                             "gravity.acceleration=[0, -6, -8]")
        for parts in (LED, TURNING_BOX, TWO_FABRICS, LIMITS, WIND):
            with self.subTest(parts=parts):
                here, there = self.ladders(f"{SERVED} C", "--set", "time.step=1e-3", "--set",
                                           "gravity.acceleration=[0, -6, -8]", objects=parts)
                # paths are stated every millisecond; between, they are straight
                self.assertLess(there["from_reference"], 1e-6 if parts in (LED, TURNING_BOX)
                                else 1e-10)
                self.assertNotEqual(here["quantities"], plain[0]["quantities"])

    def test_an_independent_solver_has_its_own_order_and_the_same_limit(self) -> None:
        for kind in ("none", "backward_euler"):
            reference, other = self.ladders(bad("wrong", kind), *SPRINGS)
            self.assertAlmostEqual(reference["quantities"][0]["order"], 2, delta=0.1)
            self.assertAlmostEqual(other["quantities"][0]["order"], 1, delta=0.1)
            self.assertEqual(other["quantities"][0]["reading"], "asymptotic")
            self.assertFalse(other["beyond_steps"], other["in_words"])
            self.assertGreater(other["from_reference"], 0)

    def test_another_model_is_told_from_steps(self) -> None:
        reference, other = self.ladders(bad("wrong", "gravity_scaled"), *SPRINGS)
        self.assertTrue(other["beyond_steps"])
        self.assertIn("so the models differ", other["in_words"])
        # 2 % of what gravity does: the springs hardly leave their linear range
        motion = reference["predictability"]["motion"]
        self.assertAlmostEqual(other["from_reference"] / motion, 0.02, delta=0.002)

    def test_a_solver_is_asked_before_the_horizon_only(self) -> None:
        # pressed against its held edge the sheet buckles, and its motion is soon not predictable
        here, there = self.ladders(
            f"{SERVED} C", "--set", "gravity.acceleration=[3, 30, 2]", "--set",
            "stretch.damping=0", "--set", "bending.stiffness=1e-4", "--set", "time.end=2", "--set",
            "time.step=2e-3", "--levels", "3")
        self.assertLess(here["predictability"]["horizon"], 0.5)
        ours, theirs = here["quantities"][0], there["quantities"][0]
        self.assertEqual(theirs["reading"], ours["reading"])
        self.assertNotEqual(theirs["reading"], "inconclusive")
        for one, other in zip(ours["differences"], theirs["differences"], strict=True):
            self.assertAlmostEqual(other / one, 1, delta=1e-6)
        self.assertLess(there["from_reference"], 1e-9)

    def test_the_report_has_both_ladders(self) -> None:
        self.ladders(bad("wrong", "none"), *SPRINGS)
        page = self.page_of(self.out)
        self.assertIn("toy springs", page)
        self.assertIn("m apart", page)

    def test_what_the_protocol_cannot_say_is_refused(self) -> None:
        sheet, toy = self.write("sheet.toml", SHEET), bad("wrong", "none")
        spins = self.write("spins.toml", SHEET + SPINNING_PLANE)
        ring = self.write("ring.toml", SHEET + RING)
        for words, why in (
            (["drape_sphere", "--solver", toy], "capability 'spheres'"),
            ([ring, "--solver", toy], "a torus"),
            ([spins, "--solver", bad("wrong", "on_planes"), "--set", "stretch.damping=0", "--set",
              "bending.stiffness=0"], "capability 'moving_obstacles'"),
            ([sheet, "--solver", toy], "capability 'damping'"),
            ([sheet, "--solver", toy, "--set", "stretch.damping=0"], "declines: bending"),
            ([sheet, "--solver", toy, "--set", "stretch.damping=0", "--set",
              "strain_limits.extension=0.1"], "capability 'strain_limits'"),
            ([sheet, "--solver", toy, "--until", "0.05"], "try --until 0.04"),
            ([sheet, "--solver", toy, "--set", "stretch.damping=0", "--set",
              "self_collision.thickness=0.01"], "capability 'self_collision'"),
            ([sheet, "--solver", "no_such_program"], "no_such_program"),
            ([sheet, "--solver", toy, "--method", "A,C"], "one method"),
            ([sheet, "--solver", toy, "--in", "both"], "--in excludes --solver"),
            ([sheet, "--settings", "a=1"], "--settings requires --solver"),
        ):
            with self.subTest(why=why):
                self.assertIn(why, self.assert_rejected("converge", *words, "--out", "new"))


if __name__ == "__main__":
    unittest.main()
