"""Tests of the page of two runs."""
from __future__ import annotations

import shutil
from math import inf

import h5py

from data.unreadable import Unreadable
from make_report import compare_runs
from pages.compare import Comparison, compare, read_side
from tests.made_up_run import NAMES, put, put_finding, put_run
from tests.report_test import FolderTest


class TwoRuns(FolderTest):
    """A made-up run, and a copy in which this and that differs."""

    def setUp(self) -> None:
        super().setUp()
        self.a, self.b = self.root / "a", self.root / "b"
        self.a.mkdir()
        put_run(self.a)
        shutil.copytree(self.a, self.b)
        self.change_b()

    def change_b(self) -> None:
        """Verdicts, rulings, margins, costs and names that B has otherwise."""
        with h5py.File(self.b / "run.h5", "r+") as file:
            put(file, subject="my <b>solver</b>", seconds=6.0)
            put(file[f"findings/{NAMES[0]}"], measured=6.4e-15)
            put(file[f"findings/{NAMES[2]}"], measured=3.2e-17, outcome="holds")
            put(file[f"findings/{NAMES[6]}"], bound=0.0)
            put(file[f"findings/{NAMES[4]}"], measured=1e7)
            put(file["claims/T17"], ruling="confirmed")
            put(file["studies/time-order"], seconds=0.5)
            del file[f"findings/{NAMES[3]}"]
            put_finding(file, 9, "mine.alone", "check")
        with h5py.File(self.b / "fold.h5", "r+") as file:
            file["diagnostics/cg_iterations"][:] = 2.0
        with h5py.File(self.a / "fold.h5", "r+") as file:
            file["diagnostics/cg_iterations"][:] = 1.0

    def compared(self) -> Comparison:
        """Detected differences."""
        return compare(read_side("A", self.a), read_side("B", self.b))

    def test_what_differs_is_found(self) -> None:
        found = self.compared()
        self.assertEqual([change.b.name for change in found.verdicts], [NAMES[2]])
        self.assertEqual([claim.name for claim, _ in found.rulings], ["T17"])
        self.assertEqual(
            [(change.b.name, round(change.factor, 9)) for change in found.margins],
            [(NAMES[2], 0.01), (NAMES[0], 2.0)],
        )
        self.assertEqual(found.unscaled, [])
        self.assertEqual([change.b.name for change in found.bounds], [NAMES[6]])
        self.assertEqual([finding.name for finding in found.only_a], [NAMES[3]])
        self.assertEqual([finding.name for finding in found.only_b], ["mine.alone"])
        self.assertEqual(found.unchanged, 3)

    def test_costs_that_differ_are_found(self) -> None:
        found = self.compared()
        self.assertEqual({cost.what: cost.factor for cost in found.seconds if cost.factor != 1.0},
                         {"the whole run": 2.0, "study time-order": 0.5})
        self.assertEqual(
            [(cost.what, cost.factor) for cost in found.work],
            [("case fold: iterations of conjugate gradients", 2.0), ("case fold: steps", 1.0)],
        )
        self.assertEqual([(cost.a, cost.b, cost.factor) for cost in found.rates], [(2e7, 1e7, 0.5)])

    def test_from_zero_comes_first(self) -> None:
        with h5py.File(self.a / "run.h5", "r+") as file:
            put(file[f"findings/{NAMES[7]}"], measured=0.0)
        self.assertEqual(
            (self.compared().margins[0].b.name, self.compared().margins[0].factor), (NAMES[7], inf)
        )

    def test_the_page_says_so_and_escapes(self) -> None:
        text = compare_runs(self.a, self.b / "run.h5", None).read_text(encoding="utf-8")
        self.assertTrue((self.b / "compare.html").is_file())
        self.assert_all_in(("my &lt;b&gt;solver&lt;/b&gt;", NAMES[0], NAMES[2], "mine.alone"), text)
        self.assert_none_in(("<script", "<img", "http:", "https:"), text)
        again = compare_runs(self.a, self.b / "run.h5", self.b / "again.html")
        self.assertEqual(again.read_text(encoding="utf-8"), text)

    def test_a_run_does_not_differ_from_itself(self) -> None:
        found = compare(read_side("A", self.a), read_side("B", self.a))
        self.assertFalse(
            found.verdicts or found.rulings or found.margins or found.only_a or found.only_b
        )
        text = compare_runs(self.a, self.a, None).read_text(encoding="utf-8")
        self.assertIn("has the same verdict in both", text)

    def test_what_is_no_run_is_refused(self) -> None:
        (self.b / "run.h5").write_bytes(b"no HDF5")
        for other, why in (
            (self.b, "no HDF5 file"), (self.a / "fold.h5", "no run of foldproof"),
            (self.a / "none", "no such file")
        ):
            with self.assertRaisesRegex(Unreadable, why):
                compare_runs(self.a, other, None)
        self.assert_refused(self.typed("make_report.py", self.a, self.b), "no HDF5 file")
