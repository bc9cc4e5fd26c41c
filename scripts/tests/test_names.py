#!/usr/bin/python3
"""Cross-references between files: every name in faults, claims, needs and equivalent mutants
exists.

Nothing is compiled or simulated for it. Findings of studies are known here by their study; whether
the study produces them is tested where studies run (`foldproof study`, `foldproof verify`).
"""
from __future__ import annotations

import json
import re
import subprocess
import sys
import unittest
from pathlib import Path

from script_module import ROOT, script
from builds import listed
from edits import apply, changes_of
from mutant_trials import read_explained
from mutants import PYTHON_TESTS, TESTS

sys.path.insert(0, str(ROOT / "reports"))
from pictures.sketches import drawn_studies  # noqa: E402

FAULTS = script("faults")


class Names(unittest.TestCase):
    """The existing names, queried once from the program and the tests."""

    @classmethod
    def setUpClass(cls) -> None:
        cls.listed, cls.studies = listed(), {row["name"] for row in listed()["studies"]}
        told = subprocess.run([TESTS, "--list-test-names-only"], capture_output=True, text=True,
                              check=False)  # its exit code is the number of tests
        cls.tests = set(told.stdout.splitlines())
        for file in PYTHON_TESTS.values():
            text = file.read_text(encoding="utf-8")
            cls.tests |= set(re.findall(r"^    def (test_\w+)\(", text, re.M))

    def exists(self, finding: str) -> bool:
        known = {row["name"] for row in self.listed["checks"]} | {*self.listed["case_findings"]}
        return finding in known or any(
            finding == study or finding.startswith(study + ".") for study in self.studies)

    def test_faults_are_sound_and_name_what_exists(self) -> None:
        faults = FAULTS.read_faults()  # throws where `find` does not occur exactly once
        self.assertGreater(len(faults), 0)
        for fault in faults:
            for name in fault.caught_by:
                self.assertTrue(self.exists(name), f"fault {fault.name}: no finding '{name}'")
            for name in fault.caught_by_tests:
                self.assertIn(name, self.tests, f"fault {fault.name}")

    def test_a_fault_whose_text_is_gone_is_refused(self) -> None:
        sound = FAULTS.read_faults()[0]
        room = FAULTS.room_of(sound.file)
        self.assertIsNone(FAULTS.wrong_row(sound, room))
        self.assertIn(f"belongs in {room}.toml", FAULTS.wrong_row(sound, "another") or "")
        for wrong, words in (
            (sound._replace(find="no such text in any file"), "occurs 0 times"),
            (sound._replace(find=";"), "must occur exactly once"),
            (sound._replace(file="reference/nowhere.cpp"), "is not a .cpp or .h file"),
            (sound._replace(caught_by=(), caught_by_tests=()), "who catches it")
        ):
            self.assertIn(words, FAULTS.wrong_row(wrong, room) or "")
        self.assertFalse(self.exists("bending.forces-sum-to-nothing"))

    def test_claims_name_findings_that_exist(self) -> None:
        self.assertGreater(len(self.listed["claims"]), 0)
        for claim in self.listed["claims"]:
            for name in claim["findings"]:
                self.assertTrue(self.exists(name), f"claim {claim['id']}: no finding '{name}'")

    def test_equivalent_mutants_are_edits_of_lines_that_exist(self) -> None:
        explained = read_explained()  # it counts their lines
        self.assertGreater(len(explained), 0)
        for file, line, becomes in explained:
            text = (ROOT / file).read_text(encoding="utf-8")
            self.assertTrue(self.can_become(text, line, becomes), f"{file}: {line}")

    @staticmethod
    def can_become(text: str, line: str, becomes: str) -> bool:
        """True if one of the edits of the text changes the line in this way."""
        for change in changes_of(text):
            number = text.count("\n", 0, change.at)
            if (text.splitlines()[number].strip() == line
                    and apply(text, change).splitlines()[number].strip() == becomes):
                return True
        return False

    def test_recorded_needs_are_of_cases_and_parts_that_exist(self) -> None:
        needs = json.loads((ROOT / "cases/needs.json").read_text(encoding="utf-8"))["cases"]
        cases = {Path(name).name for name in self.listed["cases"]}
        self.assertLessEqual({row["case"] for row in needs}, cases)
        parts = "\n".join(path.read_text(encoding="utf-8")
                          for path in (ROOT / "convergence").rglob("ablation.cpp"))
        for row in needs:
            for part in row["parts"]:
                name = part["name"].split("'")[0]
                self.assertIn(f'"{name}', parts, row["case"])

    def test_drawings_are_of_studies_that_exist(self) -> None:
        self.assertLessEqual(set(drawn_studies()), self.studies)


if __name__ == "__main__":
    unittest.main()
