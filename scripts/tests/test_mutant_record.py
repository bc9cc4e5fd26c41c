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
from mutant_explained import edit_of, not_asked, with_answers, write_answers  # noqa: E402
from mutant_record import (  # noqa: E402
    RECORD,
    log_asked,
    nearest_line,
    not_recorded,
    read_asked,
    read_rows,
    rows_of,
    with_new,
    with_noticed,
    write_record,
)
from data.mutant_record import EXPLAINED_ASKED, parts_of, samples_of, score_interval  # noqa: E402
from mutant_trials import Judgement, Mutant, read_explained  # noqa: E402


def mutant(after: str) -> Mutant:
    return Mutant("reference/a.cpp", 0, Change(0, 1, "b", "operator"), 3, "a + b", after)


class Explained(unittest.TestCase):
    def test_edits_that_were_asked_are_not_asked_again(self) -> None:
        first = not_asked([], 1)[:3]
        answers = with_answers(
            [],
            [Judgement(first[0], "killed", "", "check.x"), Judgement(first[1], "SURVIVED"),
             Judgement(first[2], "ERROR")], "c"
        )
        self.assertEqual([row["outcome"] for row in answers], ["killed", "SURVIVED"])
        left = {(one.file, one.before, one.after) for one in not_asked(answers, 2)}
        self.assertEqual(
            [(one.file, one.before, one.after) in left for one in first], [False, False, True]
        )
        self.assertEqual(len(left), len(not_asked([], 1)) - 2)

    def test_an_explained_edit_stands_where_its_line_does(self) -> None:
        for one in not_asked([], 3)[:50]:
            text = (ROOT / one.file).read_text(encoding="utf-8")
            self.assertEqual(edit_of(0, one.file, one.before, one.after).line, one.line)
            self.assertEqual(text.splitlines()[one.line - 1].strip(), one.before)
            self.assertTrue(text[one.change.at:].startswith(one.before))

    def test_no_edit_that_was_noticed_still_has_a_reason(self) -> None:
        explained = read_explained()
        for row in read_rows(EXPLAINED_ASKED):
            if row["outcome"] == "killed":
                self.assertNotIn((row["file"], row["before"], row["after"]), explained)

    def test_answers_are_read_as_they_were_written(self) -> None:
        rows = with_answers([], [Judgement(mutant("a - b"), "SURVIVED")], "c")
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "explained.json"
            write_answers(rows, path)
            self.assertEqual(read_rows(path), rows)


