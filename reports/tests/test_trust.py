"""Tests of what a report shows beside its run: coverage, variants, other machines; run with
reports/tests/test_reports.py."""
from __future__ import annotations

import json
from typing import Any
from unittest import mock

import h5py

from data.mutation_scores import Score, load_mutation_page
from tests.made_up_run import HOSTILE, put, put_run
from tests.report_test import ReportTest


class Beside(ReportTest):
    """Files of other scripts beside a run."""

    def setUp(self) -> None:
        super().setUp()
        put_run(self.root)

    def put(self, name: str, said: dict[str, Any]) -> None:
        (self.root / f"{name}.json").write_text(json.dumps(said))

    def assert_shown(self, section: str, *words: str) -> None:
        """These words, and no text of a file that has become a tag."""
        self.assert_all_in((*words, "&lt;script&gt;alert"), section)
        self.assertNotIn("<script>alert", section)

    def test_coverage_variants_and_machines_are_shown_where_they_are(self) -> None:
        self.assertNotRegex(self.made(), 'id="(coverage|variants|machines)"')
        row = {"lines": 40, "lines_reached": 36, "branches": 10, "branches_taken": 5}
        file = {**row, "file": "reference/" + HOSTILE, "lines_missed": [3, 4, 5, 9]}
        self.put("coverage",
                 {"commit": "abc", "ran": "checks", "least": 95.0, "total": row, "files": [file]})
        runs = [
            {"variant": "clang", "options": ["check"], "findings": 7, "false_alarms": []},
            {
                "variant": "seeds", "options": ["check", "--seed", "3"], "findings": 5,
                "false_alarms": [{"name": HOSTILE}]
            },
        ]
        self.put("variants", {"commit": "abc", "runs": runs})
        apart = [{"case": HOSTILE, "seconds": 0.1, "apart": 3e-14, "bound": 2e-13},
                 {"case": "fast", "seconds": 0.0125, "apart": 0.5, "bound": 0.25},
                 {"case": "tangle", "seconds": 0.1, "apart": 0.5, "bound": None}]
        rows = [{"machine": "old-libm", "cases": 7, "apart": apart},
                {"machine": "aarch64", "cases": 7, "apart": []}]
        self.put("machines", {"seconds": 0.1, "commit": "abc", "machines": rows})
        self.assert_shown(self.section("coverage"), "90.0 % of 40 lines", "3–5, 9")
        self.assert_shown(
            self.section("variants"), "<code>foldproof check --seed 3</code>",
            "2 runs with 12 findings (commit abc), 1 of which did not hold"
        )
        self.assert_shown(self.section("machines"), "4 of 7", "7 of 7", "1 of 14 is further apart")

    def test_random_slips_are_shown_with_those_that_nothing_notices(self) -> None:
        folder = {"folder": "reference/forces", "noticed": 2, "missed": 2, "noticed_since": 1,
                  "equivalent": 1}
        samples = [{"commit": "old", "date": "2026-01-01",
                    "folders": [{**folder, "noticed": 1, "missed": 0}]},
                   {"commit": "abc", "date": "2026-02-01", "folders": [folder]}]
        edit = {"file": "a.cpp", "line": 7, "before": "a < b", "after": HOSTILE}
        scores, reasons, asked = (
            self.root / name for name in ("scores.json", "reasons.txt", "asked.json")
        )
        scores.write_text(json.dumps({"samples": samples, "open": [edit]}))
        reasons.write_text("# first lines\n\na.cpp\n  they are never equal\n- a «<¦<=» b\n")
        asked.write_text(json.dumps({"mutants": [{**edit, "outcome": "SURVIVED"},
                                                 {**edit, "outcome": "killed"}]}))
        with mock.patch("pages.trust.load_mutation_page",
                        lambda: load_mutation_page(scores, reasons, asked)):
            section = self.section("mutants")
        newest = ("2", "2", "1", "1", "50.0 %", "15 to 85 %")
        self.assert_shown(
            section, "".join(f'<td class="num">{cell}</td>' for cell in newest),
            '<td>2026-01-01</td><td><code>old</code></td><td class="num">1</td>'
            '<td class="num">0</td><td class="num">100.0 %</td>', "a.cpp:7",
            "1 edits have a reason", "2 such edits, drawn at random from",
            "1 was noticed, and no longer has a reason"
        )

    def test_sets_of_planted_slips_have_scores_with_intervals(self) -> None:
        sets = [Score(HOSTILE, 9, 1, 0, 0), Score("b", 0, 0, 0, 0)]
        with mock.patch("pages.trust.load_planted_sets", lambda: sets):
            section = self.section("planted")
        cells = ("9", "1", "90.0 %", "60 to 98 %")
        self.assert_shown(
            section, "".join(f'<td class="num">{cell}</td>' for cell in cells),
            "and repeated none"
        )

    def test_a_law_is_repeated_by_its_whole_trial(self) -> None:
        with h5py.File(self.root / "run.h5", "a") as file:
            put(file, command="build/foldproof judge --solver 'cmd'", subject="another")
        text = self.made()
        self.assertIn("build/foldproof judge --solver &#39;cmd&#39;", text)
        self.assertNotIn("foldproof check", text)
