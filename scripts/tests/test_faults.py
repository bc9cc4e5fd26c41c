#!/usr/bin/python3
"""Tests of scripts/faults: which faults --resume skips and which it runs again; where a fault
stands, and what it edits."""
from __future__ import annotations

import tempfile
import unittest
from pathlib import Path

from script_module import script
from occurrences import occurrences, replaced

FAULTS = script("faults")
SLIP = FAULTS.Fault(
    "slip", "reference/forces/springs.cpp", "+", "-", "sums add up", ("sums.add-up",), ("a test",)
)
HIDDEN = FAULTS.Fault(
    "hidden", "reference/forces/springs.cpp", "a", "b", "none", equivalent="no one can see it"
)
ROW = {"name": "sums.add-up", "outcome": "fails", "measured": 3.5, "bound": 0.25, "margin": 14.0}


class Resume(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.known = Path(folder.name) / "below" / "known.jsonl"

    def remember(self, fault: tuple, outcome: str) -> tuple:
        result = FAULTS.Result(fault, outcome, "a detail", 1.5, [ROW], [])
        FAULTS.remember(result, self.known)
        return result

    def test_caught_and_equivalent_faults_are_recalled_as_they_were(self) -> None:
        self.assertEqual(FAULTS.recall([SLIP], self.known), [])
        results = [self.remember(SLIP, "caught"), self.remember(HIDDEN, "equivalent")]
        self.assertEqual(FAULTS.recall([SLIP, HIDDEN], self.known), results)
        self.assertEqual(FAULTS.recall([HIDDEN], self.known), results[1:])
        self.assertEqual(FAULTS.remaining([SLIP, HIDDEN], results[1:]), [SLIP])

    def test_a_row_with_any_other_key_runs_again(self) -> None:
        self.remember(SLIP, "caught")
        for key, value in SLIP._asdict().items():
            other = SLIP._replace(**{
                key: not value if isinstance(value, bool) else
                ("another",) if isinstance(value, tuple) else "another"
            })
            self.assertEqual(FAULTS.recall([other], self.known), [], key)

    def test_an_unfinished_line_loses_only_its_own_fault(self) -> None:
        first = self.remember(HIDDEN, "equivalent")
        with open(self.known, "a", encoding="utf-8") as file:
            file.write('\n{"row": "cut of')
        self.assertEqual(FAULTS.recall([SLIP, HIDDEN], self.known), [first])
        second = self.remember(SLIP, "caught")
        self.assertEqual(FAULTS.recall([SLIP, HIDDEN], self.known), [second, first])


class Rooms(unittest.TestCase):
    def test_the_room_of_a_file_is_its_folder_or_its_name_where_it_has_none(self) -> None:
        for file, room in (
            ("reference/forces/springs.cpp", "forces"), ("verification/verdict.cpp", "verdict"),
            ("verification/checks/forces/spring_checks.cpp", "checks"),
            ("reference/types.h", "types"), ("convergence/order.cpp", "convergence"),
            ("scripts/program/jobs.cpp", "program")
        ):
            self.assertEqual(FAULTS.room_of(file), room)


class Occurrences(unittest.TestCase):
    def test_layout_does_not_count(self) -> None:
        text = 'f(a,\n  "one "\n  "two");\n// first\n// second\nint b;\n'
        for find in ('f(a, "one two")', "first second\nint b", "// first second\n  int b;\n"):
            [part] = occurrences(text, find)
            self.assertEqual(text[part].split()[0], find.removeprefix("// ").split()[0])

    def test_every_occurrence_is_found(self) -> None:
        self.assertEqual(len(occurrences("x = a;\nx =\n  a;", "x = a;")), 2)
        self.assertEqual(occurrences("x = a;", "x = b;"), [])
        self.assertEqual(occurrences("x = a;", ""), [])

    def test_only_what_was_found_is_replaced(self) -> None:
        text = "  x =\n      a + b;  // m\n"
        [part] = occurrences(text, "  x = a ")
        self.assertEqual(replaced(text, part, "x = 2 * a "), "  x = 2 * a + b;  // m\n")


if __name__ == "__main__":
    unittest.main()
