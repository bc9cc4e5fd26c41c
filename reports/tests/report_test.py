"""What tests of a report share: a folder, the report that is made of it, commands as a user types
them."""
from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
import unittest
from collections.abc import Iterable
from pathlib import Path
from unittest import mock

from data.results import CaseEntry, load_case
from data.unreadable import Unreadable
from make_report import SHIPPED_CASES, make_report
from pages.page import CaseView

REPORTS = Path(__file__).resolve().parents[1]


class FolderTest(unittest.TestCase):
    """A test with a folder `root` of its own."""

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)

    def assert_all_in(self, parts: Iterable[str], text: str) -> None:
        for part in parts:
            self.assertIn(part, text)

    def assert_none_in(self, parts: Iterable[str], text: str) -> None:
        for part in parts:
            self.assertNotIn(part, text)

    def typed(
        self, script: str, *words: object, **environment: str
    ) -> subprocess.CompletedProcess[str]:
        """What a script of this folder does."""
        return subprocess.run(
            [sys.executable, str(REPORTS / script), *map(str, words)], text=True, check=False,
            capture_output=True, env=os.environ | environment
        )

    def assert_refused(self, run: subprocess.CompletedProcess[str], why: str) -> None:
        """In one line, which says why."""
        self.assertEqual((run.returncode, len(run.stderr.splitlines())), (2, 1), run.stderr)
        self.assertIn(why, run.stderr)


def without_pictures(entry: CaseEntry, _: Path, __: int) -> CaseView:
    """In place of pages.drawing.draw_case, which takes seconds: the case as it was read."""
    view = CaseView(entry, f"case-{entry.name}")
    try:
        view.case = load_case(entry.path)
    except Unreadable as error:
        view.problem = str(error)
    return view


class ReportTest(FolderTest):
    """A test of the folder's report, whose cases are not drawn; their records lie in `shipped`."""

    shipped = SHIPPED_CASES

    def made(self) -> str:
        """The text of the folder's report."""
        out, figures = self.root / "report.html", self.root / "figures"
        with mock.patch("pages.drawing.draw_case", without_pictures):
            make_report(self.root, out, figures, shipped=self.shipped)
        return out.read_text(encoding="utf-8")

    def section(self, name: str) -> str:
        """The text of a section of the report; "" if there is none."""
        found = re.search(rf'<section id="{name}">.*?</section>', self.made(), re.DOTALL)
        return found[0] if found else ""
