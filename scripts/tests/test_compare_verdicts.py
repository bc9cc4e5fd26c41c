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


def finding(name: str, **of_it: Any) -> dict[str, Any]:
    return {
        "name": name, "kind": "check", "outcome": "holds", "measured": 0.25, "seconds": 0.5,
        "faults": ["a", "b"]
    } | of_it


class Compared(unittest.TestCase):
    """Two small files of verdicts."""

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def compare(self, before: list[dict], after: list[dict], *options: str) -> tuple[int, str]:
        """Exit code, and all that it printed."""
        words = [sys.executable, str(ROOT / "scripts/compare_verdicts"), *options]
        for name, rows in (("before.json", before), ("after.json", after)):
            (self.folder / name).write_text(json.dumps({"findings": rows}))
            words.append(str(self.folder / name))
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr

    def test_times_and_the_order_of_faults_do_not_count(self) -> None:
        self.assertEqual(
            self.compare([finding("x.y")], [finding("x.y", seconds=9.0, faults=["b", "a"])])[0], 0
        )

    def test_the_last_bit_of_a_number_counts(self) -> None:
        code, printed = self.compare([finding("x.y")], [finding("x.y", measured=0.25 + 2**-54)])
        self.assertEqual(code, 1)
        self.assertIn("x.y: measured was 0.25", printed)

    def test_what_is_gone_or_new_counts(self) -> None:
        code, printed = self.compare(
            [finding("x.y"), finding("old.one")], [finding("x.y"), finding("new.one")]
        )
        self.assertEqual(code, 1)
        self.assertIn("old.one: is gone", printed)
        self.assertIn("new.one: is new", printed)

    def test_sentences_may_differ_if_only_numbers_are_asked_for(self) -> None:
        worded = finding("x.y", claim="Other words.", note="none")
        self.assertEqual(self.compare([finding("x.y")], [worded])[0], 1)
        self.assertEqual(self.compare([finding("x.y")], [worded], "--numbers")[0], 0)
        self.assertEqual(
            self.compare([finding("x.y")], [worded | {"measured": 0.5}], "--numbers")[0], 1
        )

    def test_of_what_the_clock_measures_the_outcome_counts_alone(self) -> None:
        name = "solver.cached-terms-save-time"
        self.assertEqual(self.compare([finding(name)], [finding(name, measured=0.3)])[0], 0)
        self.assertEqual(self.compare([finding(name)], [finding(name, outcome="fails")])[0], 1)

    def test_a_file_without_findings_cannot_be_compared(self) -> None:
        self.assertEqual(self.compare([], [])[0], 2)
        self.assertEqual(self.compare([finding("x.y"), finding("x.y")], [finding("x.y")])[0], 2)


if __name__ == "__main__":
    unittest.main()
