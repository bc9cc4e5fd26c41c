"""Tests of the page as a reader meets it: order, links, answers, contrast; run with
reports/tests/test_reports.py."""
from __future__ import annotations

import re
import tempfile
import unittest
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from data.results import Claim, Column
from data.studies import Study, Table
from make_report import make_report
from pages.answers import Choice, LastingStep, cheapest_of, lasting_steps
from pages.ledger import by_paper, claim_views
from pages.page import SECTIONS
from tests.made_up_run import NAMES, put_run
from tests.report_test import REPORTS, ReportTest

LEAST_CONTRAST = 4.5                # of text, WCAG 2.1 level AA
LEAST_OF_LINES = 3.0                # of lines in plots, likewise
TEXT_COLOURS = (
    "ink", "soft", "holds", "fails", "inconclusive", "none", "link", "plot-ink", "plot-muted"
)


class Outline(HTMLParser):
    """Accessibility of a page: headings, pictures without text, cells without a scope."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.levels: list[int] = []
        self.wordless: list[str] = []
        self.tags: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        said = dict(attrs)
        self.tags.append(tag)
        if re.fullmatch("h[1-6]", tag):
            self.levels.append(int(tag[1]))
        words = {
            "img": said.get("alt"), "svg": said.get("aria-label") or "aria-hidden" in said,
            "th": said.get("scope")
        }
        if tag in words and not words[tag]:
            self.wordless.append(f"{tag} {said}"[:80])


class MadeUpPage(unittest.TestCase):
    """The report of the made-up run, with a rate of work."""

    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.root = Path(folder.name)
        put_run(cls.root)
        cls.page = make_report(cls.root, cls.root / "report.html", cls.root / "figures")
        cls.text = cls.page.read_text(encoding="utf-8")


class Order(MadeUpPage):
    """Contents of the page."""

    def test_sections_and_studies_have_their_order(self) -> None:
        names = [section.name for section in SECTIONS]
        shown = re.findall(r'^ *<section id="([^"]+)"', self.text, re.M)
        shown = [name for name in shown if name in names]
        self.assertEqual(shown, [name for name in names if name in shown])
        self.assertGreaterEqual(
            set(shown), {"claims", "checks", "studies", "cases", "faults", "hard", "speed"}
        )
        self.assertEqual(re.search(r"<nav.*?</nav>", self.text)[0].count("<a "), len(shown))
        self.assertLess(self.text.index('id="hard"'), self.text.index(f'id="{NAMES[7]}"'))
        self.assertIn("cases/hard/sharp_fold.toml", self.text)
        studies = [self.text.index(f'"study-{name}"') for name in ("stability-oscillator",
                                                                   "time-order")]
        self.assertEqual(studies, sorted(studies))  # first those that help to choose an integrator

    def test_a_claim_says_where_the_paper_makes_it_where_the_file_knows(self) -> None:
        cited = re.findall(r'<p class="cited">(.*?)</p>', self.text)
        self.assertEqual(len(cited), 2)  # T17 has no place
        self.assertIn("section 3, paragraph 4: &ldquo;Sums add up &hellip;&rdquo;", cited[0])
        self.assertEqual(re.sub("<[^>]+>", "", cited[1]), "Printed: a - b. Restored: a + b.")

    def test_what_was_not_asked_shows_its_reason_and_no_numbers(self) -> None:
        rows = self.text.split('<span class="claim">')
        (row,) = [row for row in rows if "written for another mesh</span></span>" in row]
        self.assertNotIn("NaN", row)

    def test_the_first_screen_counts_and_answers(self) -> None:
        opening = self.text[:self.text.index("<main")]
        for word in ("Which claims of the paper hold?", "Which integrator should I use?"):
            self.assertIn(word, opening)
        refuted = opening[opening.index("Refuted"):]
        self.assertLess(refuted.index('href="#T17"'), refuted.index("</ul>"))
        self.assertNotIn('href="#T1"', refuted)

    def test_a_finding_leads_to_its_reason_faults_case_and_command(self) -> None:
        row = self.text[self.text.index(f'id="{NAMES[6]}"'):]
        row = row[:row.index("</details>")]
        for part in (
            "200 roundings", 'href="#fault-flipped-sign"', 'href="#case-fold"', "cases/fold.toml",
            f"build/foldproof check '{NAMES[6]}'", "Evidence"
        ):
            self.assertIn(part, row)

    def test_headings_pictures_and_tables_can_be_read_aloud(self) -> None:
        outline = Outline(self.text)
        self.assertEqual((outline.levels[0], outline.levels.count(1)), (1, 1))
        for before, after in zip(outline.levels, outline.levels[1:]):
            self.assertLessEqual(after, before + 1)
        self.assertEqual(outline.wordless, [])
        for once in ("header", "nav", "main", "footer", "dfn"):
            self.assertEqual(outline.tags.count(once), 1, once)

    def test_groups_with_something_to_look_at_are_open(self) -> None:
        self.assertRegex(self.text, r'<details class="group" id="checks-springs" open>')
        self.assertNotRegex(self.text, r'<details class="group" id="findings-of-sharp_fold" open>')


class Validation(ReportTest):
    def test_a_validation_has_a_section_of_its_own(self) -> None:
        put_run(self.root)
        self.assertEqual(self.section("validation"), "")
        with h5py.File(self.root / "run.h5", "r+") as file:
            file[f"findings/{NAMES[3]}"].attrs["kind"] = "validation"
        text = self.made()
        section = text[text.index('id="validation"'):text.index('id="cases"')]
        self.assert_all_in((f"Claim of {NAMES[3]}.", 'id="not-validated"'), section)


class Papers(unittest.TestCase):
    def test_claims_stand_under_their_paper(self) -> None:
        claims = [
            Claim(
                name, "3", "s", "undecided", "undecided", "", "w", [], paper=paper,
                paper_title="Title (1999)", missing="m"
            )
            for name, paper in (("T1", "ABC99"), ("X1", "XYZ00"), ("T2", "ABC99"))
        ]
        grouped = by_paper(claim_views(claims, []))
        names = {head: [view.claim.name for view in views] for head, views in grouped.items()}
        self.assertEqual(
            names, {"ABC99: Title (1999)": ["T1", "T2"], "XYZ00: Title (1999)": ["X1"]}
        )


def study(name: str, **columns: Any) -> Study:
    """With one table; blanks of the names of columns are written as underscores."""
    table = [
        Column(key, "%" if "error" in key else "1", np.array(
            values, dtype=object if isinstance(values[0], str) else float
        ))
        for key, values in columns.items()
    ]
    return Study(name, "", "", "", 0.0, [], [Table("other", []), Table("a table", table)])


class Answers(unittest.TestCase):
    work = {
        "scene": ["a", "a", "a", "b"], "error_wanted": [1.0, 0.1, 1.0, 1.0],
        "by": ["work", "work", "seconds", "work"], "cheapest_method": ["RK4", "C", "A", "B"],
        "next_best": ["A", "B", "B", "A"],
        "it_costs_this_many_times_as_much": [1.5, 2.0, 9.0, np.nan],
        "C_costs_this_many_times_as_much": [3.0, 1.0, 9.0, 4.0]
    }

    def test_the_cheapest_method_is_that_of_the_table(self) -> None:
        found = cheapest_of([study("work", **self.work)])
        self.assertEqual((found.by, found.errors, found.unit), ("work", [1.0, 0.1], "%"))
        c = Choice("C", [("B", 2.0)])
        rk4 = Choice("RK4", [("A", 1.5), ("C", 3.0)], [], "A by seconds")
        self.assertEqual(found.rows, [("a", [rk4, c]), ("b", [Choice("B", [("C", 4.0)]), None])])
        tied = cheapest_of([study("work", **self.work, tied=["A, B", "", "", ""])])
        self.assertEqual(tied.rows[0][1], [Choice("RK4", [("C", 3.0)], ["A", "B"]), c])
        self.assertIsNone(cheapest_of([study("none")]))

    def test_small_scenes_are_priced_beside_the_others(self) -> None:
        work = study("work", **self.work)
        for over, choice in (
            ([1.0, 1.1, 2.0, 3.0, np.nan], Choice("RK2", [("B", 2.0), ("C", 3.0)], ["A"])),
            ([np.nan] * 5, None),
        ):
            prices = study(
                "kinds", scene=["in-contact"] * 5, error_wanted=[1.0] * 5,
                method=["RK2", "A", "B", "C", "BDF2"], over_the_cheapest=over,
                tied_with_it=["no", "yes", "no", "no", "no"]
            )
            found = cheapest_of([work, prices])
            self.assertEqual((found.kinds_of, found.kinds),
                             ("kinds", [("in contact", [choice, None])]))

    def test_the_longest_steps_are_those_of_the_table(self) -> None:
        steps = study(
            "long", method=["A", "B"], longest_step_that_lasts=[0.002, 0.0],
            over_the_elastic_limit=[1.0, 0.0], over_those_of_C=[1.5, 7.0],
            **{"the next step, twice as long": ["gains energy", "diverges"]}
        )
        name, (first, second) = lasting_steps([steps])
        self.assertEqual(name, "long")
        self.assertEqual(first, LastingStep("A", 0.002, 1.0, "gains energy", 1.5))
        self.assertEqual((second.step, second.beyond), (0.0, "diverges"))
        self.assertIsNone(lasting_steps([study("none")]))


class Contrast(unittest.TestCase):
    """Colours of text and lines against what lies behind them, in both palettes of style.css."""

    def test_text_and_lines_are_legible_in_both_palettes(self) -> None:
        text = (REPORTS / "pages" / "style.css").read_text(encoding="utf-8")
        light, dark = (
            dict(re.findall(r"--([\w-]+): (#[0-9a-f]{6})", block))
            for block in re.findall(r":root \{(.*?)\}", text, re.S)[:2]
        )
        self.assertEqual(set(light), set(dark))
        lines = [name for name in light if re.fullmatch(r"plot-\d+", name)]
        self.assertGreater(len(lines), 10)
        for palette in (light, dark):
            for colour in (*TEXT_COLOURS, *lines):
                for behind in ("paper", "panel") if colour in TEXT_COLOURS else ("paper",):
                    least = LEAST_CONTRAST if colour in TEXT_COLOURS else LEAST_OF_LINES
                    with self.subTest(behind=palette[behind], colour=colour):
                        found = contrast(palette[colour], palette[behind])
                        self.assertGreaterEqual(found, least)

    def test_contrast_of_black_and_white(self) -> None:
        self.assertAlmostEqual(contrast("#000000", "#ffffff"), 21.0)
        self.assertAlmostEqual(contrast("#777777", "#ffffff"), 4.48, places=2)


def contrast(one: str, other: str) -> float:
    """The ratio of WCAG 2.1: (brighter + 0.05) / (darker + 0.05) of relative luminances."""
    luminances = []
    for colour in (one, other):
        parts = np.array([int(colour[k:k + 2], 16) for k in (1, 3, 5)]) / 255
        linear = np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)
        luminances.append(float(linear @ [0.2126, 0.7152, 0.0722]))
    return (max(luminances) + 0.05) / (min(luminances) + 0.05)
