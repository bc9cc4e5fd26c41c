#!/usr/bin/python3
"""Tests of scripts/record_needs, in a small repository of their own:
scripts/tests/test_record_needs.py"""
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
    "scripts/record_needs", "scripts/case_records.py", "reports/data/case_digest.py",
    "reports/data/unreadable.py", "reports/data/whole_file.py"
)


class Recorded(unittest.TestCase):
    """Recording of made-up results, and refused input."""

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        for name in NEEDED:
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, self.root / name)
        (self.root / "cases").mkdir()
        for case in ("fold", "bag"):
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

    def answers(
        self, name: str, *cases: str, date: str = "2026-01-02T00:00:00Z", tree: str = "clean",
        **of_row: Any
    ) -> str:
        """A file as `foldproof ablate` writes it."""
        program = {"version": "1", "commit": self.commit, "date": date, "cpu": "c", "tree": tree}
        rows = [
            {"case": case, "overrides": [], "wrong": "", "parts": [{"of": date}]} | of_row
            for case in cases
        ]
        (self.root / name).write_text(json.dumps({"program": program, "cases": rows}))
        return str(self.root / name)

    def record(self, *files: str) -> subprocess.CompletedProcess[str]:
        """Runs it."""
        return subprocess.run(
            [sys.executable, "-B", str(self.root / "scripts/record_needs"), *files],
            capture_output=True, text=True, check=False
        )

    def recorded(self) -> dict[str, dict[str, Any]]:
        """The record."""
        return {
            row["case"]: row
            for row in json.loads((self.root / "cases/needs.json").read_text())["cases"]
        }

    def test_cases_are_kept_with_the_program_and_the_digest_of_the_scene(self) -> None:
        ran = self.record(self.answers("a.json", "fold"))
        self.assertEqual(
            (ran.returncode, ran.stdout), (0, "1 of 1 cases are new in cases/needs.json\n")
        )
        row = self.recorded()["fold"]
        self.assertEqual(
            row["program"],
            {"version": "1", "commit": self.commit, "date": "2026-01-02T00:00:00Z", "cpu": "c"},
        )
        self.assertRegex(row["digest"], "^[0-9a-f]{16}$")
        ran = self.record(self.answers("b.json", "bag", date="2026-01-01T00:00:00Z"))
        self.assertEqual(ran.stdout, "1 of 2 cases are new in cases/needs.json\n")
        self.assertEqual(self.recorded()["fold"], row)

    def test_the_later_answer_counts_whatever_the_order(self) -> None:
        late = self.answers("late.json", "fold", date="2026-01-03T00:00:00Z")
        early = self.answers("early.json", "fold", "bag", date="2026-01-01T00:00:00Z")
        self.assertEqual(
            self.record(late, early).stdout, "2 of 2 cases are new in cases/needs.json\n"
        )
        self.assertEqual(
            {name: row["program"]["date"][:10] for name, row in self.recorded().items()},
            {"fold": "2026-01-03", "bag": "2026-01-01"},
        )
        self.assertEqual(self.record(early).stdout, "0 of 2 cases are new in cases/needs.json\n")
        self.assertEqual(self.recorded()["fold"]["program"]["date"][:10], "2026-01-03")

    def test_what_is_no_answer_of_a_shipped_case_is_refused_and_nothing_written(self) -> None:
        assert_rejected = {
            "no.json": "there is no such file", "dirty.json": "not committed",
            "set.json": "with --set cloth.width=2", "wrong.json": "it stops",
            "cape.json": "cape is not a shipped case", "text.json": "JSONDecodeError",
            "rows.json": "KeyError"
        }
        self.answers("dirty.json", "fold", tree="dirty")
        self.answers("set.json", "fold", overrides=["cloth.width=2"])
        self.answers("wrong.json", "fold", wrong="it stops")
        self.answers("cape.json", "cape")
        (self.root / "text.json").write_text("fold")
        (self.root / "rows.json").write_text('{"program": {}}')
        for name, why in assert_rejected.items():
            with self.subTest(file=name):
                ran = self.record(str(self.root / name))
                self.assertEqual((ran.returncode, ran.stdout), (2, ""))
                self.assertRegex(ran.stderr, f"^record_needs: .*{why}.*\n$")
                if name != "cape.json":
                    self.assertIn(str(self.root / name), ran.stderr)
        self.assertFalse((self.root / "cases/needs.json").exists())
        self.assertEqual(
            self.record(self.answers("a.json", "fold", overrides=["ablation.until=2"])).returncode,
            0,
        )

    def test_an_answer_of_an_earlier_form_keeps_the_digest_of_that_form(self) -> None:
        self.assertEqual(self.record(self.answers("a.json", "fold")).returncode, 0)
        then = self.recorded()["fold"]["digest"]
        (self.root / "cases/fold.toml").write_text('title = "fold"\n[cloth]\nwidth = 2\n')
        self.assertEqual(
            self.record(self.answers("b.json", "fold", date="2026-01-04T00:00:00Z")).returncode, 0
        )
        self.assertEqual(self.recorded()["fold"]["digest"], then)


if __name__ == "__main__":
    unittest.main()
