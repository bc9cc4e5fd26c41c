"""Tests of what the report says of the errors of shipped cases, and of their
record. Run by test_reports.py."""
from __future__ import annotations

import json
import re
import tomllib
import unittest
from math import isnan
from typing import Any

from data.case_digest import case_digest, case_files
from data.unreadable import Unreadable
from make_report import SHIPPED_CASES
from pages.errors import CaseErrors, QuantityError, load_errors
from tests.made_up_run import put_case, put_run
from tests.report_test import ReportTest

CASE = b'title = "a"\n[expect.it_stands]\nat_least = 1\nwhy = "b"\n'
PROGRAM = {"version": "1", "commit": "fedcba9876543210", "date": "2026-01-01T00:00:00Z", "cpu": "c"}
MOST_HOURS_UNASKED = 600 / 3600  # a case that takes less must be asked


def answer(case: str, **others: Any) -> dict[str, Any]:
    """A row of the record, with positions and one quantity."""
    positions = {
        "name": "positions", "unit": "m", "order": 1.5, "reading": "not asymptotic",
        "because": "it <varies>", "error_bar": 2e-5, "error_as_it_is": 3e-4, "value": None,
        "finest": None
    }
    height = positions | {
        "name": "height <b>", "order": None, "reading": "inconclusive", "value": 0.25,
        "finest": 0.26
    }
    cheapest = [
        {
            "error": 0.01, "method": "RK4", "step": 0.002, "applications": 90, "seconds": 0.3,
            "tied": ["C"]
        },
        {
            "error": 0.001, "method": None, "step": None, "applications": None, "seconds": None,
            "tied": []
        },
    ]
    return {
        "case": case, "method": "C", "end": 3.0, "asked_end": 0.5,
        "mean_step": [0.004, 0.002, 0.001], "seconds": 7, "stopped": {"2": "it <stops>"},
        "horizon": 0.4, "growth_rate": 3.0, "predictable": "beyond t = 0.4 s only <statistics>",
        "quantities": [positions, height], "program": PROGRAM, "precision": {"cheapest": cheapest}
    } | others


class ErrorsShown(ReportTest):
    """The page of a run, with and without a record."""

    def setUp(self) -> None:
        super().setUp()
        self.shipped = self.root / "cases"
        self.shipped.mkdir()

    def record(self, *rows: dict[str, Any]) -> None:
        """Each with its case."""
        for row in rows:
            (self.shipped / f"{row['case']}.toml").write_bytes(CASE)
        digest = case_digest(f"{rows[0]['case']}.toml", lambda _: CASE)
        (self.shipped / "errors.json").write_text(
            json.dumps({"schema": 1, "cases": [row | {"digest": digest} for row in rows]})
        )

    def test_errors_are_shown_with_each_case_and_in_a_section(self) -> None:
        put_run(self.root)
        self.assertEqual(self.section("errors"), "")
        self.record(answer("fold"), {"case": "bag", "not_asked_hours": 4.5, "program": PROGRAM})
        text = self.made()
        self.assertRegex(
            text, r'<a href="#errors-of-fold">its step puts its positions off by [^\n]{0,80}\u2009'
        )
        self.assertNotIn("earlier version", text)
        shown = (
            "it &lt;varies&gt;", "height &lt;b&gt;", "only &lt;statistics&gt;",
            "Level 2 came to no end: it &lt;stops&gt;", "not measured: 4.5 hours",
            "fold, first 0.5 of 3 s", "(commit fedcba9876)", "(tied: C)", "cheapest for 1 %",
            "cheapest for 0.1 %"
        )
        self.assert_all_in(shown, re.sub("<[^>]*>", "", self.section("errors")))
        (self.shipped / "fold.toml").write_bytes(CASE.replace(b"1", b"2"))
        changed = (
            "Recorded of an earlier version of the case: fold.",
            "of an earlier version of the case</span>"
        )
        self.assert_all_in(changed, self.made())

    def test_simulations_of_a_user_show_no_errors_of_shipped_cases(self) -> None:
        self.record(answer("fold"))
        put_case(self.root, "fold")
        self.assertNotIn("fedcba9876", self.made())

    def test_a_record_of_another_make_is_refused_by_its_name(self) -> None:
        for text in ('{"cases": 1}', "{", '{"cases": [{"case": "fold"}]}'):
            (self.shipped / "errors.json").write_text(text)
            with self.subTest(text=text), self.assertRaisesRegex(Unreadable, "errors.json"):
                load_errors(self.shipped)

    def test_numbers_that_are_not_there_are_not_read_as_zero(self) -> None:
        self.record(answer("fold", horizon=None))
        case = load_errors(self.shipped).of("fold")
        for value in (
            case.horizon, case.positions.value, case.quantities[1].order, case.cheapest[1].step
        ):
            self.assertTrue(isnan(value))


