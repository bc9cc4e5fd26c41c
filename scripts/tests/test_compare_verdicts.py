#!/usr/bin/python3
"""Tests of scripts/compare_verdicts: what counts as a difference, and what does not."""
from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]


def finding(name: str = "x.y", **of_it: Any) -> dict[str, Any]:
    return {"name": name, "kind": "check", "outcome": "holds", "measured": 0.25, "seconds": 0.5,
            "faults": ["a", "b"]} | of_it


class Compared(unittest.TestCase):
    """Two small files of verdicts."""

    def compare(self, before: list[dict], after: list[dict], *options: str) -> tuple[int, str]:
        """Exit code, and all that it printed."""
        words = [sys.executable, str(ROOT / "scripts/compare_verdicts"), *options]
        with tempfile.TemporaryDirectory() as folder:
            for name, rows in (("before.json", before), ("after.json", after)):
                (Path(folder) / name).write_text(json.dumps({"findings": rows}))
                words.append(f"{folder}/{name}")
            done = subprocess.run(words, capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr

    def test_numbers_and_names_count_and_times_and_the_order_of_faults_do_not(self) -> None:
        for after, code, said in (
            (finding(seconds=9.0, faults=["b", "a"]), 0, "the same"),
            (finding(measured=0.25 + 2**-54), 1, "x.y: measured was 0.25"),  # the last bit
            (finding("new.one"), 1, "x.y: is gone\nnew.one: is new"),
        ):
            told, printed = self.compare([finding()], [after])
            self.assertEqual(told, code, printed)
            self.assertIn(said, printed)

    def test_sentences_may_differ_if_only_numbers_are_asked_for(self) -> None:
        worded = finding(claim="Other words.", note="none")
        self.assertEqual(self.compare([finding()], [worded])[0], 1)
        self.assertEqual(self.compare([finding()], [worded], "--numbers")[0], 0)
        other = worded | {"measured": 0.5}
        self.assertEqual(self.compare([finding()], [other], "--numbers")[0], 1)

    def test_of_what_the_clock_measures_the_outcome_counts_alone(self) -> None:
        clocked = finding("solver.cached-terms-save-time")
        self.assertEqual(self.compare([clocked], [clocked | {"measured": 0.3}])[0], 0)
        self.assertEqual(self.compare([clocked], [clocked | {"outcome": "fails"}])[0], 1)

    def test_a_file_without_findings_cannot_be_compared(self) -> None:
        self.assertEqual(self.compare([], [])[0], 2)
        self.assertEqual(self.compare([finding(), finding()], [finding()])[0], 2)


if __name__ == "__main__":
    unittest.main()
