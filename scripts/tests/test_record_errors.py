#!/usr/bin/python3
"""Tests of scripts/record_errors, in a small repository of their own:
scripts/tests/test_record_errors.py"""
from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
NEEDED = (
    "scripts/record_errors", "scripts/case_records.py", "reports/data/case_digest.py",
    "reports/data/unreadable.py", "reports/data/whole_file.py"
)


class Recorded(unittest.TestCase):
    """Recording of made-up answers, and refused input."""

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        for name in NEEDED:
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, self.root / name)
        (self.root / "cases").mkdir()
        for case in ("fold", "bag", "tent"):
            (self.root / f"cases/{case}.toml").write_text(f'title = "{case}"\n[cloth]\nwidth = 1\n')
        self.git("init", "-q")
        self.git("add", ".")
        self.git("-c", "user.name=a", "-c", "user.email=a@b", "commit", "-q", "-m", "all")
        self.commit = self.git("rev-parse", "HEAD")

    def git(self, *words: str) -> str:
        """The output."""
        return subprocess.run(
            ["git", "-C", str(self.root), *words], capture_output=True, text=True, check=True
        ).stdout.strip()

    def put(
        self, name: str, said: dict[str, Any], date: str = "2026-01-02T00:00:00Z",
        tree: str = "clean"
    ) -> str:
        """A file of the program's."""
        program = {
            "version": "1", "commit": self.commit, "date": date, "cpu": "c", "tree": tree,
            "command": "x"
        }
        (self.root / name).write_text(
            json.dumps({"end": 2.0, "asked_end": 2.0, "overrides": [], "program": program} | said)
        )
        return str(self.root / name)

    def ladder(
        self, name: str, case: str, date: str = "2026-01-02T00:00:00Z", tree: str = "clean",
        **others: Any
    ) -> str:
        """As `converge --json` writes it."""
        quantity = {
            "name": "height", "unit": "m", "values": [3.0, 4.0, 4.5], "differences": [1.0, 0.5],
            "orders": [1.0], "order": 1.0, "reading": "asymptotic", "because": "", "limit": 5.0,
            "safety_factor": 3, "error_bar": 0.5, "error_as_it_is": 2.0, "error_of_steps": None
        }
        twins = {"horizon": 1.5, "growth_rate": 3.0, "in_words": "beyond 1.5 s", "times": [0, 1]}
        said = {
            "case": case, "in": "time", "method": "C", "mean_step": [4e-3, 2e-3, 1e-3],
            "seconds": [1.0, 2.0, 4.0], "stopped": ["", "", "it stops"],
            "quantities": [quantity | {"name": "positions", "values": []}, quantity],
            "predictability": twins
        }
        return self.put(name, said | others, date, tree)

    def precision(self, name: str, case: str, **others: Any) -> str:
        """As `precision --json` writes it."""
        row = {"method": "RK4", "applications": 10.0, "seconds": 0.5, "step": 1e-3, "tied": False}
        methods = [
            row, row | {"method": "C", "tied": True},
            row | {"method": "A", "applications": None, "tied": True}
        ]
        said = {
            "case": case,
            "truth": {"good_down_to": 1e-3},
            "prices": [
                {"error": 0.01, "methods": methods},
                {"error": 0.001, "methods": methods[2:]},
            ],
        }
        return self.put(name, said | others)

    def record(self, *files: str) -> subprocess.CompletedProcess[str]:
        """Runs it."""
        return subprocess.run(
            [sys.executable, "-B", str(self.root / "scripts/record_errors"), *files],
            capture_output=True, text=True, check=False
        )

    def recorded(self) -> dict[str, dict[str, Any]]:
        """The record."""
        return {
            row["case"]: row
            for row in json.loads((self.root / "cases/errors.json").read_text())["cases"]
        }

    def test_orders_and_bars_are_kept_and_the_curves_are_not(self) -> None:
        ran = self.record(self.ladder("a.json", "fold"))
        self.assertEqual(
            (ran.returncode, ran.stdout), (0, "1 of 1 cases are new in cases/errors.json\n")
        )
        row = self.recorded()["fold"]
        self.assertEqual(
            (row["horizon"], row["growth_rate"], row["method"], row["seconds"], row["stopped"]),
            (1.5, 3.0, "C", 7.0, {"2": "it stops"}),
        )
        self.assertEqual(
            row["program"],
            {"version": "1", "commit": self.commit, "date": "2026-01-02T00:00:00Z", "cpu": "c"},
        )
        self.assertRegex(row["digest"], "^[0-9a-f]{16}$")
        positions, height = row["quantities"]
        self.assertEqual(
            (positions["value"], positions["finest"], height["value"], height["finest"]),
            (None, None, 3.0, 4.5),
        )
        self.assertEqual(
            (height["order"], height["error_bar"], height["error_as_it_is"], height["reading"]),
            (1.0, 0.5, 2.0, "asymptotic"),
        )
        self.assertNotIn("differences", height)

    def test_the_later_answer_counts_and_keeps_the_prices(self) -> None:
        late, early = self.ladder("late.json", "fold", "2026-01-03T00:00:00Z"), self.ladder(
            "early.json", "fold", "2026-01-01T00:00:00Z"
        )
        self.assertEqual(self.record(late, early, self.precision("p.json", "fold")).returncode, 0)
        self.assertEqual(self.recorded()["fold"]["program"]["date"][:10], "2026-01-03")
        self.assertEqual(self.record(early).stdout, "0 of 1 cases are new in cases/errors.json\n")
        self.assertEqual(
            self.record(self.precision("again.json", "fold", prices=[])).stdout,
            "1 of 1 cases are new in cases/errors.json\n",
        )
        self.assertEqual(
            self.record(self.precision("p.json", "fold")).stdout,
            "1 of 1 cases are new in cases/errors.json\n",
        )
        self.assertEqual(
            self.record(
                self.ladder("last.json", "fold", "2026-01-04T00:00:00Z", method="A")
            ).returncode,
            0,
        )
        row = self.recorded()["fold"]
        self.assertEqual((row["method"], row["precision"]["good_down_to"]), ("A", 1e-3))
        self.assertEqual(
            [(one["error"], one["method"], one["tied"]) for one in row["precision"]["cheapest"]],
            [(0.01, "RK4", ["C"]), (0.001, None, [])],
        )

    def test_a_case_beyond_the_budget_gets_its_hours_until_it_is_asked(self) -> None:
        program = {
            "version": "1", "commit": self.commit, "date": "2026-01-01T00:00:00Z", "cpu": "c"
        }
        needs = [
            {
                "case": case, "run": {"seconds": seconds}, "end": 2.0, "asked_end": 1.0,
                "program": program, "digest": "0" * 16
            }
            for case, seconds in (("bag", 400.0), ("tent", 1.0))
        ]
        (self.root / "cases/needs.json").write_text(json.dumps({"cases": needs}))
        self.assertEqual(self.record(self.ladder("a.json", "fold")).returncode, 0)
        # a tent takes 18 s: it is to be asked
        self.assertEqual(set(self.recorded()), {"fold", "bag"})
        self.assertAlmostEqual(self.recorded()["bag"]["not_asked_hours"], 9 * 2 * 400 / 3600)
        self.assertEqual(self.record(self.ladder("b.json", "bag")).returncode, 0)
        self.assertIn("quantities", self.recorded()["bag"])

    def test_what_is_no_answer_of_a_shipped_case_is_refused_and_nothing_written(self) -> None:
        self.ladder("dirty.json", "fold", tree="dirty")
        self.ladder("set.json", "fold", overrides=["cloth.width=2"])
        self.ladder("cape.json", "cape")
        self.ladder("space.json", "fold", **{"in": "space"})
        self.put("both.json", {"case": "fold", "ladders": []})
        self.precision("alone.json", "fold")
        (self.root / "text.json").write_text("fold")
        (self.root / "rows.json").write_text('{"program": {}}')
        for name, why in {
            "no.json": "there is no such file", "dirty.json": "not committed",
            "set.json": "with --set cloth.width=2", "cape.json": "cape is not a shipped case",
            "space.json": "not one ladder in time", "both.json": "not one ladder in time",
            "alone.json": "whose errors no answer of converge tells",
            "text.json": "JSONDecodeError", "rows.json": "KeyError"
        }.items():
            with self.subTest(file=name):
                ran = self.record(str(self.root / name))
                self.assertEqual((ran.returncode, ran.stdout), (2, ""))
                self.assertRegex(ran.stderr, f"^record_errors: .*{why}.*\n$")
        self.assertFalse((self.root / "cases/errors.json").exists())


if __name__ == "__main__":
    unittest.main()
