#!/usr/bin/python3
"""Tests of the comparison with other machines, on made-up motions."""

import contextlib
import io
import unittest
from unittest import mock

import numpy as np

from script_module import script

machines = script("machines")
ROUNDING = 2.0**-52


def state(steps: int, height: float) -> "machines.State":
    """Of a triangle of size 1; time, positions, velocities."""
    points = np.array([[0, 0, height], [1, 0, 0], [0, 1, 0]], dtype="<f8")
    return machines.State(steps, np.concatenate([[0.5], points.ravel(), np.zeros(9)]).tobytes())


def motion(growth: float, slip: float = 0):
    """Motions of 1000 steps a second, on which a rounding at the start grows by exp(growth t)."""
    def states(machine, name, seconds, cases, nudge=0):
        steps = int(1000 * seconds)
        there = slip if name not in ("here", "nudged") else 0
        height = 0.5 + nudge * ROUNDING * np.exp(min(300, growth * seconds)) + there
        return {case: state(steps, height) for case in cases}
    return states


class MachinesTest(unittest.TestCase):
    def compared(self, growth: float, slip: float) -> tuple[dict, str]:
        out = io.StringIO()
        with mock.patch.object(machines, "states", motion(growth, slip)):
            with contextlib.redirect_stdout(out):
                asked = machines.asked_cases(0.1, ["a", "b"])
                there = machines.states_there(machines.HERE, "there", asked)
                return machines.compared("there", asked, there), out.getvalue()

    def test_the_same_bits_are_counted(self) -> None:
        told, said = self.compared(0, 0)
        self.assertEqual(told, {"machine": "there", "cases": 2, "apart": []})
        self.assertIn("2 of 2 cases the same bits", said)

    def test_a_rounding_a_step_is_explained_and_more_is_not(self) -> None:
        for slip, wrong in ((101 * ROUNDING, False), (102 * ROUNDING, True)):
            told, said = self.compared(0, slip)
            self.assertEqual(told["apart"][0]["bound"], 101 * ROUNDING)
            self.assertEqual("MORE THAN" in said, wrong)

    def test_a_slip_in_any_coordinate_shows(self) -> None:
        here = state(1, 0.5).bits
        for k in range(1, 10):
            other = np.frombuffer(here, "<f8").copy()
            other[k] += 1e-3
            self.assertAlmostEqual(machines.apart(here, other.tobytes()), 1e-3)
        self.assertEqual(machines.apart(here, here[:-8]), float("inf"))


if __name__ == "__main__":
    unittest.main()
