"""Tests of the page of a campaign."""
from __future__ import annotations

import contextlib
import io
import json
import re
import tempfile
import unittest
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np

import make_campaign
from data.case_keys import LENGTHS
from data.campaign_table import WITH_VALUE, CampaignFigure, figures_of, load_campaign
from plots.campaign_layout import layout_of
from plots.campaign_plots import MARKS, cells_of, figure_notes, median_of

ROOT = Path(__file__).resolve().parents[2]
STEPS, METHODS = ["0.1", "0.01", "0.001"], ["A", "C"]


def campaign(**changed: Any) -> dict[str, Any]:
    """A campaign.json of six runs: height = 10 step, plus 1 with method C; one was refused."""
    jobs = [(step, method) for method in METHODS for step in STEPS]
    said: dict[str, Any] = {
        "name": "made_up",
        "title": "Made <up>",
        "about": "no more & no less",
        "run": "simulate",
        "figures": [],
        "findings": [],
        "parameters": ["time.step", "time.integrator"],
        "quantities": ["height", "steps"],
        "units": {"height": "m", "steps": "1"},
        "outcomes": ["holds"] * 5 + ["refused"],
        "reasons": [""] * 5 + ["a <bad> step"],
        "settings": jobs,
        "values": [[10 * float(s) + (m == "C"), 7] for s, m in jobs[:5]] + [[None, None]],
        "seconds": [0.5] * 5 + [None],
    }
    return said | changed


