"""Tests of what the report says of the parts that scenes need, asked beside the run or recorded.
Run by test_reports.py."""
from __future__ import annotations

import json
import re
import tomllib
import unittest
from pathlib import Path
from typing import Any

import h5py

from data.case_digest import case_digest, case_files
from data.unreadable import Unreadable
from make_report import SHIPPED_CASES
from pages.needs import load_needs
from tests.made_up_run import put_case, put_run
from tests.report_test import ReportTest

CASE = b"""title = "a"
[cloth]
mesh = "m.obj"
[expect.it_stands]
at_least = 1
why = "b"
[ablation]
until = 2
"""


def told(case: str, commit: str) -> dict[str, Any]:
    """Output of `foldproof ablate` for one case."""
    run = {
        "seconds": 2.0, "steps": 40, "elastic_evaluations": 80, "cg_iterations": 0,
        "object_queries": 0, "strain_sweeps": 0, "crossing_queries": 0, "deepest": 0.0,
        "crossings": 0.0, "stopped": "", "failed": []
    }
    part = {
        "name": "gravity <b>", "present": True, "need": "not needed here",
        "because": "it moves <nothing>", "declared": "", "as_it_should_be": False,
        "position_difference": 3e-5, "energy_difference": None,
        "run": run | {"seconds": 1.0, "steps": 10}
    }
    own = {
        "time": 1e-4, "mesh": None, "floor": 1e-6, "value": 1e-4, "without_time": "",
        "without_mesh": "too many triangles", "coarser_mesh": ["cloth.rings=2"], "without_bar": 2e-5
    }
    return {
        "schema": 1,
        "program": {"commit": commit},
        "cases": [
            {
                "case": case, "overrides": ["time.end=1", "cloth.fit=2"], "asked_end": 0.5,
                "end": 3.0, "wrong": "it <stops>", "size": 1.0, "own_error": own, "run": run,
                "parts": [part, part | {"declared": "for <show>", "as_it_should_be": True}]
            }
        ],
    }


class NeedsShown(ReportTest):
    """The page of a run, with and without outcomes."""

    def setUp(self) -> None:
        super().setUp()
        self.shipped = self.root / "cases"
        self.shipped.mkdir()

    def put(self, outcomes: dict[str, Any]) -> None:
        """Beside the run."""
        (self.root / "ablation.json").write_text(json.dumps(outcomes))

    def record(self, case: str, commit: str) -> None:
        """With the case, as scripts/record_needs does."""
        (self.shipped / f"{case}.toml").write_bytes(CASE)
        (self.shipped / "m.obj").write_bytes(b"v 0 0 0")
        outcomes = told(case, commit)
        digest = case_digest(f"{case}.toml", lambda name: (self.shipped / name).read_bytes())
        kept = {"program": outcomes["program"], "digest": digest}
        (self.shipped / "needs.json").write_text(
            json.dumps({"schema": 1, "cases": [row | kept for row in outcomes["cases"]]})
        )

    def test_parts_are_shown_where_they_were_looked_for(self) -> None:
        put_run(self.root)
        self.assertIn("these results do not say", self.made())
        self.put(told("fold", "abcdef0123456789"))
        text, section = self.made(), self.section("needs")
        tally = "1 kept for a reason, 1 not needed here"
        self.assertIn(f'Its parts: <a href="#needs-of-fold">{tally}</a>', text)
        self.assert_all_in(
            (
                f"fold: {tally}", "gravity &lt;b&gt;", "it moves &lt;nothing&gt;",
                "1 part is not needed, and kept for a reason that the case gives. 1 part is not"
                " needed, without a reason.", "for &lt;show&gt;", "it &lt;stops&gt;",
                "coarser mesh: too many triangles", "Over the first 0.5 of 3 s: ",
                "With <code>--set time.end=1 --set cloth.fit=2</code>: ",
                "1 case was ablated beside this run (commit abcdef0123)"
            ), section
        )
        self.assert_none_in(("Not known which", "ecorded at commit", "needs.json"), text)
        self.assertEqual(section.count("verdict fails"), 2)
        marks = re.findall(r'aria-label="([a-z ]+)">(.)</span>', section)
        self.assertEqual(marks, [("not needed here", "\u2715"), ("kept for a reason", "\u25d0")])
        self.put(told("bag", "abcdef0123456789"))
        self.assertIn("Not known which of its parts it needs", self.made())

    def test_a_part_within_the_error_bar_is_undecided(self) -> None:
        put_run(self.root)
        outcomes = told("fold", "abcdef0123456789")
        row = outcomes["cases"][0]
        undecided = row["parts"][0] | {"need": "cannot tell", "as_it_should_be": True}
        row["parts"] = [undecided | {"declared": reason} for reason in ("", "for show")]
        self.put(outcomes)
        section = self.section("needs")
        self.assert_all_in(
            (
                "2 parts are undecided: the change is within the error bar.", "fold: 2 undecided",
                "with its error bar ("
            ), section
        )
        marks = re.findall(r'aria-label="([a-z ]+)">(.)</span>', section)
        self.assertEqual(marks, [("cannot tell", "?")] * 2)

    def test_what_is_recorded_is_shown_where_the_run_did_not_ask(self) -> None:
        put_run(self.root)
        self.record("fold", "fedcba9876543210")
        text = self.made()
        self.assert_all_in(
            (
                "For 1 case the results are those recorded in <code>cases/needs.json</code>,"
                " found by earlier versions of the program (commit fedcba9876)",
                "Recorded at commit fedcba9876",
                "</a>, found with <code>--set time.end=1 --set cloth.fit=2</code>, over its"
                " first 0.5 of 3 s, as recorded."
            ), text
        )
        self.assertNotIn("has changed since", text)
        (self.shipped / "m.obj").write_bytes(b"v 0 0 1")
        self.assert_all_in(
            (
                "the case has changed since", "of an earlier version of the case</span>",
                "Recorded for an earlier version of the case: fold."
            ), self.made()
        )
        with h5py.File(self.root / "run.h5", "a") as file:
            file.attrs["subject"] = "toy springs"
        self.assertEqual(self.section("needs"), "")  # of another solver

    def test_what_was_asked_beside_the_run_goes_before_what_is_recorded(self) -> None:
        self.record("fold", "fedcba9876543210")
        for case, found in (
            ("fold", [("fold", "abcdef0123456789", False)]),
            ("bag", [("bag", "abcdef0123456789", False), ("fold", "fedcba9876543210", True)]),
        ):
            self.put(told(case, "abcdef0123456789"))
            cases = load_needs(self.root / "ablation.json", self.shipped).cases
            self.assertEqual([(one.name, one.commit, one.recorded) for one in cases], found)

    def test_a_file_of_another_make_is_refused_by_its_name(self) -> None:
        put_run(self.root)
        for name, texts in {
            "ablation.json": ('{"cases": [{}]}', "[]", "{"), "coverage.json": ("{}", "3"),
            "variants.json": ("{}",), "machines.json": ("{}", "[2]"),
            "mutation.json": ("{}", "[1]"), "faults.json": ('{"faults": [3]}', "{}"),
            "verdicts.json": ('{"findings": [{}]}',), "cases/needs.json": ('{"cases": 1}',)
        }.items():
            for text in texts:
                (self.root / name).write_text(text)
                with self.subTest(file=name, text=text), self.assertRaisesRegex(
                    Unreadable, re.escape(str(self.root / name))
                ):
                    self.made()
            (self.root / name).unlink()

    def test_simulations_of_a_user_take_no_answers_of_shipped_cases(self) -> None:
        self.record("fold", "fedcba9876543210")
        put_case(self.root, "fold")
        self.assertNotIn("fedcba9876", self.made())


