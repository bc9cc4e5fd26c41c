"""Tests of the report as pages, of sections, of its four questions and of methods' looks; run with
reports/tests/test_reports.py."""
from __future__ import annotations

import os
import re
import tempfile
import unittest
from dataclasses import replace
from pathlib import Path
from unittest import mock

import h5py
import numpy as np
from markupsafe import Markup

from data.results import Finding, load_run
from data.studies import Curve, Study, StudyFigure
from make_report import make_pages
from pages.conclusions import Results
from pages.four_questions import FIGURES, four_questions
from pages.page import SECTIONS, StudyView
from pages.render import MOST_BYTES, TEMPLATES
from pages.said import bound_html, measured_html
from pages.section import Section
from pages.sentences import html_of
from plots.plot_style import COLOURS, MARKERS, Plot
from plots.study_plots import METHODS, choose_pens, key_svg, pens_of
from tests.made_up_run import NAMES, put_finding, put_run
from tests.report_test import FolderTest, without_pictures

MOST_BYTES_OF_A_PAGE = 3_000_000


def pages_of(root: Path) -> dict[str, str]:
    """The pages of a report, as if it were long."""
    with mock.patch("pages.render.MOST_BYTES", 100), mock.patch(
        "pages.drawing.draw_case", without_pictures
    ):
        make_pages(root, root / "figures")
    return {
        page.relative_to(root).as_posix(): page.read_text(encoding="utf-8")
        for page in (root / "report.html", *(root / "report").glob("*.html"))
    }


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        root = Path(folder.name)
        put_run(root)
        (root / "report").mkdir()
        (root / "report" / "old.html").write_text("of an earlier report")
        cls.pages = pages_of(root)
        with mock.patch("pages.render.MOST_BYTES", 1e9):  # with pictures
            cls.one_page = make_pages(root, root / "figures").read_text(encoding="utf-8")
        cls.left = list((root / "report").glob("*.html"))

    def test_every_topic_study_and_case_has_a_page(self) -> None:
        first = self.pages["report.html"]
        for name in ("claims", "checks", "study-time-order", "case-fold", "provenance"):
            self.assertIn(f"report/{name}.html", self.pages)
            self.assertIn(f'href="report/{name}.html"', first)
        self.assertNotIn("report/old.html", self.pages)
        self.assertIn(f'id="{NAMES[0]}"', self.pages["report/checks.html"])
        self.assertRegex(first, rf'"report/checks.html": \[[^]]*"{re.escape(NAMES[0])}"')

    def test_a_short_report_is_one_page(self) -> None:
        self.assertTrue(f'id="{NAMES[0]}"' in self.one_page)
        self.assertNotRegex(self.one_page, r"<!--(page|end)")
        self.assertEqual(self.one_page.count("open-view\" }"), 1)  # its views can be opened
        self.assertEqual(self.left, [])

    def test_no_link_is_broken(self) -> None:
        ids = {name: set(re.findall(r'\sid="([^"]+)"', text)) for name, text in self.pages.items()}
        for name, text in self.pages.items():
            for file, anchor in re.findall(r'<a [^>]*?href="([^"#]*)#?([^"]*)"', text):
                way = os.path.join(os.path.dirname(name), file)
                there = os.path.normpath(way) if file else name
                self.assertIn(there, self.pages)
                self.assertTrue(not anchor or anchor in ids[there], f"{name}: {file}#{anchor}")

    def test_a_page_is_whole_and_small(self) -> None:
        for name, text in self.pages.items():
            self.assertLessEqual(len(text.encode("utf-8")), MOST_BYTES_OF_A_PAGE, name)
            self.assertNotRegex(text, r"<!--(page|end)")
            for tag in ("html", "body", "main", "h1", "section", "details"):
                self.assertEqual(
                    len(re.findall(rf"<{tag}\b", text)), text.count(f"</{tag}>"), f"{name}: {tag}"
                )
            self.assertEqual(text.count("<h1"), 1, name)
            self.assertEqual(re.findall(r'(?:src|href)="(?:https?:)?//', text), [])


