#!/usr/bin/python3
"""The last frame of a few short runs has the expected bits, on any number of threads.

One constant holds everything, and proves nothing about any part of it: no seeded fault and no
mutant is tried on this test. It tells whoever changes the method that results change. The bits
depend on the C library's sines and powers, so elsewhere the test is skipped.

scripts/tests/test_final_bits.py [--program FILE]
"""

import hashlib
import platform
import unittest
from pathlib import Path

import h5py

from program_case import ProgramCase

LIBRARY = ("glibc", "2.36")  # with which the constant was made, on x86-64 with fused operations
EXPECTED = "3d46a39b94f4c4d8b3c6aeec50bd2d9d07d2bf57e22a6ffcf51c37d37bc765d5"
CASES = [  # case, end [s]
    ("hanging_sheet", 0.04),
    ("flag_drop", 0.03),
    ("pinch", 0.05),
    ("hard/biphasic_pull", 0.02),
    ("hard/reef_fold", 0.01),
]


def is_the_same_machine() -> bool:
    return (platform.machine() == "x86_64" and platform.libc_ver() == LIBRARY
            and " fma " in Path("/proc/cpuinfo").read_text(encoding="utf-8"))


class FinalBitsTest(ProgramCase):
    def digest_on(self, threads: int) -> str:
        digest = hashlib.sha256()
        for case, end in CASES:
            self.simulate(case, "--set", f"time.end={end}", "--threads", str(threads))
            with h5py.File(self.path / "out" / f"{Path(case).name}.h5") as run:
                for name in ("positions", "velocities"):
                    digest.update(run[f"frames/{name}"][-1].tobytes())
        return digest.hexdigest()

    @unittest.skipUnless(is_the_same_machine(), "another processor or C library: other sines")
    def test_the_last_frames_have_the_expected_bits(self) -> None:
        self.assertEqual({n: self.digest_on(n) for n in (1, 2, 3, 8)},
                         dict.fromkeys((1, 2, 3, 8), EXPECTED))


if __name__ == "__main__":
    unittest.main()
