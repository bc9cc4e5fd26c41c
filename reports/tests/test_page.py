"""Tests of the page as a reader meets it: order, links, contrast, filter, phone, paper. Those that
need a browser are skipped, with a word, where there is none."""
from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
import unittest
from html.parser import HTMLParser
from pathlib import Path

import h5py
import numpy as np

from data.results import Claim, Column, Study, Table
from make_report import make_report
from pages.answers import Choice, LastingStep, cheapest_of, lasting_steps
from pages.chromium import Browser, NoBrowser, find_browser
from pages.ledger import by_paper, claim_views
from tests.made_up_run import NAMES, put_run

REPORTS = Path(__file__).resolve().parents[1]
SECTIONS = ("claims", "checks", "studies", "cases", "faults", "hard", "speed", "provenance")
LEAST_CONTRAST = 4.5                # of text, WCAG 2.1 level AA
TEXT_COLOURS = (
    "ink", "soft", "holds", "fails", "inconclusive", "none", "link", "plot-ink", "plot-muted"
)


class Outline(HTMLParser):
    """Accessibility of a page: headings, pictures without text, cells without a scope."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.levels: list[int] = []
        self.wordless: list[str] = []
        self.unscoped = 0
        self.tags: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        said = dict(attrs)
        self.tags.append(tag)
        if re.fullmatch("h[1-6]", tag):
            self.levels.append(int(tag[1]))
        if (
            tag == "img"
            and not said.get("alt")
            or tag == "svg"
            and not (said.get("aria-label") or "aria-hidden" in said)
        ):
            self.wordless.append(str(said)[:80])
        if tag == "th" and "scope" not in said:
            self.unscoped += 1


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

    def test_sections_have_their_order(self) -> None:
        places = [self.text.index(f'<section id="{name}"') for name in SECTIONS]
        self.assertEqual(places, sorted(places))

    def test_a_claim_says_where_the_paper_makes_it_where_the_file_knows(self) -> None:
        self.assertIn(
            "The paper, section 3, paragraph 4: &ldquo;Sums add up &hellip;&rdquo;", self.text)
        self.assertIn('Printed: <span class="formula">a - b</span>. '
            'Restored: <span class="formula">a + b</span>.', self.text)
        self.assertEqual(self.text.count('<p class="cited">'), 2)  # T17 is of an older program

    def test_what_was_not_asked_shows_its_reason_and_no_numbers(self) -> None:
        row = re.search(
            (
                r'<span class="claim">(?:(?!<span class="claim">).)*?written for another'
                r' mesh</span></span>'
            ),
            self.text,
            re.DOTALL,
        )
        self.assertIsNotNone(row)
        self.assertNotIn("NaN", row.group())

    def test_the_first_screen_counts_and_answers(self) -> None:
        opening = self.text[:self.text.index("<main")]
        for word in (
            "Claims", "Checks", "Studies", "Cases", "Which claims of the paper hold?",
            "Which integrator should I use?"
        ):
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

    def test_a_validation_has_a_section_of_its_own(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            put_run(folder)
            with h5py.File(folder / "run.h5", "r+") as file:
                file[f"findings/{NAMES[3]}"].attrs["kind"] = "validation"
            text = make_report(folder, folder / "report.html", folder / "figures").read_text(
                encoding="utf-8"
            )
        section = text[text.index('<section id="validation">'):]
        self.assertIn(f"Claim of {NAMES[3]}.", section[:section.index('<section id="faults"')])
        self.assertIn('id="not-validated"', section)
        self.assertNotIn('<section id="validation">', self.text)

    def test_a_hard_case_stands_with_the_hard_ones(self) -> None:
        self.assertLess(self.text.index('<section id="hard"'), self.text.index(f'id="{NAMES[7]}"'))
        self.assertIn("cases/hard/sharp_fold.toml", self.text)

    def test_headings_pictures_and_tables_can_be_read_aloud(self) -> None:
        outline = Outline(self.text)
        self.assertEqual(outline.levels[0], 1)
        self.assertEqual(outline.levels.count(1), 1)
        for before, after in zip(outline.levels, outline.levels[1:]):
            self.assertLessEqual(after, before + 1)
        self.assertEqual(outline.wordless, [])
        self.assertEqual(outline.unscoped, 0)
        for landmark in ("header", "nav", "main", "footer"):
            self.assertEqual(outline.tags.count(landmark), 1, landmark)

    def test_groups_with_something_to_look_at_are_open(self) -> None:
        self.assertRegex(self.text, r'<details class="group" id="checks-springs" open>')
        self.assertNotRegex(self.text, r'<details class="group" id="findings-of-sharp_fold" open>')


class Papers(unittest.TestCase):
    """Claims of several papers."""

    def test_claims_stand_under_their_paper(self) -> None:
        claims = [
            Claim(
                name=name, section="3", statement="s", ruling="undecided", recorded="undecided",
                condition="", why="w", decided_by=[], paper=paper, paper_title="Title (1999)",
                missing="m"
            )
            for name, paper in (("T1", "ABC99"), ("X1", "XYZ00"), ("T2", "ABC99"))
        ]
        grouped = by_paper(claim_views(claims, []))
        self.assertEqual(
            [(heading, [view.claim.name for view in views]) for heading, views in grouped],
            [("ABC99: Title (1999)", ["T1", "T2"]), ("XYZ00: Title (1999)", ["X1"])],
        )


class Answers(unittest.TestCase):
    def test_the_cheapest_method_is_that_of_the_table(self) -> None:
        texts = {"scene": ["a", "a", "a", "b"], "by": ["work", "work", "seconds", "work"],
                 "cheapest method": ["RK4", "C", "A", "B"], "next best": ["A", "B", "B", "A"]}
        numbers = {
            "error wanted": ([1.0, 0.1, 1.0, 1.0], "%"),
            "it costs this many times as much": ([1.5, 2.0, 9.0, np.nan], "1"),
            "C costs this many times as much": ([3.0, 1.0, 9.0, 4.0], "1")
        }
        columns = [
            Column(name, "", np.array(values, dtype=object)) for name, values in texts.items()
        ]
        columns += [
            Column(name, unit, np.array(values)) for name, (values, unit) in numbers.items()
        ]
        study = Study("work", "", "", "", 0.0, [], [Table("other", []), Table("cheapest", columns)])
        found = cheapest_of([study])
        self.assertEqual((found.by, found.errors, found.unit), ("work", [1.0, 0.1], "%"))
        self.assertEqual(
            found.rows,
            [
                (
                    "a",
                    [
                        Choice("RK4", [("A", 1.5), ("C", 3.0)], [], "A by seconds"),
                        Choice("C", [("B", 2.0)]),
                    ],
                ),
                ("b", [Choice("B", [("C", 4.0)]), None]),
            ],
        )
        columns.append(Column("tied", "", np.array(["A, B", "", "", ""], dtype=object)))
        tied = cheapest_of([Study("work", "", "", "", 0.0, [], [Table("cheapest", columns)])])
        self.assertEqual(
            tied.rows[0][1], [Choice("RK4", [("C", 3.0)], ["A", "B"]), Choice("C", [("B", 2.0)])]
        )
        self.assertIsNone(cheapest_of([Study("none", "", "", "", 0.0, [], [])]))

    def test_small_scenes_are_priced_beside_the_others(self) -> None:
        def column(name: str, values: list[object], unit: str = "") -> Column:
            return Column(name, unit, np.array(values, dtype=object if unit == "" else float))

        work = Table("cheapest", [
            column("scene", ["a"]), column("by", ["work"]), column("cheapest method", ["A"]),
            column("error wanted", [0.1], "%")
        ])
        prices = Table("prices", [
            column("scene", ["in-contact"] * 5), column("error wanted", [0.001] * 5, "1"),
            column("method", ["RK2", "A", "B", "C", "BDF2"]),
            column("over the cheapest", [1.0, 1.1, 2.0, 3.0, np.nan], "1"),
            column("tied with it", ["no", "yes", "no", "no", "no"])
        ])
        found = cheapest_of([
            Study("other", "", "", "", 0.0, [], [work]),
            Study("kinds", "", "", "", 0.0, [], [prices])
        ])
        self.assertEqual(found.kinds_of, "kinds")
        self.assertEqual(
            found.kinds, [("in contact", [Choice("RK2", [("B", 2.0), ("C", 3.0)], ["A"])])]
        )
        for values in prices.columns:
            if values.name == "over the cheapest":
                values.values[:] = np.nan
        self.assertEqual(
            cheapest_of([Study("w", "", "", "", 0.0, [], [work, prices])]).kinds,
            [("in contact", [None])]
        )

    def test_the_longest_steps_are_those_of_the_table(self) -> None:
        columns = [
            Column(name, "", np.array(values, dtype=object))
            for name, values in {
                "method": ["A", "B"], "longest step that lasts": [0.002, 0.0],
                "over the elastic limit": [1.0, 0.0],
                "the next step, twice as long": ["gains energy", "diverges"],
                "over those of C": [1.5, np.nan]
            }.items()
        ]
        found = lasting_steps([Study("long", "", "", "", 0.0, [], [Table("steps", columns)])])
        self.assertEqual(found[0], "long")
        self.assertEqual(found[1][0], LastingStep("A", 0.002, 1.0, "gains energy", 1.5))
        self.assertEqual((found[1][1].step, found[1][1].beyond), (0.0, "diverges"))
        self.assertIsNone(lasting_steps([Study("none", "", "", "", 0.0, [], [])]))


class Contrast(unittest.TestCase):
    """Colours of text against what lies behind it, in both palettes of style.css."""

    def palettes(self) -> dict[str, dict[str, str]]:
        """Light and dark: the variables that are colours."""
        text = (REPORTS / "pages" / "style.css").read_text(encoding="utf-8")
        light, dark = (
            dict(re.findall(r"--([\w-]+): (#[0-9a-f]{6})", block))
            for block in re.findall(r":root \{(.*?)\}", text, re.S)[:2]
        )
        return {"light": light, "dark": dark}

    def test_text_is_legible(self) -> None:
        for name, palette in self.palettes().items():
            for behind in ("paper", "panel"):
                for colour in TEXT_COLOURS:
                    with self.subTest(palette=name, behind=behind, colour=colour):
                        self.assertGreaterEqual(
                            contrast(palette[colour], palette[behind]), LEAST_CONTRAST
                        )

    def test_both_palettes_have_the_same_names(self) -> None:
        light, dark = self.palettes().values()
        self.assertEqual(set(light), set(dark))

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


class InABrowser(MadeUpPage):
    """The page in Chromium."""

    @classmethod
    def setUpClass(cls) -> None:
        try:
            cls.browser = Browser()
        except NoBrowser as why:
            raise unittest.SkipTest(f"not tried: {why}") from why
        cls.addClassCleanup(cls.browser.close)
        super().setUpClass()

    def setUp(self) -> None:
        self.browser.complaints.clear()
        self.browser.requests.clear()

    def tearDown(self) -> None:
        self.assertEqual(self.browser.complaints, [])
        self.assertEqual(
            {address.partition("#")[0] for address in self.browser.requests} - {"about:blank"},
            {self.page.as_uri()},
        )

    def shown(self) -> list[str]:
        """Ids of the entries that are shown."""
        return self.browser.evaluate(
            """[...document.querySelectorAll(".claim-row, .finding, .fault")]
            .filter(entry => !entry.closest("[hidden]")).map(entry => entry.id)"""
        )

    def choose(self, **chosen: str) -> None:
        """Sets controls as a reader would."""
        for name, value in chosen.items():
            self.browser.evaluate(
                f"document.querySelector('.filter').elements.{name}.value = {value!r}"
            )
        self.browser.evaluate(
            """(document.querySelector('.filter').dispatchEvent(new Event('input')),
            new Promise(done => setTimeout(done, 300)))"""
        )

    def test_the_filter_shows_what_matches_and_says_how_much(self) -> None:
        self.browser.open(self.page)
        everything = self.shown()
        self.choose(verdict="fails")
        self.assertEqual(self.shown(), [NAMES[1]])
        self.assertRegex(
            self.browser.evaluate("document.querySelector('[aria-live=polite]').textContent"),
            r"^1 of \d+ match$",
        )
        self.assertTrue(self.browser.evaluate("document.getElementById('studies').hidden"))
        self.choose(verdict="", subject="bending")
        self.assertEqual(set(self.shown()), {"T1", NAMES[0], NAMES[1], "fault-flipped-sign"})
        self.choose(subject="", section="hard")
        self.assertEqual(self.shown(), [NAMES[7]])
        self.choose(section="", text="FORCES zero")
        self.assertEqual(self.shown(), [NAMES[0], "fault-flipped-sign"])
        self.choose(text="no such words")
        self.assertEqual(self.shown(), [])
        self.choose(text="")
        self.assertEqual(self.shown(), everything)
        self.assertEqual(self.browser.evaluate("location.hash"), "")

    def test_what_is_chosen_stands_in_the_address(self) -> None:
        self.browser.open(self.page)
        self.choose(verdict="refuted", text="17")
        address = self.browser.evaluate("location.hash")
        self.browser.open(self.page, address)
        self.assertEqual(self.shown(), ["T17"])

    def test_an_anchor_opens_its_row_whatever_was_chosen(self) -> None:
        self.browser.open(self.page, "#?verdict=refuted")
        self.browser.evaluate(
            f"(location.hash = '{NAMES[0]}', new Promise(done => setTimeout(done, 300)))"
        )
        self.assertIn(NAMES[0], self.shown())
        self.browser.open(self.page, f"#{NAMES[0]}")
        row = f"document.getElementById('{NAMES[0]}')"
        self.assertTrue(
            self.browser.evaluate(f"{row}.open && {row}.parentElement.closest('details').open")
        )
        self.assertTrue(self.browser.evaluate(f"{row}.checkVisibility()"))

    def test_two_clicks_lead_from_a_claim_to_the_evidence(self) -> None:
        self.browser.open(self.page)
        self.browser.evaluate("document.querySelector('#T1 > summary').click()")
        self.browser.evaluate(
            "(document.querySelector('#T1 .deciding a').click(), new Promise(done =>"
            " setTimeout(done, 300)))"
        )
        self.assertTrue(
            self.browser.evaluate(
                f"document.querySelector('[id=\"{NAMES[0]}\"] table').checkVisibility()"
            )
        )

    def test_a_slash_leads_to_the_search(self) -> None:
        self.browser.open(self.page)
        self.browser.press("/")
        self.assertEqual(self.browser.evaluate("document.activeElement.name"), "text")
        self.assertEqual(self.browser.evaluate("document.activeElement.value"), "")

    def test_without_scripts_the_page_is_whole_and_has_no_controls(self) -> None:
        self.browser.open(self.page, script=False)
        self.assertTrue(self.browser.evaluate("document.querySelector('.filter').hidden"))
        self.assertEqual(
            self.browser.evaluate(
                "document.querySelectorAll('.group[hidden], .finding[hidden]').length"
            ),
            0,
        )

    def test_nothing_is_wider_than_a_phone(self) -> None:
        for width in (390, 1400):
            for dark in (False, True):
                self.browser.open(self.page, width=width, dark=dark)
                self.browser.evaluate(
                    "document.querySelectorAll('details').forEach(part => { part.open = true; })"
                )
                self.assertEqual(
                    self.browser.evaluate("document.documentElement.scrollWidth"), width
                )

    def test_dark_and_light_differ(self) -> None:
        colours = []
        for dark in (False, True):
            self.browser.open(self.page, dark=dark)
            colours.append(self.browser.evaluate("getComputedStyle(document.body).backgroundColor"))
        self.assertEqual(len(set(colours)), 2)


class OnPaper(unittest.TestCase):
    """make_report.py --pdf."""

    def printed(self, root: Path, **environment: str) -> subprocess.CompletedProcess[str]:
        """Runs the command on a made-up run."""
        put_run(root)
        return subprocess.run(
            [sys.executable, str(REPORTS / "make_report.py"), str(root), "--pdf"],
            capture_output=True, text=True, check=False, env=os.environ | environment
        )

    def test_a_pdf_has_pages_and_an_outline_and_is_the_same_each_time(self) -> None:
        try:
            find_browser()
        except NoBrowser as why:
            raise unittest.SkipTest(f"not tried: {why}") from why
        contents = []
        with tempfile.TemporaryDirectory() as folder:
            for _ in range(2):
                done = self.printed(Path(folder))
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                self.assertEqual(done.stdout, f"{folder}/report.pdf\n")
                contents.append((Path(folder) / "report.pdf").read_bytes())
        self.assertTrue(contents[0].startswith(b"%PDF-"))
        self.assertIn(b"/Outlines", contents[0])
        self.assertEqual(contents[0], contents[1])

    def test_without_a_browser_it_is_refused_at_once(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            done = self.printed(Path(folder), PATH=folder)
            self.assertEqual(done.returncode, 2)
            self.assertEqual(len(done.stderr.splitlines()), 1)
            self.assertIn("apt install chromium", done.stderr)
            self.assertFalse((Path(folder) / "report.html").exists())
