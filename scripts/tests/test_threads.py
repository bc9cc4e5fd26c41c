#!/usr/bin/python3
"""Shipped cases on one, two and three threads: every number of the stored runs is the same.

scripts/tests/test_threads.py [--program FILE] [ThreadsTest.test_...]
--program: instead of build/foldproof
"""

import unittest
from pathlib import Path

import h5py
import numpy as np

from program_case import ProgramCase

# Beginnings of shipped cases, and a counter or measure of the part of the method that each needs.
CASES = [  # case, end [s], dataset of the diagnostics that must not be all zero
    ("hanging_sheet", 0.02, "gravity_energy"),
    ("flag_drop", 0.02, "cg_iterations"),
    ("rest_fold", 0.02, "bending_energy"),
    ("drape_sphere", 0.17, "object_contacts"),
    ("incline", 0.02, "object_contacts"),
    ("grab", 0.02, "object_contacts"),
    ("pinch", 0.02, "cg_iterations"),
    ("spinning_sphere", 0.02, "gravity_energy"),
    ("hard/biphasic_pull", 0.02, "strain_left"),
    ("hard/buckle", 0.01, "strain_left"),
    ("hard/sticky_layers", 0.01, "bonds"),
    ("hard/reef_fold", 0.01, "close_pairs"),
]


def numbers(file: Path) -> dict[str, np.ndarray]:
    """All datasets of numbers but clock time."""
    found: dict[str, np.ndarray] = {}

    def add(name: str, item: h5py.HLObject) -> None:
        if isinstance(item, h5py.Dataset) and item.dtype.kind in "fiu":
            if name != "diagnostics/seconds":
                found[name] = item[()]

    with h5py.File(file) as run:
        run.visititems(add)
    return found


class ThreadsTest(ProgramCase):
    def run_on(self, threads: int, case: str, end: float) -> dict[str, np.ndarray]:
        done = self.simulate(case, "--set", f"time.end={end}", "--threads", str(threads))
        self.assertIn(done.returncode, (0, 1), done.stderr)  # expectations may need the whole run
        return numbers(self.path / "out" / f"{Path(case).name}.h5")

    def test_threads_change_no_bit_of_shipped_cases(self) -> None:
        for case, end, needed in CASES:
            alone = self.run_on(1, case, end)
            self.assertTrue(np.any(alone[f"diagnostics/{needed}"]), (case, needed))
            for threads in (2, 3):
                shared = self.run_on(threads, case, end)
                self.assertEqual(alone.keys(), shared.keys(), case)
                for name, values in alone.items():
                    self.assertEqual(values.tobytes(), shared[name].tobytes(), (case, name))

    def test_threads_are_a_whole_number(self) -> None:
        for wrong in ("0", "1.5", "many", "-2"):
            message = self.assert_rejected("simulate", "hinge", f"--threads={wrong}")
            self.assertIn("--threads", message)


if __name__ == "__main__":
    unittest.main()
