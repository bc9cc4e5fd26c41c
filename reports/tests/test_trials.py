"""Tests of the page of judged solvers, on two made-up ones."""
from __future__ import annotations

import json
import re
from math import isnan, nan
from pathlib import Path
from typing import Any

import h5py

from data.trials import Trial, facts_of_file, is_trial, read_trial
from data.unreadable import Unreadable
from make_report import compare_trials, make_summary
from pages.portraits import portraits_of
from pages.trials import render_trials, trials_of
from tests.made_up_run import put, put_finding
from tests.report_test import FolderTest, ReportTest

HOSTILE = "<script>alert(1)</script>"


def finding(name: str, outcome: str, measured: float | None, note: str = "") -> dict[str, Any]:
    return {
        "name": name, "claim": f"Claim of {name}.", "source": "Newton", "outcome": outcome,
        "measured": measured, "bound": 0.5, "unit": "m", "why_bound": "rounding", "note": note
    }


def evidence(law: str, **columns: tuple[str, list[Any]]) -> dict[str, Any]:
    """Columns with their units; blanks of the names are written as underscores."""
    return {
        "law": law,
        "columns": [
            {"name": name.replace("_", " "), "unit": unit, "values": values}
            for name, (unit, values) in columns.items()
        ],
    }


def put_trial(folder: Path, subject: str, findings: list[dict[str, Any]], **about: Any) -> Path:
    folder.mkdir(exist_ok=True)
    program = {
        "subject": subject, "date": "2026-11-26", "version": "0.2.0", "commit": "c",
        "tree": "clean", "cpu": "a processor", "command": "foldproof judge ..."
    }
    facts = {
        "version": "3.1", "level": "L1", "precision": "f4", "scheme": "Euler", "order": 0,
        "capabilities": [], "solve_tolerance": 0.0, "command": "./adapter",
        "settings": {"iterations": "20"}, "mapping": {"stretch": HOSTILE},
        "calibration": [evidence(
            "calibration.modulus", along=("", ["x", HOSTILE]), modulus=("N/m", [4.75, None])
        )],
        "cost": [evidence(
            "one", steps=("1", [20, 40]), seconds_by_the_clock=("s", [0.001, 0.0023]),
            error=("motion", [0.0177, None])
        )],
    }
    (folder / "verdicts.json").write_text(
        json.dumps({"program": program | about, "findings": findings})
    )
    (folder / "solver.json").write_text(json.dumps(facts))
    return folder


def put_judged_run(folder: Path, findings: list[dict[str, Any]], **about: Any) -> None:
    """The folder of one judged solver, as `foldproof judge --out` writes it."""
    put_trial(folder, "mine", findings)
    program = json.loads((folder / "verdicts.json").read_text())["program"]
    with h5py.File(folder / "run.h5", "w") as file:
        put(file, **program, subject_version="3.1", tier="quick", **about)
        for order, row in enumerate(findings):
            row = {key: nan if value is None else value for key, value in row.items()}
            if isnan(row["measured"]):
                row |= {"bound": nan, "uncertainty": nan, "why_bound": ""}
            put_finding(file, order, row.pop("name"), "check", **row, faults=[])


