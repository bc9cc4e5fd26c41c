#!/usr/bin/python3
"""Tests of scripts/record_needs and scripts/record_errors, in a small repository of their own."""
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
    "scripts/record_needs", "scripts/record_errors", "scripts/case_records.py",
    "reports/data/case_digest.py", "reports/data/unreadable.py", "reports/data/whole_file.py"
)
DATES = [f"2026-01-0{day}T00:00:00Z" for day in range(1, 5)]


class Recorded(unittest.TestCase):
    """Recording of made-up answers, and refused input."""
    script, record_file = "record_needs", "needs.json"

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
        self.program = {"version": "1", "commit": self.git("rev-parse", "HEAD"), "cpu": "c"}

    def git(self, *words: str) -> str:
        return subprocess.run(["git", "-C", str(self.root), *words], capture_output=True, text=True,
                              check=True).stdout.strip()

    def put(self, name: str, said: dict[str, Any], date: str = DATES[1],
            tree: str = "clean") -> str:
        """A file of the program's."""
        program = self.program | {"date": date, "tree": tree, "command": "x"}
        (self.root / name).write_text(json.dumps({"program": program} | said))
        return str(self.root / name)

    def needs(self, name: str, *cases: str, date: str = DATES[1], tree: str = "clean",
              **of_row: Any) -> str:
        """As `foldproof ablate` writes it."""
        row = {"overrides": [], "wrong": "", "parts": [{"of": date}]} | of_row
        return self.put(name, {"cases": [{"case": case} | row for case in cases]}, date, tree)

    def record(self, *files: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, "-B", str(self.root / "scripts" / self.script), *files],
            capture_output=True, text=True, check=False)

    def assert_new(self, new: int, of: int, *files: str) -> None:
        ran = self.record(*files)
        told = f"{new} of {of} cases are new in cases/{self.record_file}\n"
        self.assertEqual((ran.returncode, ran.stdout), (0, told), ran.stderr)

    def recorded(self) -> dict[str, dict[str, Any]]:
        rows = json.loads((self.root / "cases" / self.record_file).read_text())["cases"]
        return {row["case"]: row for row in rows}

    def assert_refused(self, reasons: dict[str, str]) -> None:
        """By file; none writes anything."""
        (self.root / "text.json").write_text("fold")
        (self.root / "rows.json").write_text('{"program": {}}')
        for name, why in (reasons | {
            "no.json": "there is no such file", "dirty.json": "not committed",
            "set.json": "with --set cloth.width=2", "cape.json": "cape is not a shipped case",
            "text.json": "JSONDecodeError", "rows.json": "KeyError"
        }).items():
            with self.subTest(file=name):
                ran = self.record(str(self.root / name))
                self.assertEqual((ran.returncode, ran.stdout), (2, ""))
                self.assertRegex(ran.stderr, f"^{self.script}: .*{why}.*\n$")
        self.assertFalse((self.root / "cases" / self.record_file).exists())


class Needs(Recorded):
    def test_the_later_answer_counts_with_its_program_and_the_digest_of_the_scene(self) -> None:
        late = self.needs("late.json", "fold", date=DATES[2])
        early = self.needs("early.json", "fold", "bag", date=DATES[0])
        self.assert_new(2, 2, late, early)
        self.assert_new(0, 2, early)
        found = self.recorded()
        self.assertEqual([found[name]["program"] for name in ("fold", "bag")],
                         [self.program | {"date": date} for date in (DATES[2], DATES[0])])
        self.assertRegex(found["fold"]["digest"], "^[0-9a-f]{16}$")
        # an answer of an earlier form of the case keeps the digest of that form
        (self.root / "cases/fold.toml").write_text('title = "fold"\n[cloth]\nwidth = 2\n')
        self.assert_new(1, 2, self.needs("b.json", "fold", date=DATES[3]))
        self.assertEqual(self.recorded()["fold"]["digest"], found["fold"]["digest"])

    def test_what_is_no_answer_of_a_shipped_case_is_refused_and_nothing_written(self) -> None:
        self.needs("dirty.json", "fold", tree="dirty")
        self.needs("set.json", "fold", overrides=["cloth.width=2"])
        self.needs("wrong.json", "fold", wrong="it stops")
        self.needs("cape.json", "cape")
        self.assert_refused({"wrong.json": "it stops"})
        self.assert_new(1, 1, self.needs("a.json", "fold", overrides=["ablation.until=2"]))