class Digests(unittest.TestCase):
    """Whether a case is the same scene."""

    def digest(self, case: bytes, mesh: bytes = b"v 0 0 0") -> str:
        """Of a case in a folder of its own."""
        return case_digest("hard/one.toml", {"hard/one.toml": case, "hard/m.obj": mesh}.__getitem__)

    def test_words_do_not_count_and_numbers_do(self) -> None:
        same = self.digest(CASE)
        for old, new in (
            (b'"a"', b'"other"'), (b'"b"', b'"other"'), (b"until = 2", b"until = 3"),
            (b"[cloth]", b"[cloth]  # of wool")
        ):
            self.assertEqual(self.digest(CASE.replace(old, new)), same)
        for old, new in (
            (b"at_least = 1", b"at_least = 2"), (b"it_stands", b"it_falls"),
            (b"[cloth]", b"[cloth]\nfit = 1.5")
        ):
            self.assertNotEqual(self.digest(CASE.replace(old, new)), same)
        self.assertNotEqual(self.digest(CASE, b"v 0 0 1"), same)
        with self.assertRaisesRegex(ValueError, "breathing"):
            self.digest(CASE + b'[[object]]\nframes = "breathing"\n')


class Record(unittest.TestCase):
    """Records of the shipped cases."""

    def test_each_shipped_case_was_asked_as_it_is_and_has_what_it_needs_and_nothing_else(
        self,
    ) -> None:
        found = load_needs(Path("none"), SHIPPED_CASES)
        self.assertEqual({case.name for case in found.cases}, set(case_files(SHIPPED_CASES)))
        for case in found.cases:
            ask = (
                f"build/foldproof ablate cases/{case_files(SHIPPED_CASES)[case.name]} --out DIR;"
                " scripts/record_needs DIR/ablation.json"
            )
            with self.subTest(case=case.name):
                self.assertFalse(
                    case.changed, f"the case is another scene than the one that was asked; {ask}"
                )
                self.assertEqual(case.wrong, "")
                self.assertEqual(
                    [typed for typed in case.overrides if not typed.startswith("ablation.")], []
                )
                wrong = [part.name for part in case.parts if not part.as_it_should_be]
                self.assertEqual(wrong, [], ask)
                self.assertTrue(case.parts)

    def test_reasons_and_what_was_asked_are_those_of_the_cases(self) -> None:
        files = case_files(SHIPPED_CASES)
        for row in json.loads((SHIPPED_CASES / "needs.json").read_text())["cases"]:
            case = tomllib.loads((SHIPPED_CASES / files[row["case"]]).read_text())
            said = case.get("ablation", {})
            with self.subTest(case=row["case"]):
                self.assertEqual(
                    {part["name"]: part["declared"] for part in row["parts"] if part["declared"]},
                    {
                        part: why
                        for part, why in said.items()
                        if part not in ("until", "coarser_mesh", "finer mesh")
                    },
                )
                asked = said.get("coarser_mesh", [])
                self.assertEqual(
                    row["own_error"].get("coarser_mesh") or [],
                    [asked] if isinstance(asked, str) else asked,
                )
                self.assertEqual(row["end"], case["time"]["end"])
                self.assertGreaterEqual(
                    row["asked_end"], min(said.get("until", row["end"]), row["end"])
                )
