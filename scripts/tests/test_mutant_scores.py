#!/usr/bin/python3
"""Tests of the scores of mutants: which mutants they count, and which are asked again."""
from __future__ import annotations

import tempfile
import unittest
from pathlib import Path

from script_module import ROOT
from edits import Change
from mutant_scores import (
    edit_of, log_asked, nearest_line, not_asked, open_mutants, read_asked, rows_of, with_answers,
    with_sample
)
from mutant_trials import Judgement, Mutant, read_explained
from data.mutation_scores import (
    EXPLAINED_ASKED, Scores, read_answers, read_scores, score_interval
)


def mutant(after: str) -> Mutant:
    return Mutant("reference/a.cpp", 0, Change(0, 1, "b", "operator"), 3, "a + b", after)


class Explained(unittest.TestCase):
    def test_edits_that_were_asked_are_not_asked_again(self) -> None:
        first = not_asked([], 1)[:3]
        judged = [Judgement(one, outcome, "", "check.x")
                  for one, outcome in zip(first, ("killed", "SURVIVED", "ERROR"))]
        answers = with_answers([], judged, "c")
        self.assertEqual([row["outcome"] for row in answers], ["killed", "SURVIVED"])
        left = {(one.file, one.before, one.after) for one in not_asked(answers, 2)}
        self.assertEqual([(one.file, one.before, one.after) in left for one in first],
                         [False, False, True])
        self.assertEqual(len(left), len(not_asked([], 1)) - 2)

    def test_an_explained_edit_stands_where_its_line_does(self) -> None:
        for one in not_asked([], 3)[:50]:
            text = (ROOT / one.file).read_text(encoding="utf-8")
            self.assertEqual(edit_of(0, one.file, one.before, one.after).line, one.line)
            self.assertEqual(text.splitlines()[one.line - 1].strip(), one.before)
            self.assertTrue(text[one.change.at:].startswith(one.before))

    def test_no_edit_that_was_noticed_still_has_a_reason(self) -> None:
        explained = read_explained()
        for row in read_answers(EXPLAINED_ASKED):
            if row["outcome"] == "killed":
                self.assertNotIn((row["file"], row["before"], row["after"]), explained)


KILLED, LOST = Judgement(mutant("a - b"), "killed", "", "check.x"), mutant("lost")


class TheScores(unittest.TestCase):
    def sample(self, folder: str, judged: list[Judgement], commit: str = "c1" * 20) -> list[dict]:
        return rows_of(folder, judged, 1, commit)

    def test_explained_mutants_and_those_without_code_are_in_no_score(self) -> None:
        judged = [Judgement(mutant(text), "killed", "", "check.x") for text in "abcdefgh"]
        judged += [Judgement(LOST, "SURVIVED"), Judgement(mutant("equal"), "SURVIVED"),
                   Judgement(mutant("none"), "same code")]
        equal = {("reference/a.cpp", "a + b", "equal")}
        found = with_sample(Scores(), self.sample("reference/forces", judged), equal)
        score = found.samples[0].all
        self.assertEqual((score.noticed, score.missed, score.equivalent), (8, 1, 1))
        self.assertAlmostEqual(score.ratio, 8 / 9)
        self.assertLess(score.interval[0], 0.6)  # nine mutants say little
        self.assertEqual([row["after"] for row in found.open], ["lost"])

    def test_the_log_is_read_but_for_a_torn_line_each_mutant_as_first_found(self) -> None:
        row = self.sample("reference", [Judgement(LOST, "SURVIVED")], "c1")
        with tempfile.TemporaryDirectory() as folder:
            log = Path(folder) / "some" / "asked.jsonl"
            self.assertEqual(read_asked("c1", log), [])
            log_asked(row + [{**row[0], "outcome": "killed"}], log)
            log_asked([{**row[0], "commit": "c2"}], log)
            with log.open("a") as file:
                file.write('{"folder": "refer')
            self.assertEqual(read_asked("c1", log), row)

    def test_a_recorded_line_is_found_where_it_stands_today(self) -> None:
        text = "a;\n  b;\nc;\n    b;\n"
        self.assertEqual(nearest_line(text, "b;", 5), (4, 15))
        self.assertEqual(nearest_line(text, "b;", 1), (2, 5))
        self.assertIsNone(nearest_line(text, "d;", 1))

    def test_the_interval_of_a_score_is_wilsons(self) -> None:
        # the roots of (p - ratio)^2 = z^2 p (1 - p) / n
        for hits, of in ((0, 10), (9, 10), (57, 60)):
            for end in score_interval(hits, of):
                if 0 < end < 1:
                    wanted = 1.959964**2 * end * (1 - end) / of
                    self.assertAlmostEqual((end - hits / of) ** 2, wanted, places=12)
        self.assertEqual(score_interval(0, 0), (None, None))

    def test_shipped_open_mutants_are_edits_of_the_files_of_today(self) -> None:
        scores = read_scores()
        self.assertEqual(len(open_mutants(scores.open)), len(scores.open))


if __name__ == "__main__":
    unittest.main()
