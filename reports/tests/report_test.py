"""What tests of a report share: a folder, and the report that is made of it."""
from __future__ import annotations

import tempfile
import unittest
from pathlib import Path

from make_report import SHIPPED_CASES, make_report


class ReportTest(unittest.TestCase):
    """A test with a folder `root` of its own; records of cases lie in `shipped`."""

    shipped = SHIPPED_CASES

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)

    def made(self) -> str:
        """The text of the folder's report."""
        page = make_report(
            self.root, self.root / "report.html", self.root / "figures", shipped=self.shipped
        )
        return page.read_text(encoding="utf-8")