class OneSolver(ReportTest):
    """The report of one judged solver."""

    findings = [
        finding("smoke.one", "holds", 0.25),
        finding("smoke.two", "fails", 2e4),
        finding("smoke.three", "fails", None, "stopped by an error: crashed"),
        finding("ball.four", "not applicable", None, "the subject does not offer capability 'b'"),
        finding("ball.five", "did not run", None, "the trial ended during smoke.three"),
    ]

    def setUp(self) -> None:
        super().setUp()
        put_judged_run(self.root, self.findings)

    def test_it_begins_with_the_solver_and_names_foldproof_as_such(self) -> None:
        text = self.made()
        head = text[text.index("<header>"):text.index("</header>")]
        self.assert_all_in(
            (
                "<h1>mine 3.1 on trial</h1>", "<dt>scheme</dt><dd>Euler, no order claimed</dd>",
                "<dt>settings</dt><dd>iterations=20</dd>", "<dt>capabilities</dt><dd>none</dd>",
                "<dt>judged by</dt><dd>foldproof 0.2.0, its commit c clean</dd>",
                "<dt>mapping of stretch</dt><dd>&lt;script&gt;",
            ), head
        )
        self.assert_none_in(
            ("Bridson", "quick", "seeded", "Seeded", "commit</dt>", "earlier run"), head
        )
        self.assertNotIn(HOSTILE, text)
        margins = re.search(r'<table class="margins">.*?</table>', text, re.DOTALL)[0]
        self.assertIn("smoke.one", margins)
        self.assertNotIn("smoke.two", margins)  # only a law that holds has a margin
        self.assertNotIn("NaN", text)
        self.assertEqual((text.count("no number"), text.count("<dt>Rule</dt>")), (1, 2))

    def test_what_was_judged_is_counted_apart_from_what_was_not(self) -> None:
        self.assert_all_in(
            (
                "1 of 3 judged laws hold, 2 fail; 1 does not apply; 1 did not run. Look first at"
                " smoke.two and smoke.three.",
                "does not offer capability &#39;b&#39;: ball.four.",
                "the trial ended during smoke.three: ball.five."
            ), re.sub(r"<[^>]+>", "", self.made())
        )

    def test_it_shows_what_was_measured_and_lines_of_a_failure(self) -> None:
        put_judged_run(self.root, [
            {**finding("smoke.one", "holds", 0.25), "headline": "observed 1.02, claimed 1"},
            finding("smoke.two", "fails", None, "its last words:\n    one\n    two"),
        ])
        self.assert_all_in(
            (
                '<span class="headline">observed 1.02, claimed 1</span>',
                '<p class="note lines">its last words:\n    one\n    two</p>'
            ), self.made()
        )

    def test_a_law_is_repeated_alone_with_the_options_that_were_typed(self) -> None:
        command = "foldproof judge --solver ./adapter --settings iterations=20"
        self.assertIn(f"{command} smoke.two<", self.made())
        facts = json.loads((self.root / "solver.json").read_text())
        facts["options"] = ["--seconds", "7.5"]
        (self.root / "solver.json").write_text(json.dumps(facts))
        self.assertIn(f"{command} --seconds 7.5 smoke.one</code>", self.made())

    def test_a_later_run_in_the_folder_is_not_the_solver_s(self) -> None:
        with h5py.File(self.root / "run.h5", "a") as file:
            put(file, date="2027-01-01", subject="foldproof reference")
        self.assertIn("<h1>What was found</h1>", self.made())

    def test_its_summary_says_the_same(self) -> None:
        markdown = make_summary(self.root, None)[1].read_text(encoding="utf-8")
        self.assert_all_in(
            (
                "**1 of 3 judged laws hold", "- solver: mine 3.1", "- settings: iterations=20",
                "## Not judged, and why"
            ), markdown
        )
        self.assert_none_in(("Seeded", "- commit", "- tier", "earlier"), markdown)


