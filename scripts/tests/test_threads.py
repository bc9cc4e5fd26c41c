#!/usr/bin/python3
"""Bits of stored runs: the same on any number of threads, and those that were expected.

scripts/tests/test_threads.py [--program FILE] [ThreadsTest.test_...]
--program: instead of build/foldproof
"""

import hashlib
import platform
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

LIBRARY = ("glibc", "2.36")  # with which the constant was made, on x86-64 with fused operations
EXPECTED = "3d46a39b94f4c4d8b3c6aeec50bd2d9d07d2bf57e22a6ffcf51c37d37bc765d5"
LAST_FRAMES = [  # case, end [s]
    ("hanging_sheet", 0.04), ("flag_drop", 0.03), ("pinch", 0.05), ("hard/biphasic_pull", 0.02),
    ("hard/reef_fold", 0.01)
]


def is_the_same_machine() -> bool:
    return (platform.machine() == "x86_64" and platform.libc_ver() == LIBRARY
            and " fma " in Path("/proc/cpuinfo").read_text(encoding="utf-8"))


class ThreadsTest(ProgramCase):
    def run_on(self, threads: int, case: str, end: float) -> dict[str, np.ndarray]:
        """All datasets of numbers but clock time."""
        done = self.simulate(case, "--set", f"time.end={end}", "--threads", str(threads))
        self.assertIn(done.returncode, (0, 1), done.stderr)  # expectations may need the whole run
        found: dict[str, np.ndarray] = {}

        def add(name: str, item: h5py.HLObject) -> None:
            if isinstance(item, h5py.Dataset) and item.dtype.kind in "fiu":
                if name != "diagnostics/seconds":
                    found[name] = item[()]

        with h5py.File(self.path / "out" / f"{Path(case).name}.h5") as file:
            file.visititems(add)
        return found

    def test_threads_change_no_bit_of_shipped_cases(self) -> None:
        for case, end, needed in CASES:
            alone = self.run_on(1, case, end)
            self.assertTrue(np.any(alone[f"diagnostics/{needed}"]), (case, needed))
            for threads in (2, 3):
                shared = self.run_on(threads, case, end)
                self.assertEqual(alone.keys(), shared.keys(), case)
                for name, values in alone.items():
                    self.assertEqual(values.tobytes(), shared[name].tobytes(), (case, name))

    @unittest.skipUnless(is_the_same_machine(), "another processor or C library: other sines")
    def test_the_last_frames_have_the_expected_bits(self) -> None:
        """One constant holds everything, and proves nothing about any part of it: no seeded fault
        and no mutant is tried on this test. It tells whoever changes the method that results
        change. The bits depend on the C library's sines and powers."""
        for threads in (1, 8):
            digest = hashlib.sha256()
            for case, end in LAST_FRAMES:
                found = self.run_on(threads, case, end)
                for name in ("positions", "velocities"):
                    digest.update(found[f"frames/{name}"][-1].tobytes())
            self.assertEqual(digest.hexdigest(), EXPECTED, threads)

    def test_threads_are_a_whole_number(self) -> None:
        for wrong in ("0", "1.5", "many", "-2"):
            message = self.assert_rejected("simulate", "hinge", f"--threads={wrong}")
            self.assertIn("--threads", message)


if __name__ == "__main__":
    unittest.main()