class Record(unittest.TestCase):
    def test_a_mutant_stays_as_it_was_first_found_at_a_commit(self) -> None:
        first = rows_of("reference", [Judgement(mutant("a - b"), "SURVIVED")], 1, "c1")
        again = [Judgement(mutant("a - b"), "killed", "", "check.x"),
                 Judgement(mutant("a * b"), "killed", "crash", "signal 11"),
                 Judgement(mutant("a / b"), "same code")]
        rows = with_new(first, rows_of("reference", again, 2, "c1"))
        found = [(row["after"], row["outcome"], row["seed"], row["commit"]) for row in rows]
        self.assertEqual(found, [("a - b", "SURVIVED", 1, "c1"), ("a * b", "killed", 2, "c1")])
        self.assertEqual(rows[1]["by"], "crash")
        self.assertEqual(not_recorded([mutant("a - b"), mutant("b")], rows, "c1"), [mutant("b")])
        self.assertEqual(len(with_new(rows, rows_of("reference", again, 2, "c2"))), 4)
        self.assertEqual(len(not_recorded([mutant("a - b")], rows, "c2")), 1)

    def test_scores_leave_explained_mutants_out(self) -> None:
        judged = [Judgement(mutant(text), "killed", "", "check.x") for text in "abcdefgh"]
        judged += [Judgement(mutant("lost"), "SURVIVED"), Judgement(mutant("equal"), "SURVIVED")]
        rows = rows_of("reference/forces", judged, 1, "c")
        row, of_all = samples_of(rows, {("reference/a.cpp", "a + b", "equal")})[0].scores
        self.assertEqual((row.room, of_all.room), ("reference/forces", "all"))
        self.assertEqual((row.killed, row.survived, row.equivalent), (8, 1, 1))
        self.assertAlmostEqual(row.share, 8 / 9)
        self.assertLess(row.low, 0.6)  # nine mutants say little

    def test_samples_of_two_commits_are_not_mixed(self) -> None:
        rows = rows_of("reference", [Judgement(mutant("x"), "SURVIVED")], 1, "c1")
        rows = [{**row, "date": "2020-01-01"} for row in rows]
        rows += rows_of("reference", [Judgement(mutant("x"), "killed", "", "check.x")], 1, "c2")
        found = [(one.commit, one.scores[-1].killed) for one in samples_of(rows[::-1], set())]
        self.assertEqual(found, [("c1", 0), ("c2", 1)])

    def test_the_method_and_what_judges_it_have_samples_of_their_own(self) -> None:
        rows = []
        for room, commit in (("reference/x", "c1"), ("verification/y", "c2"),
                             ("convergence/order.cpp", "c2"), ("reference/x", "c3")):
            rows += rows_of(room, [Judgement(mutant(room), "killed", "", "check.x")], 1, commit)
        method, judges = parts_of(rows, set())
        found = [(part.newest.commit, [one.commit for one in part.earlier])
                 for part in (method, judges)]
        self.assertEqual(found, [("c3", ["c1"]), ("c2", [])])
        self.assertEqual([row.room for row in judges.newest.scores],
                         ["convergence/order.cpp", "verification/y", "all"])
        self.assertEqual([part.title for part in parts_of(rows[1:3], set())], ["What judges it"])

    def test_what_a_campaign_asked_is_read_again_but_for_a_torn_line(self) -> None:
        row = rows_of("reference", [Judgement(mutant("x"), "killed", "", "check.x")], 1, "c1")
        other = [{**row[0], "commit": "c2"}]
        with tempfile.TemporaryDirectory() as folder:
            log = Path(folder) / "some" / "asked.jsonl"
            self.assertEqual(read_asked("c1", log), [])
            log_asked(row, log)
            log_asked(other, log)
            with log.open("a") as file:
                file.write('{"room": "refer')
            self.assertEqual(read_asked("c1", log), row)

    def test_what_notices_a_survivor_later_leaves_its_score(self) -> None:
        rows = rows_of("reference", [Judgement(mutant("lost"), "SURVIVED")], 1, "c1")
        self.assertEqual(with_noticed(rows, [Judgement(mutant("x"), "SURVIVED")], "c2"), rows)
        rows = with_noticed(rows, [Judgement(mutant("lost"), "killed", "", "check.x")], "c2")
        self.assertEqual((rows[0]["noticed_by"], rows[0]["noticed_at"]), ("check.x", "c2"))
        row = samples_of(rows, set())[0].scores[0]
        self.assertEqual((row.killed, row.survived, row.noticed_since), (0, 1, 1))

    def test_a_recorded_line_is_found_where_it_stands_today(self) -> None:
        text = "a;\n  b;\nc;\n    b;\n"
        self.assertEqual(nearest_line(text, "b;", 5), (4, 15))
        self.assertEqual(nearest_line(text, "b;", 1), (2, 5))
        self.assertIsNone(nearest_line(text, "d;", 1))

    def test_a_record_is_read_as_it_was_written(self) -> None:
        rows = rows_of("reference", [Judgement(mutant("a < \"b\""), "killed")], 1, "c")
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "mutants.json"
            self.assertEqual(read_rows(path), [])
            write_record(rows, path)
            self.assertEqual(read_rows(path), rows)

    def test_the_interval_of_a_score_is_wilsons(self) -> None:
        # the roots of (p - share)^2 = z^2 p (1 - p) / n
        for hits, of in ((0, 10), (9, 10), (57, 60)):
            for end in score_interval(hits, of):
                if 0 < end < 1:
                    wanted = 1.959964**2 * end * (1 - end) / of
                    self.assertAlmostEqual((end - hits / of) ** 2, wanted, places=12)
        self.assertEqual(score_interval(0, 0), (None, None))

    def test_the_shipped_record_is_of_files_of_the_project(self) -> None:
        rows = read_rows(RECORD)
        for row in rows:
            self.assertTrue((ROOT / row["file"]).is_file(), row["file"])
            self.assertTrue(row["file"].startswith(row["room"]), row)
            self.assertIn(row["outcome"], ("killed", "SURVIVED", "equivalent"))
        keys = {(row["file"], row["before"], row["after"], row["commit"]) for row in rows}
        self.assertEqual(len(keys), len(rows))


if __name__ == "__main__":
    unittest.main()
