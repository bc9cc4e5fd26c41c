#!/usr/bin/python3
"""Tests that `foldproof simulate` and the program beside this file agree case by case.

test_independent.py [--program FILE] [IndependentTest.test_...]
--program: instead of build/foldproof
"""

import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True

from model import read_case  # noqa: E402
from simulate import Agreement, compare, read_run, simulate  # noqa: E402

FOLDER = Path(__file__).resolve().parent
OTHER = sys.argv[1:2] == ["--program"]
PROGRAM = Path(sys.argv.pop(2)) if OTHER else FOLDER.parents[1] / "build" / "foldproof"
BOUND = 1e-10  # of the cloth's size: solves leave 1e-13 of a velocity in each of hundreds of steps
ROUNDINGS = 1e-14  # of a mass, a sum of a dozen areas; of a second, in times
CLOCK = 120  # s


def agreement(name: str, changes: dict[str, object]) -> Agreement:
    """Runs the case in both programs. RuntimeError says how `foldproof` ended if not well."""
    file = FOLDER / "cases" / f"{name}.toml"
    model = read_case(file, changes)
    with tempfile.TemporaryDirectory(prefix="foldproof-independent-") as out:
        settings = [
            word
            for key, value in changes.items()
            for word in ("--set", f"{key}={json.dumps(value)}")
        ]
        command = [str(PROGRAM), "simulate", str(file), *settings, "--out", out]
        done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=CLOCK)
        if done.returncode:
            raise RuntimeError(f"exit code {done.returncode}: {done.stderr}")
        return compare(simulate(model), model.mass, read_run(Path(out) / f"{name}.h5"))


class IndependentTest(unittest.TestCase):
    """Each test is a case, or a few variants of one."""

    def agrees(self, name: str, changes: dict[str, object] | None = None) -> None:
        found = agreement(name, changes or {})
        said = f"{name} {changes or ''}: {found}"
        print(said)
        self.assertGreaterEqual(found.steps, 200, said)
        self.assertLessEqual(found.x, BOUND * found.size, said)
        self.assertLessEqual(found.travel, BOUND * found.size, said)
        self.assertLessEqual(found.mass, ROUNDINGS, said)
        self.assertLessEqual(found.time, ROUNDINGS, said)

    def test_springs_hang_by_scheme_c(self) -> None:
        self.agrees("springs")

    def test_crooked_sheet_flies_by_schemes_a_b_c(self) -> None:
        for scheme in "ABC":
            self.agrees("flying", {"time.integrator": scheme})

    def test_prescribed_particles_by_schemes_a_b_c(self) -> None:
        for scheme in "ABC":
            self.agrees("led", {"time.integrator": scheme})

    def test_bending_by_its_other_weights_and_rest_angles(self) -> None:
        for key, value in (("weighting", "current"), ("damping_factor", "edge_squared_over_area"),
                           ("rest_angle", "flat")):
            self.agrees("flying", {f"bending.{key}": value})

    def test_springs_of_scaled_rest_lengths(self) -> None:
        self.agrees("springs", {"stretch.rest_length_scale": 0.93})

    def test_prescribed_particles_by_explicit_methods(self) -> None:
        for method in ("RK2", "SSP-RK3", "RK4"):
            self.agrees("led", {"time.integrator": method})

    def test_contact_with_a_slope_that_moves_for_a_while(self) -> None:
        for scheme in "ABC":
            self.agrees("slope", {"time.integrator": scheme})

    def test_contact_of_midpoints_and_centres(self) -> None:
        self.agrees("slope", {"collision.points": "faces"})

    def test_contact_forecast_over_several_steps(self) -> None:
        self.agrees("slope", {"collision.forecast_time": 0.0043})

    def test_contact_with_a_ball_that_spins_and_drifts(self) -> None:
        self.agrees("ball")

    def test_strain_limits_in_each_order(self) -> None:
        for order in ("gauss_seidel", "alternating", "coloured", "jacobi"):
            self.agrees("limits", {"strain_limits.order": order})

    def test_sticking_to_a_body_that_moves(self) -> None:
        self.agrees("carried")

    def test_two_fabrics_in_wind_by_schemes_a_b_c_and_rk4(self) -> None:
        for scheme in ("A", "B", "C", "RK4"):
            self.agrees("wind", {"time.integrator": scheme})

    def test_membrane_at_an_angle_to_the_warp(self) -> None:
        for degrees in (0.0, 31.0):
            self.agrees("membrane", {"membrane.direction": degrees})

    def test_cloth_sewn_from_a_pattern(self) -> None:
        self.agrees("sewn")

    def test_sticking_of_one_layer_to_another(self) -> None:
        self.agrees("layers")


if __name__ == "__main__":
    if OTHER:
        del sys.argv[1]  # its file is taken out above
    unittest.main()
