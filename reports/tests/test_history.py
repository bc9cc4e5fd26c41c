"""Tests of the history of runs."""
from __future__ import annotations

import contextlib
import io
import json
from pathlib import Path
from typing import Any
from unittest import mock

import make_history
from data.history import append_to_log, changes, in_order, margin_changes, read_log, row_of
from data.unreadable import Unreadable
from pages.history import as_json, history_of, render_history
from tests.report_test import FolderTest


def finding(
    name: str, outcome: str = "holds", measured: float | None = 1.0, bound: float = 10.0
) -> dict[str, Any]:
    """A row of verdicts.json."""
    return {
        "name": name, "kind": "check", "outcome": outcome, "measured": measured, "bound": bound,
        "seconds": 0.1
    }


def claim(name: str, ruling: str) -> dict[str, Any]:
    """A ruled claim of verdicts.json."""
    return {
        "name": f"claim.{name}", "id": name, "kind": "claim", "outcome": "holds", "ruling": ruling
    }


class HistoryTest(FolderTest):
    """Runs that are made up, one a day."""

    def put(self, day: int, rows: list[dict[str, Any]], **about: str) -> Path:
        """The folder of a run."""
        folder = self.root / str(day)
        folder.mkdir(exist_ok=True)
        program = {
            "date": f"2026-01-{day:02}T00:00:00Z", "commit": f"{day:040x}", "version": "0.2.0",
            "tier": "quick", "subject": "mine <b>", "cpu": "a", "command": "foldproof verify"
        } | about
        (folder / "verdicts.json").write_text(
            json.dumps({"schema": 1, "program": program, "findings": rows})
        )
        return folder

    def found(self, *runs: Path) -> list[tuple[int, str, str, str, bool]]:
        """Day, name, before, after, worse of each change."""
        return [
            (int(one.run.about["date"][8:10]), one.name, one.before, one.after, one.is_regression)
            for one in changes(in_order([row_of(run) for run in runs]))
        ]

    def answer(self, *words: object) -> tuple[int, str]:
        """Exit code and text of the command."""
        said = io.StringIO()
        with mock.patch(
            "sys.argv", ["make_history.py", *map(str, words)]
        ), contextlib.redirect_stdout(said):
            return make_history.main(), said.getvalue()

    def test_the_first_run_of_each_change_is_named(self) -> None:
        runs = [self.put(1, [finding("a"), finding("b", "fails"), claim("T1", "confirmed")]),
                self.put(2, [finding("a"), finding("b"), claim("T1", "confirmed")]),
                self.put(3, [finding("a", "inconclusive"), finding("b"), claim("T1", "refuted")]),
                self.put(4, [finding("a", "inconclusive"), finding("aa"), claim("T1", "refuted")])]
        self.assertEqual(
            self.found(*reversed(runs)),
            [
                (2, "b", "fails", "holds", False), (3, "a", "holds", "inconclusive", True),
                (3, "T1", "confirmed", "refuted", True), (4, "b", "holds", "", True),
                (4, "aa", "", "holds", False)
            ],
        )

    def test_only_what_both_runs_were_asked_is_compared(self) -> None:
        whole = self.put(1, [finding("a"), finding("b")])
        for about, changed in (
            ({"command": "foldproof check a"}, [(2, "a", "holds", "fails", True)]),
            ({"tier": "full"}, []), ({"subject": "another"}, [])
        ):
            other = self.put(2, [finding("a", "fails")], **about)
            self.assertEqual(self.found(whole, other), changed)

    def test_margins_that_shrink_are_listed(self) -> None:
        rows = [
            row_of(self.put(day, [finding(name, measured=x) for name, x in zip("abc", measured)]))
            for day, measured in ((1, (1.0, 1.0, 1e-9)), (2, (1.9, 4.0, 3e-9)))
        ]
        self.assertEqual(
            [(one.name, one.before, one.after) for one in margin_changes(rows)], [("b", 0.1, 0.4)]
        )

    def test_a_log_grows_by_a_row_a_run_and_survives_a_torn_end(self) -> None:
        log = self.root / "log.jsonl"
        rows = [row_of(self.put(day, [finding("a", measured=None)])) for day in (1, 2)]
        self.assertEqual(
            [append_to_log(log, rows[:1]), append_to_log(log, rows[:1]), append_to_log(log, rows)],
            [1, 0, 1],
        )
        with log.open("a") as file:
            file.write('{"date": "2026-01-03')
        self.assertEqual([row.key for row in read_log(log)], [row.key for row in rows])
        append_to_log(log, [row_of(self.put(3, [finding("a")]))])
        self.assertEqual([row.about["date"][8:10] for row in read_log(log)], ["01", "02", "03"])
        log.write_text("no row\n" + log.read_text())
        with self.assertRaisesRegex(Unreadable, "log.jsonl:1: no row of a history"):
            read_log(log)

    def test_exit_code_and_words(self) -> None:
        runs = [
            self.put(1, [finding("a")]), self.put(2, [finding("a", "fails")]),
            self.put(3, [finding("a", "fails")])
        ]
        code, text = self.answer(*runs[:2])
        self.assertEqual(code, 1)
        self.assertIn("WORSE 2026-01-02 00:00 0000000  a: holds -> fails", text)
        self.assertEqual(self.answer(*runs)[0], 0)  # it was so before
        self.assertEqual(json.loads(self.answer(*runs, "--json")[1])["changes"][0]["worse"], True)

    def test_bad_input_is_one_line(self) -> None:
        self.put(1, [])
        (self.root / "2").write_text("{")
        for words, why in (
            ([], "give folders of runs"), ([self.root / "1"], "no findings in it"),
            ([self.root / "2"], "no verdicts of foldproof"), ([self.root / "3"], "no such"),
            (["--log", self.root / "none"], "there is no run in it yet")
        ):
            said = io.StringIO()
            with contextlib.redirect_stderr(said), self.assertRaises(SystemExit) as stop:
                self.answer(*words)
            self.assertEqual(stop.exception.code, 2)
            self.assertRegex(said.getvalue(), rf"^make_history: .*{why}.*\n$")
        self.assertFalse((self.root / "none").exists())

    def test_the_page_escapes_and_says_what_is_worse(self) -> None:
        history = history_of(
            [row_of(self.put(1, [finding("a")])), row_of(self.put(2, [finding("a", "fails")]))]
        )
        page = render_history(history)
        self.assertIn("mine &lt;b&gt;", page)
        self.assertIn("<strong>The newest run is worse in 1 place.</strong>", page)
        self.assertEqual(json.loads(as_json(history))["runs"][1]["counts"], {"fails": 1})
