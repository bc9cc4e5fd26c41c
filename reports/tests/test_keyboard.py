"""The report is used with a keyboard alone: every control is reached, in the order of the page, and
one sees where one is. Run with reports/tests/test_views.py."""
from __future__ import annotations

import shutil
import tempfile
import unittest
from pathlib import Path
from unittest import mock

from make_report import make_pages
from pages.chromium import Browser
from tests.made_up_run import put_run

# What a keyboard must reach, in the order of the page: controls that are drawn. Of buttons for one
# choice (radio) a browser visits one.
CONTROLS = """(() => {
  window.reached = (element) => [...document.querySelectorAll("*")].indexOf(element);
  return [...document.querySelectorAll("a[href], button, input, select, summary, [tabindex='0']")]
    .filter((one) => !one.disabled && one.checkVisibility({ visibilityProperty: true }))
    .map((one) => [reached(one), one.outerHTML.slice(0, 90)]);
})()"""
PAGES = ("report.html", "report/claims.html", "report/checks.html", "report/case-fold.html")
WHERE = """(() => {
  const at = document.activeElement, style = getComputedStyle(at);
  const place = at.getBoundingClientRect();
  return { place: at === document.body ? -1 : reached(at), tag: at.tagName.toLowerCase(),
           text: at.textContent.slice(0, 60),
           marked: style.outlineStyle !== "none" && parseFloat(style.outlineWidth) >= 1,
           shown: place.width > 0 && place.right > 0 && place.bottom > 0
                  && place.left < innerWidth && place.top < innerHeight };
})()"""


@unittest.skipUnless(shutil.which("chromium"), "no chromium: the package chromium has it")
class Keyboard(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        root = Path(folder.name)
        put_run(root)
        with mock.patch("pages.render.MOST_BYTES", 100):
            cls.folder = make_pages(root, root / "figures").parent
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)

    def open(self, name: str, width: int = 1280) -> list[tuple[int, str]]:
        """The controls of a page: their places in it, and their texts."""
        self.browser.open(self.folder / name, width=width)
        return self.browser.evaluate(CONTROLS)

    def tab(self) -> dict:
        self.browser.press("Tab")
        return self.browser.evaluate(WHERE)

    def test_every_control_is_reached_in_order_and_is_seen(self) -> None:
        for name in PAGES:
            for width in (1280, 400):
                with self.subTest(page=name, width=width):
                    controls = self.open(name, width)
                    stops = []
                    while (stop := self.tab())["place"] > (stops[-1]["place"] if stops else -1):
                        stops.append(stop)
                    for stop in stops:
                        self.assertTrue(stop["shown"], f"out of sight: {stop}")
                        self.assertTrue(stop["marked"], f"not marked: {stop}")
                    places = {stop["place"] for stop in stops}
                    missed = [text for place, text in controls if place not in places]
                    self.assertEqual(missed, [])
                    self.assertGreater(len(stops), 5)

    def test_the_first_stop_leads_past_the_navigation(self) -> None:
        self.open("report/checks.html")
        first = self.tab()
        self.assertEqual(first["text"], "Skip to the content")
        self.browser.press("Enter")
        self.tab()
        self.assertTrue(
            self.browser.evaluate(
                "document.querySelector('#content').contains(document.activeElement)"
            )
        )

    def test_what_is_folded_opens_and_closes(self) -> None:
        self.open("report/checks.html")
        for _ in range(200):
            if self.tab()["tag"] == "summary":
                break
        is_open = "document.activeElement.closest('details').open"
        before = self.browser.evaluate(is_open)
        for key in ("Enter", " "):
            self.browser.press(key)
            before = not before
            self.assertEqual(self.browser.evaluate(is_open), before)