class CampaignPageTest(unittest.TestCase):
    """A campaign that is made up."""

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name)

    def put(self, **changed: Any) -> None:
        (self.path / "campaign.json").write_text(json.dumps(campaign(**changed)))

    def asked(self, *words: str) -> Any:
        """With these words on the command line."""
        return mock.patch("sys.argv", ["make_campaign.py", str(self.path), *words])

    def page(self, *words: str) -> str:
        """The page that the command writes."""
        with self.asked(*words), contextlib.redirect_stdout(io.TextIOWrapper(io.BytesIO())):
            self.assertEqual(make_campaign.main(), 0)
        return (self.path / "report.html").read_text(encoding="utf-8")

    def refusal(self, *words: str) -> str:
        """What the command says when it ends with 2."""
        said = io.StringIO()
        with self.asked(*words), contextlib.redirect_stderr(said), self.assertRaises(
            SystemExit) as stop:
            make_campaign.main()
        self.assertEqual(stop.exception.code, 2)
        self.assertEqual(said.getvalue().count("\n"), 1)
        return said.getvalue()

    def test_each_run_is_drawn_at_its_place(self) -> None:
        self.put()
        table = load_campaign(self.path)
        over = ("time.step", "time.integrator")
        layout = layout_of(table, CampaignFigure("height", over, "", False))
        cells = cells_of(layout, layout.panels[0], table.values["height"])
        np.testing.assert_allclose(cells, [[0.01, 0.1, 1], [np.nan, 1.1, 2]], rtol=1e-15)
        turned = layout_of(table, CampaignFigure("height", over[::-1], "", False))
        np.testing.assert_array_equal(
            cells_of(turned, turned.panels[0], table.values["height"]), cells.T
        )

    def test_a_third_parameter_makes_panels_and_one_left_out_a_median(self) -> None:
        self.put(parameters=["a", "b", "c"], outcomes=["holds"] * 6,
                 settings=[[str(k % 3), "x", str(k // 3)] for k in range(6)])
        table = load_campaign(self.path)
        layout = layout_of(table, CampaignFigure("height", ("a", "b", "c"), "", False))
        self.assertEqual([panel.title for panel in layout.panels], ["c: 0", "c: 1"])
        one = layout_of(table, CampaignFigure("height", ("a",), "", False))
        heights = table.values["height"]
        self.assertEqual(cells_of(one, one.panels[0], heights)[0, 0], (heights[0] + heights[3]) / 2)
        notes = figure_notes(table, CampaignFigure("height", ("a",), "", False))
        self.assertIn("Each place is the median of its runs, at most 2.", notes)

    def test_every_end_of_a_job_has_a_value_or_a_mark(self) -> None:
        source = (ROOT / "verification/files/job_store.cpp").read_text(encoding="utf-8")
        [names] = re.findall(r"end_names\[\] = {([^}]+)}", source)
        ends = set(re.findall(r'"([a-z ]+)"', names))
        self.assertGreaterEqual(ends, {"holds", "timed out"})
        self.assertEqual(ends | {"crashed", "missing"}, set(WITH_VALUE) | set(MARKS))

    def test_what_stopped_has_no_value_though_numbers_were_stored(self) -> None:
        self.put(outcomes=["stopped", "fails", "holds", "holds", "holds", "refused"])
        heights = load_campaign(self.path).values["height"]
        self.assertEqual(list(np.isfinite(heights)), [False, True, True, True, True, False])
        self.assertEqual(median_of(np.array([np.nan, 3.0, 1.0])), 2.0)
        self.assertTrue(np.isnan(median_of(np.array([np.nan]))))

    def test_failures_are_drawn_as_such(self) -> None:
        holds = self.marked(["holds"] * 6)
        for outcome in (*MARKS, "fails"):
            self.assertIn(outcome, self.marked([outcome] + ["holds"] * 5) - holds)

    def marked(self, outcomes: list[str]) -> set[str]:
        """The words in the figures of six runs with these outcomes."""
        self.put(outcomes=outcomes)
        self.page("--quantity", "height", "--over", "time.integrator", "time.step")
        drawn = [path.read_text(encoding="utf-8") for path in (self.path / "figures").iterdir()]
        self.assertEqual(len(drawn), 2)
        words = [set(re.findall(r"<text[^>]*>([^<]+)</text>", text)) for text in drawn]
        return words[0] & words[1]  # on the map and on the curves

    def test_every_length_of_a_shape_is_a_key(self) -> None:
        keys = (ROOT / "cases/KEYS.md").read_text(encoding="utf-8")
        for name in LENGTHS:
            self.assertIn(f"`{name}", keys)

    def test_sensitivities_are_shown_with_their_error(self) -> None:
        self.assertNotIn('id="sensitivity"', self.page_of(sensitivities=[]))
        one = {"quantity": "height", "parameter": "time.step", "samples": 60, "bins": 7}
        page = self.page_of(sensitivities=[one | {"index": 0.12345, "error": 0.0067},
                                           one | {"index": None, "error": None}])
        self.assertIn("0.123</td><td class=\"num\">0.007</td>", page)
        self.assertIn("none</td>", page)

    def page_of(self, **changed: Any) -> str:
        """The page of a campaign with these changes."""
        self.put(**changed)
        return self.page()

    def test_the_page_escapes_and_counts(self) -> None:
        finding = {"claim": "100 % <of> the runs", "outcome": "fails", "measured": None}
        finding |= {"bound": 2.0, "unit": "m", "why": "a wish", "note": "5 of 6", "name": "x"}
        self.put(findings=[finding])
        page = self.page()
        self.assertEqual(page, self.page())
        for said in ("Made &lt;up&gt;", "a &lt;bad&gt; step", "100 % &lt;of&gt; the", "a wish"):
            self.assertIn(said, page)
        self.assertIn("1 of 6 runs have no value", page)
        self.assertNotIn("<bad>", page)

    def test_without_figures_each_quantity_that_differs_is_drawn(self) -> None:
        self.put()
        self.assertEqual([f.quantity for f in figures_of(load_campaign(self.path))], ["height"])
        asked = {"quantity": "steps", "over": ["time.step"], "title": "t", "logarithmic": True}
        self.put(figures=[asked])
        self.assertEqual([f.quantity for f in figures_of(load_campaign(self.path))], ["steps"])

    def test_a_campaign_without_a_value_has_a_page(self) -> None:
        none = [[None, None]] * 6
        self.put(outcomes=["refused"] * 6, values=none, seconds=[None] * 6)
        self.assertIn("No quantity differs", self.page())
        self.put(outcomes=["missing"] * 6, values=none, seconds=[None] * 6, figures=[
            {"quantity": "tip", "over": ["time.step"], "title": "", "logarithmic": True}
        ])
        self.assertIn("no run has a value", self.page())

    def test_bad_input_is_one_line(self) -> None:
        self.assertIn("there is no such file", self.refusal())
        self.put()
        for words, why in (
            (["--quantity", "height"], "give --quantity and --over"),
            (["--quantity", "height", "--over", "mass"], "does not vary 'mass'; it varies time.st"),
            (["--quantity", "weight", "--over", "time.step"], "no run has the quantity 'weight'"),
        ):
            self.assertIn(why, self.refusal(*words))
        (self.path / "campaign.json").write_text('{"name": ')
        self.assertIn("campaign.json: ", self.refusal())
