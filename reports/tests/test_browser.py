"""The page as a reader meets it in a browser, and on paper. Skipped, with a word, where there is no
browser; run with reports/tests/test_reports.py."""
from __future__ import annotations

import unittest

from pages.chromium import Browser, NoBrowser, find_browser
from tests.made_up_run import NAMES, put_run
from tests.report_test import FolderTest
from tests.test_page import MadeUpPage

A_WHILE = "new Promise(done => setTimeout(done, 300))"


def require_browser() -> None:
    try:
        find_browser()
    except NoBrowser as why:
        raise unittest.SkipTest(f"not tried: {why}") from why


class InABrowser(MadeUpPage):
    """The page in Chromium."""

    @classmethod
    def setUpClass(cls) -> None:
        require_browser()
        super().setUpClass()
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)

    def setUp(self) -> None:
        self.browser.complaints.clear()
        self.browser.requests.clear()
        self.ask = self.browser.evaluate

    def tearDown(self) -> None:
        self.assertEqual(self.browser.complaints, [])
        asked = {address.partition("#")[0] for address in self.browser.requests}
        self.assertEqual(asked - {"about:blank"}, {self.page.as_uri()})

    def shown(self) -> list[str]:
        """Ids of the entries that are shown."""
        return self.ask(
            """[...document.querySelectorAll(".claim-row, .finding, .fault")]
            .filter(entry => !entry.closest("[hidden]")).map(entry => entry.id)"""
        )

    def choose(self, **chosen: str) -> None:
        """Sets controls as a reader would."""
        for name, value in chosen.items():
            self.ask(f"document.querySelector('.filter').elements.{name}.value = {value!r}")
        self.ask(
            f"(document.querySelector('.filter').dispatchEvent(new Event('input')), {A_WHILE})"
        )

    def test_the_filter_shows_what_matches_and_says_how_much(self) -> None:
        self.browser.open(self.page)
        everything = self.shown()
        self.choose(verdict="fails")
        said = self.ask("document.querySelector('[aria-live=polite]').textContent")
        self.assertRegex(said, r"^1 of \d+ match$")
        self.assertTrue(self.ask("document.getElementById('studies').hidden"))
        for chosen, shown in (
            ({}, [NAMES[1]]),
            ({"verdict": "", "subject": "bending"},
             ["T1", NAMES[0], NAMES[1], "fault-flipped-sign"]),
            ({"subject": "", "section": "hard"}, [NAMES[7]]),
            ({"section": "", "text": "FORCES zero"}, [NAMES[0], "fault-flipped-sign"]),
            ({"text": "no such words"}, []),
            ({"text": ""}, everything),
        ):
            self.choose(**chosen)
            self.assertEqual(set(self.shown()), set(shown), chosen)
        self.assertEqual(self.ask("location.hash"), "")

    def test_what_is_chosen_stands_in_the_address(self) -> None:
        self.browser.open(self.page)
        self.choose(verdict="refuted", text="17")
        self.browser.open(self.page, self.ask("location.hash"))
        self.assertEqual(self.shown(), ["T17"])

    def test_an_anchor_opens_its_row_whatever_was_chosen(self) -> None:
        self.browser.open(self.page, "#?verdict=refuted")
        self.ask(f"(location.hash = '{NAMES[0]}', {A_WHILE})")
        self.assertIn(NAMES[0], self.shown())
        self.browser.open(self.page, f"#{NAMES[0]}")
        row = f"document.getElementById('{NAMES[0]}')"
        for claim in ("open", "parentElement.closest('details').open", "checkVisibility()"):
            self.assertTrue(self.ask(f"{row}.{claim}"), claim)

    def test_two_clicks_lead_from_a_claim_to_the_evidence(self) -> None:
        self.browser.open(self.page)
        self.ask("document.querySelector('#T1 > summary').click()")
        self.ask(f"(document.querySelector('#T1 .deciding a').click(), {A_WHILE})")
        evidence = f"document.querySelector('[id=\"{NAMES[0]}\"] table')"
        self.assertTrue(self.ask(f"{evidence}.checkVisibility()"))

    def test_a_slash_leads_to_the_search(self) -> None:
        self.browser.open(self.page)
        self.browser.press("/")
        self.assertEqual(self.ask("document.activeElement.name"), "text")
        self.assertEqual(self.ask("document.activeElement.value"), "")

    def test_without_scripts_the_page_is_whole_and_has_no_controls(self) -> None:
        self.browser.open(self.page, script=False)
        self.assertTrue(self.ask("document.querySelector('.filter').hidden"))
        hidden = "document.querySelectorAll('.group[hidden], .finding[hidden]').length"
        self.assertEqual(self.ask(hidden), 0)

    def test_nothing_is_wider_than_a_phone_in_the_dark_or_the_light(self) -> None:
        colours = set()
        for width in (390, 1400):
            for dark in (False, True):
                self.browser.open(self.page, width=width, dark=dark)
                self.ask("document.querySelectorAll('details').forEach(part => part.open = true)")
                self.assertEqual(self.ask("document.documentElement.scrollWidth"), width)
                colours.add((dark, self.ask("getComputedStyle(document.body).backgroundColor")))
        self.assertEqual(len(colours), 2)
        self.assertEqual(len({colour for _, colour in colours}), 2)


class OnPaper(FolderTest):
    """make_report.py --pdf."""

    def test_a_pdf_has_pages_and_an_outline_and_is_the_same_each_time(self) -> None:
        require_browser()
        contents = []
        for _ in range(2):
            put_run(self.root)
            done = self.typed("make_report.py", self.root, "--pdf")
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertEqual(done.stdout, f"{self.root}/report.pdf\n")
            contents.append((self.root / "report.pdf").read_bytes())
        self.assertTrue(contents[0].startswith(b"%PDF-"))
        self.assertIn(b"/Outlines", contents[0])
        self.assertEqual(contents[0], contents[1])

    def test_without_a_browser_it_is_refused_at_once(self) -> None:
        put_run(self.root)
        done = self.typed("make_report.py", self.root, "--pdf", PATH=str(self.root))
        self.assert_refused(done, "apt install chromium")
        self.assertFalse((self.root / "report.html").exists())
