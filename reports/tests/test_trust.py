"""Tests of what a report shows beside its run: coverage, variants, other machines; run with
reports/tests/test_reports.py."""
from __future__ import annotations

import json
from unittest import mock

import h5py

from data.mutation_scores import load_mutation_page
from tests.made_up_run import HOSTILE, put, put_run
from tests.report_test import ReportTest


class Beside(ReportTest):
    """Files of other scripts beside a run."""

    def read(self, text: str) -> None:
        """No text of a file has become a tag."""
        self.assertIn("&lt;script&gt;alert", text)
        self.assertNotIn("<script>alert", text)

    def test_coverage_is_shown_with_the_lines_that_never_ran(self) -> None:
        put_run(self.root)
        self.assertNotIn('id="coverage"', self.made())
        row = {"lines": 40, "lines_reached": 36, "branches": 10, "branches_taken": 5}
        file = {**row, "file": "reference/" + HOSTILE, "lines_missed": [3, 4, 5, 9]}
        told = {"commit": "abc", "ran": "checks", "least": 95.0, "total": row, "files": [file]}
        (self.root / "coverage.json").write_text(json.dumps(told))
        text = self.made()
        self.assertIn("90.0 % of 40 lines", text)
        self.assertIn("3–5, 9", text)
        self.read(text)

    def test_random_slips_are_shown_with_those_that_nothing_notices(self) -> None:
        put_run(self.root)
        folder = {"folder": "reference/forces", "noticed": 2, "missed": 2, "noticed_since": 1,
                  "equivalent": 1}
        samples = [{"commit": "old", "date": "2026-01-01",
                    "folders": [{**folder, "noticed": 1, "missed": 0}]},
                   {"commit": "abc", "date": "2026-02-01", "folders": [folder]}]
        edit = {"file": "a.cpp", "line": 7, "before": "a < b", "after": HOSTILE}
        scores, reasons = self.root / "scores.json", self.root / "reasons.txt"
        scores.write_text(json.dumps({"samples": samples, "open": [edit]}))
        reasons.write_text("# first lines\n\na.cpp\n  they are never equal\n- a < b\n+ a <= b\n")
        asked = self.root / "asked.json"
        asked.write_text(json.dumps({"mutants": [{**edit, "outcome": "SURVIVED"},
                                                 {**edit, "outcome": "killed"}]}))
        with mock.patch("make_report.load_mutation_page",
                        lambda: load_mutation_page(scores, reasons, asked)):
            text = self.made()
        section = text[text.index('id="mutants"'):]
        self.assertIn('<td class="num">2</td><td class="num">2</td><td class="num">1</td>'
                      '<td class="num">1</td><td class="num">50.0 %</td>'
                      '<td class="num">15 to 85 %</td>', section)
        self.assertIn('<td>2026-01-01</td><td><code>old</code></td><td class="num">1</td>'
                      '<td class="num">0</td><td class="num">100.0 %</td>', section)
        for words in ("a.cpp:7", "1 edits have a reason", "2 such edits, drawn at random from",
                      "1 was noticed, and no longer has a reason"):
            self.assertIn(words, section)
        self.read(section)

    def test_variants_are_shown_with_their_false_alarms(self) -> None:
        put_run(self.root)
        self.assertNotIn('id="variants"', self.made())
        runs = [
            {"variant": "clang", "options": ["check"], "findings": 7, "false_alarms": []},
            {
                "variant": "seeds", "options": ["check", "--seed", "3"], "findings": 5,
                "false_alarms": [{"name": HOSTILE}]
            },
        ]
        (self.root / "variants.json").write_text(json.dumps({"commit": "abc", "runs": runs}))
        text = self.made()
        self.assertIn("2 runs with 12 findings (commit abc), 1 of which did not hold", text)
        self.assertIn("<code>foldproof check --seed 3</code>", text)
        self.read(text)

    def test_machines_are_shown_with_the_cases_that_are_apart(self) -> None:
        put_run(self.root)
        self.assertNotIn('id="machines"', self.made())
        apart = [{"case": HOSTILE, "seconds": 0.1, "apart": 3e-14, "bound": 2e-13},
                 {"case": "fast", "seconds": 0.0125, "apart": 0.5, "bound": 0.25},
                 {"case": "tangle", "seconds": 0.1, "apart": 0.5, "bound": None}]
        rows = [{"machine": "old-libm", "cases": 7, "apart": apart},
                {"machine": "aarch64", "cases": 7, "apart": []}]
        told = {"seconds": 0.1, "commit": "abc", "machines": rows}
        (self.root / "machines.json").write_text(json.dumps(told))
        text = self.made()
        section = text[text.index('id="machines"'):]
        self.assertIn("4 of 7", section)
        self.assertIn("7 of 7", section)
        self.assertIn("1 of 14 is further apart", section)
        self.read(text)

    def test_a_law_is_repeated_by_its_whole_trial(self) -> None:
        put_run(self.root)
        with h5py.File(self.root / "run.h5", "a") as file:
            put(file, command="build/foldproof judge --solver 'cmd'", subject="another")
        text = self.made()
        self.assertIn("build/foldproof judge --solver &#39;cmd&#39;", text)
        self.assertNotIn("foldproof check", text)
