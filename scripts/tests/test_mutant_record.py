#!/usr/bin/python3
"""Tests of the shipped record of mutants: what is added to it, and what its scores count."""
from __future__ import annotations

import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True

from script_module import ROOT  # noqa: E402
from edits import Change  # noqa: E402
from mutant_record import (  # noqa: E402
    RECORD,
    not_recorded,
    read_record,
    scores,
    with_outcomes,
    write_record,
)
from mutant_trials import Judgement, Mutant  # noqa: E402


def mutant(after: str) -> Mutant:
    return Mutant("reference/a.cpp", 0, Change(0, 1, "b", "operator"), 3, "a + b", after)


class Record(unittest.TestCase):
    def test_a_mutant_stays_as_it_was_first_found(self) -> None:
        first = with_outcomes([], "reference", [Judgement(mutant("a - b"), "SURVIVED")], 1, "c1")
        again = [Judgement(mutant("a - b"), "killed", "", "check.x"),
                 Judgement(mutant("a * b"), "killed", "crash", "signal 11"),
                 Judgement(mutant("a / b"), "same code")]
        rows = with_outcomes(first, "reference", again, 2, "c2")
        found = [(row["after"], row["outcome"], row["seed"], row["commit"]) for row in rows]
        self.assertEqual(found, [("a - b", "SURVIVED", 1, "c1"), ("a * b", "killed", 2, "c2")])
        self.assertEqual(rows[1]["by"], "crash")
        self.assertEqual(not_recorded([mutant("a - b"), mutant("b")], rows), [mutant("b")])

    def test_scores_leave_explained_mutants_out(self) -> None:
        judged = [Judgement(mutant(text), "killed", "", "check.x") for text in "abcdefgh"]
        judged += [Judgement(mutant("lost"), "SURVIVED"), Judgement(mutant("equal"), "SURVIVED")]
        rows = with_outcomes([], "reference/forces", judged, 1, "c")
        table = scores(rows, {("reference/a.cpp", "a + b", "equal")})
        self.assertEqual(set(table), {"reference/forces", "all"})
        row = table["reference/forces"]
        self.assertEqual((row["killed"], row["survived"], row["equivalent"]), (8, 1, 1))
        self.assertAlmostEqual(row["score"], 8 / 9)
        self.assertLess(row["low"], 0.6)  # nine mutants say little

    def test_a_record_is_read_as_it_was_written(self) -> None:
        rows = with_outcomes([], "reference", [Judgement(mutant("a < \"b\""), "killed")], 1, "c")
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "mutants.json"
            self.assertEqual(read_record(path), [])
            write_record(rows, path)
            self.assertEqual(read_record(path), rows)

    def test_the_shipped_record_is_of_files_of_the_project(self) -> None:
        rows = read_record(RECORD)
        for row in rows:
            self.assertTrue((ROOT / row["file"]).is_file(), row["file"])
            self.assertTrue(row["file"].startswith(row["room"]), row)
            self.assertIn(row["outcome"], ("killed", "SURVIVED", "equivalent"))
        self.assertEqual(len({(r["file"], r["before"], r["after"]) for r in rows}), len(rows))


if __name__ == "__main__":
    unittest.main()
