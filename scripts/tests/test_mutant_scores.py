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
    with_noticed, with_sample, write_answers, write_scores
)
from mutant_trials import Judgement, Mutant, read_explained
from data.mutation_scores import (
    EXPLAINED_ASKED, Scores, parts_of, read_answers, read_scores, score_interval
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

    def test_a_sample_replaces_that_of_its_commit_alone(self) -> None:
        missed = self.sample("reference/x", [Judgement(LOST, "SURVIVED")])
        other = self.sample("verification/y", [KILLED], "c2" * 20)
        scores = with_sample(with_sample(Scores(), missed, set()), other, set())
        again = with_sample(scores, self.sample("reference/x", [KILLED]), set())
        self.assertEqual([one.all.noticed for one in scores.samples], [0, 1])
        self.assertEqual([one.all.noticed for one in again.samples], [1, 1])
        self.assertEqual((len(scores.open), len(again.open)), (1, 0))

    def test_a_mutant_noticed_later_stays_missed_in_its_sample(self) -> None:
        rows = self.sample("reference/x", [Judgement(LOST, "SURVIVED"), KILLED])
        scores = with_sample(Scores(), rows, set())
        asked = LOST._replace(number=0)
        self.assertEqual(with_noticed(scores, [Judgement(asked, "SURVIVED")]), scores)
        later = with_noticed(scores, [Judgement(asked, "killed", "", "check.x")])
        score = later.samples[0].all
        self.assertEqual((score.noticed, score.missed, score.noticed_since), (1, 1, 1))
        self.assertEqual(later.open, [])

    def test_the_method_and_the_code_that_judges_it_have_parts_of_their_own(self) -> None:
        scores = Scores()
        for folder, commit in (("reference/x", "c1"), ("verification/y", "c2"),
                               ("reference/x", "c3")):
            scores = with_sample(scores, self.sample(folder, [KILLED], commit), set())
        method, judges = parts_of(scores.samples)
        self.assertEqual((method.newest.commit, [one.commit for one in method.earlier]),
                         ("c3", ["c1"]))
        self.assertEqual((judges.newest.commit, judges.earlier), ("c2", []))
        self.assertEqual(len(parts_of(scores.samples[1:2])), 1)

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

    def test_scores_and_answers_are_read_as_they_were_written(self) -> None:
        survived = Judgement(mutant("a < \"b\""), "SURVIVED")
        scores = with_sample(Scores(), self.sample("reference", [survived, KILLED]), set())
        answers = with_answers([], [survived], "c")
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "written.json"
            self.assertEqual((read_scores(path), read_answers(path)), (Scores(), []))
            write_scores(scores, path)
            self.assertEqual(read_scores(path), scores)
            write_answers(answers, path)
            self.assertEqual(read_answers(path), answers)

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