class Parts(FolderTest):
    def test_the_first_page_of_a_large_report_stays_small(self) -> None:
        """However much evidence there is: 300 findings have more than a megabyte."""
        with h5py.File(self.root / "run.h5", "w") as file:
            for k in range(300):
                put_finding(file, k, f"group-{k % 30}.finding-with-a-name-as-usual-{k}", "check")
        make_pages(self.root, self.root / "figures")
        self.assertTrue((self.root / "report" / "checks.html").is_file())
        self.assertLessEqual((self.root / "report.html").stat().st_size, MOST_BYTES)

    def test_a_section_is_registered_by_its_name_and_its_template(self) -> None:
        put_run(self.root)
        (self.root / "weather.html.j2").write_text(
            '{% macro section() %}<section id="weather"><h2>Weather</h2><p id="rain">'
            "{{ page.parts.weather }}</p></section>{% endmacro %}"
        )
        (self.root / "weather.txt").write_text("<rain>")
        weather = Section(
            "weather", "The weather of this run", lambda page: page.parts["weather"], "Weather",
            lambda source: (source.folder / "weather.txt").read_text()
        )
        with mock.patch("pages.page.SECTIONS", (*SECTIONS, weather)), mock.patch(
            "pages.render.TEMPLATES", (*TEMPLATES, self.root)
        ):
            pages = pages_of(self.root)
            (self.root / "weather.txt").write_text("")
            self.assertNotIn("report/weather.html", pages_of(self.root))
        first, own = pages["report.html"], pages["report/weather.html"]
        self.assertIn("&lt;rain&gt;", own)
        self.assertIn("<title>The weather of this run: foldproof</title>", own)
        self.assertIn('<a href="report/weather.html">The weather of this run</a>', first)
        self.assertIn('<a href="report/weather.html#weather">Weather</a></nav>', first)


def found(name: str, measured: float, outcome: str = "holds") -> Finding:
    return Finding(name, "check", "", "", "", measured, 9, 0, "m", "", outcome, "", 0, "", [], [])


class Questions(unittest.TestCase):
    """Momentum alone: its findings, and a study with its figure."""

    study, figure = FIGURES["momentum"][1:]

    def answers(self, findings: list[Finding], figure: str) -> list[str]:
        """Words and figures."""
        study = Study(self.study, "", "", "", 0, [mock.Mock()], [])
        study.figures[0].name, study.figures[0].title = figure, "A title"
        svg = Markup('<svg><g id="a"/><use href="#a"/></svg>')
        made = four_questions(
            Results(findings, [], [], str), [StudyView(study, "study", [Plot("x", svg)])]
        )
        return [f"{html_of(one.words)} {one.svg}" for one in made]

    def test_an_answer_has_the_worst_number_of_each_kind_and_a_figure(self) -> None:
        findings = [found("bending.forces-sum-to-zero", 3), found("bending.torques-sum-to-zero", 4),
                    found("bending.damping-forces-conserve-momentum", 5),
                    found("momentum-drift.damped-angular-is-conserved.A", 6),
                    found("momentum-drift.undamped-angular-is-conserved.B", 7),
                    found("momentum-drift.damped-drift-order.C", 8),
                    found("strain-momentum.drift-is-first-order.A", 9)]
        (answer,) = self.answers(findings, self.figure)
        self.assertEqual(re.findall(r'"n">([^<]*)<', answer), ["3", "4", "5", "7"])
        for words in ("Yes", 'id="answer-a"', 'href="#answer-a"'):
            self.assertIn(words, answer)
        self.assertEqual(self.answers(findings, "another"), [])
        self.assertEqual(self.answers(findings[:2], self.figure), [])
        broken = [*findings[1:], found("bending.forces-sum-to-zero", 30, "fails")]
        (answer,) = self.answers(broken, self.figure)
        self.assertIn("Not shown by this run", answer)
        self.assertNotIn("Yes", answer)


class Looks(unittest.TestCase):
    def test_methods_differ_by_colour_and_by_marker(self) -> None:
        x, nan = np.array([1.0, 2.0, 3.0]), float("nan")
        curves = [Curve(name, x, x ** k, nan, None, nan, None) for k, name in enumerate(METHODS, 1)]
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

    def test_of_shapes_on_each_other_both_are_seen(self) -> None:
        nan, turn = float("nan"), np.linspace(0, 6, 201)
        curves = [
            Curve(name, size * np.cos(t), size * np.sin(t), nan, None, nan, None)
            for name, size, t in (("large", 1, turn), ("small", 0.5, turn),
                                  ("of large", 0.99, turn[::5]), ("other", 0.8, turn[::5]))
        ]
        pens = pens_of(StudyFigure("loops", "", "", "x", "L", "y", "L", "linear", "linear", curves,
                                   nan))
        self.assertEqual([pen.width > 0 for pen in pens], [True, True, False, True])
        self.assertEqual(pens[2].colour, pens[0].colour)
        self.assertEqual(len({pen.colour for pen in pens}), 3)
        self.assertNotIn("M0,6", key_svg(pens[2]))


class Said(FolderTest):
    def test_what_must_reach_a_number_is_said_so(self) -> None:
        put_run(self.root)
        finding = load_run(self.root / "run.h5").findings[0]
        short = replace(finding, measured=-10.0, bound=0.0, unit="points short of 60")
        for html, words in (
            (measured_html(short), "70\u2009points"), (bound_html(short), "at least 60"),
            (bound_html(replace(finding, bound=0.5)), "0.5"),
        ):
            self.assertEqual(re.sub("<[^>]+>", "", html), words)