def is_within_error(expected: dict[str, Any], found: QuantityError) -> bool:
    """True unless the value that steps of no length would give, within
    its error bar, keeps the bound."""
    if isnan(found.error_bar):
        return True
    if "at_most" in expected:
        return not found.finest + found.error_bar <= expected["at_most"]
    return not found.finest - found.error_bar >= expected["at_least"]


class Bounds(unittest.TestCase):
    """Bounds against error bars."""

    def test_a_bound_within_the_bar_is_noticed_on_either_side(self) -> None:
        def found(finest: float, bar: float) -> QuantityError:
            return QuantityError("q", "m", 0, finest, bar, 0, 0, "", "")

        for expected, finest, bar, within in (
            ({"at_most": 3}, 2, 0.5, False), ({"at_most": 3}, 2, 1.5, True),
            ({"at_most": 3}, 4, 0.5, True), ({"at_least": 3}, 4, 0.5, False),
            ({"at_least": 3}, 4, 1.5, True), ({"at_least": 3}, 2, 0.5, True),
            ({"at_most": 3}, 2, float("nan"), True), ({"at_least": 4}, 4, 0, False)
        ):
            with self.subTest(expected=expected, finest=finest, bar=bar):
                self.assertEqual(is_within_error(expected, found(finest, bar)), within)


class Record(unittest.TestCase):
    """The record of the shipped cases."""

    def setUp(self) -> None:
        self.found = load_errors(SHIPPED_CASES)

    def expectations(self, case: CaseErrors) -> dict[str, dict[str, Any]]:
        """What the case's file expects of its end, where the record was asked to the end."""
        file = SHIPPED_CASES / case_files(SHIPPED_CASES)[case.name]
        return (
            {}
            if case.part_of_time
            else tomllib.loads(file.read_text(encoding="utf-8")).get("expect", {})
        )

    def test_each_shipped_case_was_asked_as_it_is_or_says_how_long_that_takes(self) -> None:
        files = case_files(SHIPPED_CASES)
        self.assertEqual({case.name for case in self.found.cases}, set(files))
        for case in self.found.cases:
            ask = (
                f"build/foldproof converge cases/{files[case.name]} --json > FILE;"
                " scripts/record_errors FILE"
            )
            with self.subTest(case=case.name):
                self.assertFalse(
                    case.changed, f"the case is another scene than the one that was asked; {ask}"
                )
                if case.asked:
                    self.assertGreaterEqual(len(case.mean_step), 3)
                    self.assertEqual(case.positions.name, "positions")
                else:
                    self.assertGreater(case.not_asked_hours, MOST_HOURS_UNASKED, ask)

    def test_no_expectation_is_tighter_than_its_error_bar_without_a_reason(self) -> None:
        tight, excused = set(), set()
        for case in self.found.cases:
            by_name = {found.name: found for found in case.quantities}
            for key, expected in self.expectations(case).items():
                if "despite_error" in expected:
                    excused.add((case.name, key))
                if key in by_name and is_within_error(expected, by_name[key]):
                    tight.add((case.name, key))
        self.assertEqual(
            tight - excused, set(),
            "give the bound more room, or say in despite_error why it has none"
        )
        self.assertEqual(
            excused - tight, set(),
            "despite_error, though the error bar is narrower than the bound's room"
        )
