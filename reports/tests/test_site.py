"""Tests of the report as a folder of pages, of methods' looks and of numbers as they are said; run
with reports/tests/test_reports.py."""
from __future__ import annotations

import re
import tempfile
import unittest
from dataclasses import replace
from pathlib import Path

import numpy as np

from data.results import Curve, load_run
from make_report import make_site
from pages.said import bound_html, measured_html
from plots.plot_style import COLOURS, MARKERS
from plots.study_plots import METHODS, choose_pens
from tests.made_up_run import NAMES, put_run
from tests.test_page import contrast

REPORTS = Path(__file__).resolve().parents[1]
LEAST_CONTRAST = 3.0       # of lines in plots, WCAG 2.1 level AA
MOST_BYTES = 3_000_000     # of a page


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        root = Path(folder.name)
        put_run(root)
        (root / "report").mkdir()
        (root / "report" / "old.html").write_text("of an earlier report")
        cls.index = make_site(root, root / "figures")
        cls.pages = {
            page.name: page.read_text(encoding="utf-8") for page in cls.index.parent.glob("*.html")
        }

    def test_every_topic_study_and_case_has_a_page(self) -> None:
        self.assertEqual(self.index.name, "index.html")
        for name in (
            "claims", "checks", "studies", "study-time-order", "cases", "case-fold", "faults",
            "provenance"
        ):
            self.assertIn(f"{name}.html", self.pages)
            self.assertIn(f'href="{name}.html"', self.pages["index.html"])
        self.assertNotIn("old.html", self.pages)
        self.assertIn(f'id="{NAMES[0]}"', self.pages["checks.html"])

    def test_no_link_is_broken(self) -> None:
        ids = {name: set(re.findall(r'\sid="([^"]+)"', text)) for name, text in self.pages.items()}
        for name, text in self.pages.items():
            for file, anchor in re.findall(r'<a [^>]*?href="([^"#]*)#?([^"]*)"', text):
                self.assertIn(file or name, self.pages)
                self.assertTrue(
                    not anchor or anchor in ids[file or name], f"{name}: {file}#{anchor}"
                )

    def test_a_page_is_whole_and_small(self) -> None:
        for name, text in self.pages.items():
            self.assertLessEqual(len(text.encode("utf-8")), MOST_BYTES, name)
            self.assertNotRegex(text, r"<!--(page|end)")
            for tag in ("html", "body", "main", "h1", "section", "details"):
                self.assertEqual(
                    len(re.findall(rf"<{tag}\b", text)), text.count(f"</{tag}>"), f"{name}: {tag}"
                )
            self.assertEqual(text.count("<h1"), 1, name)
            self.assertEqual(re.findall(r'(?:src|href)="(?:https?:)?//', text), [])


class Looks(unittest.TestCase):
    def test_methods_differ_by_colour_and_by_marker(self) -> None:
        x = np.array([1.0, 2.0, 3.0])
        curves = [
            Curve(name, x, x ** (k + 1), float("nan"), None, float("nan"), None)
            for k, name in enumerate(METHODS)
        ]
        pens = choose_pens(curves)
        self.assertEqual(len({pen.colour for pen in pens}), len(METHODS))
        self.assertEqual(len({pen.marker for pen in pens}), len(METHODS))
        alone = choose_pens(
            [replace(curves[4], label="RK2, grows"), replace(curves[1], label="scheme B")]
        )
        self.assertEqual(
            [(pen.colour, pen.marker) for pen in alone],
            [(COLOURS[4], MARKERS[4]), (COLOURS[1], MARKERS[1])],
        )

    def test_curves_stand_out_from_the_paper(self) -> None:
        text = (REPORTS / "pages" / "style.css").read_text(encoding="utf-8")
        for block in re.findall(r":root \{(.*?)\}", text, re.S)[:2]:
            palette = dict(re.findall(r"--([\w-]+): (#[0-9a-f]{6})", block))
            for k in range(len(COLOURS)):
                self.assertGreaterEqual(
                    contrast(palette[f"plot-{k}"], palette["paper"]), LEAST_CONTRAST, k
                )


class Said(unittest.TestCase):
    def test_what_must_reach_a_number_is_said_so(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            put_run(Path(folder))
            finding = load_run(Path(folder) / "run.h5").findings[0]
        short = replace(finding, measured=-10.0, bound=0.0, unit="points short of 60")
        self.assertEqual(re.sub("<[^>]+>", "", measured_html(short)), "70\u2009points")
        self.assertEqual(re.sub("<[^>]+>", "", bound_html(short)), "at least 60")
        self.assertEqual(re.sub("<[^>]+>", "", bound_html(replace(finding, bound=0.5))), "0.5")