class Errors(Recorded):
    script, record_file = "record_errors", "errors.json"

    def ladder(self, name: str, case: str, date: str = DATES[1], tree: str = "clean",
               **others: Any) -> str:
        """As `converge --json` writes it."""
        quantity = {
            "name": "height", "unit": "m", "values": [3.0, 4.0, 4.5], "differences": [1.0, 0.5],
            "orders": [1.0], "order": 1.0, "reading": "asymptotic", "because": "", "limit": 5.0,
            "safety_factor": 3, "error_bar": 0.5, "error_as_it_is": 2.0, "error_of_steps": None
        }
        twins = {"horizon": 1.5, "growth_rate": 3.0, "in_words": "beyond 1.5 s", "times": [0, 1]}
        said = {
            "case": case, "in": "time", "method": "C", "mean_step": [4e-3, 2e-3, 1e-3], "end": 2.0,
            "asked_end": 2.0, "overrides": [], "seconds": [1.0, 2.0, 4.0],
            "stopped": ["", "", "it stops"], "predictability": twins,
            "quantities": [quantity | {"name": "positions", "values": []}, quantity]
        }
        return self.put(name, said | others, date, tree)

    def precision(self, name: str, case: str, **others: Any) -> str:
        """As `precision --json` writes it."""
        row = {"method": "RK4", "applications": 10.0, "seconds": 0.5, "step": 1e-3, "tied": False}
        methods = [row, row | {"method": "C", "tied": True},
                   row | {"method": "A", "applications": None, "tied": True}]
        said = {
            "case": case, "end": 2.0, "asked_end": 2.0, "overrides": [],
            "truth": {"good_down_to": 1e-3}, "prices": [
                {"error": 0.01, "methods": methods}, {"error": 0.001, "methods": methods[2:]}
            ]
        }
        return self.put(name, said | others)

    def test_orders_and_bars_are_kept_and_the_curves_are_not(self) -> None:
        self.assert_new(1, 1, self.ladder("a.json", "fold"))
        row = self.recorded()["fold"]
        for key, value in {
            "horizon": 1.5, "growth_rate": 3.0, "method": "C", "seconds": 7.0,
            "stopped": {"2": "it stops"}, "program": self.program | {"date": DATES[1]}
        }.items():
            self.assertEqual(row[key], value)
        positions, height = row["quantities"]
        self.assertEqual((positions["value"], positions["finest"]), (None, None))
        for key, value in {"value": 3.0, "finest": 4.5, "order": 1.0, "error_bar": 0.5,
                           "error_as_it_is": 2.0, "reading": "asymptotic"}.items():
            self.assertEqual(height[key], value)
        self.assertNotIn("differences", height)

    def test_the_later_answer_counts_and_keeps_the_prices(self) -> None:
        late = self.ladder("late.json", "fold", DATES[2])
        early = self.ladder("early.json", "fold", DATES[0])
        prices = self.precision("p.json", "fold")
        self.assert_new(1, 1, late, early, prices)
        self.assertEqual(self.recorded()["fold"]["program"]["date"], DATES[2])
        self.assert_new(0, 1, early)
        self.assert_new(1, 1, self.precision("again.json", "fold", prices=[]))
        self.assert_new(1, 1, prices)
        self.assert_new(1, 1, self.ladder("last.json", "fold", DATES[3], method="A"))
        row = self.recorded()["fold"]
        self.assertEqual((row["method"], row["precision"]["good_down_to"]), ("A", 1e-3))
        self.assertEqual(
            [(one["error"], one["method"], one["tied"]) for one in row["precision"]["cheapest"]],
            [(0.01, "RK4", ["C"]), (0.001, None, [])])

    def test_a_case_beyond_the_budget_gets_its_hours_until_it_is_asked(self) -> None:
        rows = [
            {"case": case, "run": {"seconds": seconds}, "end": 2.0, "asked_end": 1.0,
             "program": self.program | {"date": DATES[0]}, "digest": "0" * 16}
            for case, seconds in (("bag", 400.0), ("tent", 1.0))
        ]
        (self.root / "cases/needs.json").write_text(json.dumps({"cases": rows}))
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
        self.assert_refused({
            "space.json": "not one ladder in time", "both.json": "not one ladder in time",
            "alone.json": "whose errors no answer of converge tells"
        })


del Recorded  # only the two scripts are tested

if __name__ == "__main__":
    unittest.main()