class JudgedSolvers(FolderTest):
    def setUp(self) -> None:
        super().setUp()
        declined = "the subject does not offer level L2"
        self.a = put_trial(self.root / "a", "mine", [
            finding("one", "holds", 0.25), finding("two", "fails", 3.5),
            finding("four", "not applicable", None, declined),
            finding("five", "not applicable", None, declined)
        ])
        self.others = [
            finding("one", "fails", None, "stopped by an error: crashed"),
            finding("three", "inconclusive", 0.5),
        ]
        self.b = put_trial(self.root / "b", "mine", self.others)

    def rendered(self, *folders: Path) -> str:
        return render_trials(trials_of([read_trial(folder) for folder in folders]), self.root)

    def test_laws_are_matched_by_name(self) -> None:
        said = trials_of([read_trial(self.a), read_trial(self.b)])
        names = [row.law.name for row in said.rows]
        self.assertEqual(names, ["one", "two", "four", "five", "three"])
        outcomes = [[answer and answer.outcome for answer in row.answers] for row in said.rows[:2]]
        self.assertEqual(outcomes, [["holds", "fails"], ["fails", None]])
        self.assertEqual(said.labels, [f"mine ({self.a})", f"mine ({self.b})"])
        differences = [(law.name, answer.outcome) for law, _, answer in said.differences]
        self.assertEqual(
            differences, [("one", "fails"), ("two", "fails"), ("three", "inconclusive")]
        )
        [reason] = said.reasons.values()
        self.assertEqual((reason.number, reason.why), (1, "does not offer level L2"))
        self.assertEqual(reason.laws, {f"mine ({self.a})": ["four", "five"]})
        groups = [[row.law.name for row in rows] for _, rows in said.groups]
        self.assertEqual(groups, [["one", "two", "three"], ["four", "five"]])

    def test_the_page_shows_numbers_reasons_settings_and_versions(self) -> None:
        text = self.rendered(self.a, self.b)
        self.assert_all_in(
            (
                "2 solvers on trial", "3.5", "at most", "does not offer level L2",
                "iterations</b> 20", "3.1", "stopped by an error: crashed", "order not claimed",
                "not run", "calibration.modulus", "modulus [N/m]", "4.75"
            ), text
        )
        self.assertNotIn(HOSTILE, text)

    def test_the_json_has_what_the_page_has(self) -> None:
        out = compare_trials([self.a, self.b], None)
        self.assertEqual(out, self.b / "compare.html")
        said = json.loads(out.with_suffix(".json").read_text(encoding="utf-8"))
        first = [law["answers"][0] and law["answers"][0]["measured"] for law in said["laws"]]
        self.assertEqual(first, [0.25, 3.5, None, None, None])
        costs = [(row["has_limit"], row["error"]) for row in said["error_against_cost"]]
        self.assertEqual(costs, [(True, 0.0177), (True, None), (False, 0.0177), (False, None)])
        self.assertEqual(said["solvers"][1]["settings"], {"iterations": "20"})
        self.assertEqual(
            said["solvers"][0]["counts"],
            {"holds": 1, "fails": 1, "inconclusive": 0, "not applicable": 2},
        )

    def test_error_against_cost_is_drawn_where_its_law_holds(self) -> None:
        text = self.rendered(self.a, self.b)
        section = text[text.index('<section id="cost">') : text.index('<section id="calibration">')]
        for kind in ("plot", "key"):
            self.assertEqual(section.count(f'<svg class="{kind}"'), 1)
        self.assert_all_in(
            (
                f"No curve, since the law that measures it does not hold: mine ({self.b}).",
                "1 point not drawn", "0.0177"
            ), section
        )
        self.assertNotIn("different processors", section)
        self.assertTrue((self.root / "error-against-cost.svg").is_file())
        put_trial(self.b, "mine", self.others, cpu="another processor")
        self.assertIn("on different processors: compare no seconds", self.rendered(self.a, self.b))
        alone = self.rendered(self.b)
        self.assertIn("No solver has an error to show", alone)
        self.assertNotIn('<svg class="plot"', alone)

    def test_what_is_no_trial_is_refused_by_its_file(self) -> None:
        self.assertFalse(is_trial(self.root))
        for name in ("solver.json", "verdicts.json"):
            kept = (self.a / name).read_text(encoding="utf-8")
            for text in ("", "[]", '{"program": {}}'):
                (self.a / name).write_text(text, encoding="utf-8")
                with self.assertRaisesRegex(Unreadable, name):
                    read_trial(self.a)
            (self.a / name).write_text(kept, encoding="utf-8")


class PortraitsTest(FolderTest):
    """Pictures of one scene in several solvers."""

    @staticmethod
    def sheet(height: float) -> dict[str, Any]:
        """Of two triangles, so high above the ball's middle."""
        x = [[0, 0, height], [0.3, 0, height], [0.3, 0.3, height], [0, 0.3, height]]
        return {"about": "A sheet.", "x": x, "triangles": [[0, 1, 2], [0, 2, 3]],
                "centre": [0.1, 0.1, 0], "radius": 0.25}

    @staticmethod
    def trials(*portraits: dict[str, Any] | None) -> list[Trial]:
        return [Trial("folder", "subject", {"portrait": one}, {}, [], {}) for one in portraits]

    def test_a_file_of_facts_keeps_its_portrait(self) -> None:
        path = put_trial(self.root, "mine", []) / "solver.json"
        facts = json.loads(path.read_text())
        for portrait in (self.sheet(0.25), {"why_none": "no balls"}, None):
            path.write_text(json.dumps(facts | {"portrait": portrait}), encoding="utf-8")
            self.assertEqual(facts_of_file(path)["portrait"], portrait)

    def test_what_has_no_picture_says_why(self) -> None:
        none = {"why_none": "it has no balls"}
        trials = self.trials(self.sheet(0.25), none, None, self.sheet(-9), self.sheet(0.1))
        said = portraits_of(trials, list("abcde"))
        self.assertEqual(said.about, "A sheet.")
        self.assertEqual([bool(one.uri) for one in said.all], [True, False, False, False, True])
        self.assertTrue(said.all[0].uri.startswith("data:image/webp;base64,"))
        for one, words in zip(said.all, (
            "lowest point 0.000 m below the ball's top", "it has no balls",
            "not asked: only some laws were", "the sheet is not at the ball", "mm deep in the ball"
        )):
            self.assertIn(words, one.words)
        self.assertIsNone(portraits_of(self.trials(None, none), ["a", "b"]))
