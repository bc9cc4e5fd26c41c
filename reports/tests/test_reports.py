#!/usr/bin/python3
"""Tests of the report generator on small made-up runs: reports/tests/test_reports.py"""
from __future__ import annotations

import json
import re
import resource
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from html.parser import HTMLParser
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import h5py  # noqa: E402

from data.hdf5_values import plain  # noqa: E402
from data.results import load_case, load_run  # noqa: E402
from data.run_folder import read_folder  # noqa: E402
from data.unreadable import Unreadable  # noqa: E402
from make_report import make_report  # noqa: E402
from pages.drawing import draw_case  # noqa: E402
from pages.render import Anchors  # noqa: E402
from pages.trust import kinds_of, tolerances_of  # noqa: E402
from tests.made_up_run import (
    HOSTILE, NAMES, TEXT, put, put_case, put_finding, put_run, put_study
)  # noqa: E402
from tests.report_test import REPORTS, ReportTest  # noqa: E402


class Seen(HTMLParser):
    """Collects tags, ids and references of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.ids: list[str] = []
        self.references: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        for key, value in attrs:
            if key == "id":
                self.ids.append(value or "")
            if key in ("src", "href", "xlink:href", "srcset", "data", "poster", "action"):
                self.references.append(value or "")
            if key.startswith("on"):
                raise AssertionError(f"<{tag}> has the handler {key}")


class WholeReport(unittest.TestCase):
    """The report of a run with everything in it."""

    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.root = Path(folder.name)
        put_run(cls.root)
        cls.figures = cls.root / "figures"
        cls.text = cls.made("report.html")
        cls.seen = Seen(cls.text)
        cls.plots = re.findall(r'<svg class="plot".*?</svg>', cls.text, re.S)

    @classmethod
    def made(cls, name: str) -> str:
        page = make_report(cls.root, cls.root / name, cls.figures, for_papers=True)
        return page.read_text(encoding="utf-8")

    def row_of(self, anchor: str) -> str:
        return self.text[self.text.index(f'id="{anchor}"'):]

    def test_page_needs_nothing_beside_it(self) -> None:
        for reference in self.seen.references:
            self.assertRegex(reference, r"^(#|data:image/(webp|png);base64,)")
        self.assertNotRegex(self.text, r"url\((?!#)|@import")
        self.assertFalse({"link", "iframe", "object"} & set(self.seen.tags))
        self.assertNotRegex(self.text, "<script[^>]")

    def test_hostile_text_is_escaped_and_what_no_xml_may_hold_left_out(self) -> None:
        self.assertNotRegex(self.text, "<script>alert|<img src=x")
        self.assertIn("&lt;script&gt;", self.text)
        self.assertEqual(plain("a\udcff\x00\ufffe\n"), "a\ufffd\ufffd\ufffd\n")
        self.assertIn("g++ \ufffd\ufffd&lt;i&gt;", self.text)  # bytes that are no text
        figures = [path.read_text(encoding="utf-8") for path in self.figures.glob("*.svg")]
        self.assertTrue(figures and self.plots)
        for text in (self.text, *figures):
            self.assertNotRegex(text, "[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ufffe\uffff]")
        for text in (*figures, *re.findall(r"<svg.*?</svg>", self.text, re.S)):
            elements = ElementTree.fromstring(text.encode("utf-8")).iter()
            tags = {element.tag.rpartition("}")[2] for element in elements}
            self.assertFalse({"script", "img", "b", "i", "foreignObject"} & tags)

    def test_inline_figures_hold_nothing_that_no_reader_sees(self) -> None:
        for svg in self.plots:
            named = set(re.findall(r'(?:href="|url\()#([^")]+)', svg))
            self.assertEqual(set(re.findall(r' id="([^"]+)"', svg)), named)
            self.assertNotRegex(svg, r"<g>|<style|<metadata|<!--")
            for key in ("d", "x", "y", "width", "height"):
                self.assertNotRegex(svg, rf' {key}="[^"]*\.\d{{3}}')
        files = [
            path.read_text(encoding="utf-8")
            for path in self.figures.glob("*.svg")
            if not path.stem.endswith(("-pictures", "-field"))
        ]
        self.assertEqual(len(self.plots), len(files))
        inline, whole = (
            len(re.sub(r'"data:[^"]*"', "", "".join(texts))) for texts in (self.plots, files)
        )
        self.assertLess(inline, 2 / 3 * whole)

    def test_every_finding_has_its_anchor_and_links_lead_somewhere(self) -> None:
        anchors = Anchors()
        self.assertLessEqual({NAMES[0], *map(anchors.of, NAMES)}, set(self.seen.ids))
        self.assertEqual(len(self.seen.ids), len(set(self.seen.ids)))
        inside = {reference[1:] for reference in self.seen.references if reference[:1] == "#"}
        self.assertLessEqual(inside, set(self.seen.ids))

    def test_a_row_shows_nan_as_such_and_faults_as_listed_and_caught(self) -> None:
        for anchor, label, shown in ((NAMES[1], "measured", "NaN"), (NAMES[0], "faults", "1 / 1")):
            cell = re.search(rf'data-label="{label}">(.*?)</span>', self.row_of(anchor))
            self.assertIn(shown, cell[1])

    def test_claims_link_to_their_findings_and_say_what_was_recorded(self) -> None:
        first, second = self.row_of("T1").split('id="T17"')[:2]
        self.assertIn(f'href="#{NAMES[0]}"', first)
        self.assertIn("not in this run", first)
        self.assertNotIn("rules otherwise", first)
        self.assertIn("rules otherwise than recorded", second)

    def test_what_plots_leave_out_is_said(self) -> None:
        self.assertIn("Hatched: 3 of 20 points", self.text)
        self.assertRegex(self.text, r">\s*diverged\s*<")
        self.assertIn("Hollow: a solve on the way of that run did not finish.", self.text)
        self.assertNotIn("point not drawn", self.row_of("study-time-order"))
        self.assertIn("gone.h5 could not be read", self.text)

    def test_figures_are_written_and_the_same_input_gives_the_same_page(self) -> None:
        for name in (
            "time-order-x", "stability-oscillator-radius", "fold-pictures", "fold-energies",
            "fold-momenta", "fold-solves"
        ):
            for kind in ("svg", "pdf", "png"):
                self.assertGreater((self.figures / f"{name}.{kind}").stat().st_size, 500, name)
        self.assertEqual(self.made("again.html"), self.text)


class PartsMissing(ReportTest):
    """Runs that lack parts."""

    def test_each_part_may_be_all_that_there_is(self) -> None:
        for file, order, kind, name in (
            ("run.h5", None, "", ""), ("run.h5", 1, "check", NAMES[0]),
            ("bench.h5", 1, "bench", NAMES[4])
        ):
            with h5py.File(self.root / file, "w") as written:
                if name:
                    put_finding(written, order, name, kind, outcome="measured", better="lower")
            text = self.made()
            self.assertNotRegex(text, 'id="(cases|studies)"')
            self.assertIn(name, Seen(text).ids + [""])
            self.assertEqual("targets that no verdict depends on" in text, kind == "bench")
            (self.root / file).unlink()
        put_case(self.root, "fold")
        text = self.made()
        self.assertIn('id="case-fold"', text)
        self.assertNotIn("Not of this run", text)

    def test_a_case_file_of_another_run_is_named(self) -> None:
        put_run(self.root)
        self.assertIn("Not of this run", self.made())
        with h5py.File(self.root / "run.h5") as file, h5py.File(
            self.root / "fold.h5", "r+"
        ) as case:
            put(case, command=file.attrs["command"], commit=file.attrs["commit"])
        self.assertNotIn("Not of this run", self.made())

    def test_faults_that_were_not_run_are_said_once(self) -> None:
        put_run(self.root)
        with h5py.File(self.root / "run.h5", "r+") as file:
            file["faults/outcome"][0] = "not run"
        text = self.made()
        row = text[text.index(f'id="{NAMES[0]}"'):]
        self.assertEqual(re.search(r'data-label="faults">(.*?)</span>', row)[1], "1")
        self.assertEqual(len(re.findall(r"[Nn]ot run", text)), 1)

    def test_a_run_that_never_ended_is_not_taken_for_the_one_before(self) -> None:
        put_run(self.root)
        self.assertNotIn("did not finish: ", self.made())
        findings = [{"name": name, "outcome": "did not run"} for name in "ab"]
        told = {"program": {"date": HOSTILE}, "findings": findings}
        (self.root / "verdicts.json").write_text(json.dumps(told))
        text = self.made()
        self.assertIn("did not finish: 2 checks, studies and cases", text)
        Seen(text)

    def test_simulations_without_a_run_bring_what_was_expected_of_them(self) -> None:
        for name in ("fold", "other"):
            put_case(self.root, name)
        with h5py.File(self.root / "fold.h5", "a") as file:
            put_finding(
                file, 0, "case.fold.keeps-its-place", "check", outcome="fails", measured=2.0,
                bound=1.0, why_bound="a <reason>"
            )
            put(file, commit="another")
        text = self.made()
        self.assertIn("simulations, and what was expected of them", text)
        self.assertIn("a &lt;reason&gt;", text)
        self.assertIn('class="command">build/foldproof run cases/fold.toml</code>', text)
        self.assertNotIn("abcdef", self.section("provenance"))  # of one simulation, not of both
        Seen(text)

    def test_tolerances_begin_with_the_tightest(self) -> None:
        put_run(self.root)
        ranked = tolerances_of(load_run(self.root / "run.h5").findings).ranked
        used = [entry.used for entry in ranked]
        self.assertEqual(used, sorted(used, reverse=True))
        self.assertTrue(all(entry.finding.outcome != "measured" for entry in ranked))
        self.assertNotIn(NAMES[1], [entry.finding.name for entry in ranked])  # NaN has no margin

    def test_labels_are_counted_and_empirical_bounds_listed(self) -> None:
        with h5py.File(self.root / "run.h5", "w") as file:
            for order, (name, kind, *said) in enumerate((
                ("case.a.runs-to-its-end", "check", "generic", "counted", "reasoned"),
                ("b.c", "check", "specific", "computed", "empirical"),
                ("d.e", "bench", "specific", "timed once", "empirical"),
                ("f.g", "check", "specific", "computed", "reasoned"),
            )):
                put_finding(
                    file, order, name, kind, outcome="holds" if kind == "check" else "measured",
                    **dict(zip(("scope", "certainty", "basis"), said))
                )
        kinds = kinds_of(load_run(self.root / "run.h5").findings)
        self.assertEqual(kinds.judged, 3)
        self.assertEqual(kinds.scopes, [("specific", 2), ("generic", 1)])
        self.assertEqual(kinds.certainties, [("computed", 2), ("counted", 1)])
        self.assertEqual([finding.name for finding in kinds.empirical], ["b.c"])

    def put_outcomes(self) -> None:
        """Outcomes as scripts/faults and scripts/mutate write them."""
        said = [
            dict(name=NAMES[0], outcome="fails", measured=3.0, bound=0.5, margin=6.0),
            dict(name=NAMES[1], outcome="holds", measured=0.1, bound=0.5, margin=0.2),
            dict(name=f"a test {HOSTILE}", outcome="fails", measured=None, bound=None, margin=None)
        ]
        rows = [dict(name="flipped-sign", outcome="SURVIVED", seconds=1, checks=said)]
        (self.root / "faults.json").write_text(json.dumps({"faults": rows}))
        counts = dict(
            mutants=9, not_compiled=1, same_code=2, killed=5, by={"check": 4, "clock": 1},
            survived=1, equivalent=0, score=5 / 6
        )
        mutant = dict(
            file="a.cpp", line=7, kind="operator", before=HOSTILE, after="a - b",
            outcome="SURVIVED", by="", what="", seconds=1
        )
        (self.root / "mutation.json").write_text(
            json.dumps({"seed": 3, "files": [{"file": "a.cpp"} | counts], "mutants": [mutant]})
        )

    def test_the_kill_matrix_and_the_mutation_score_are_shown_where_they_are_known(self) -> None:
        put_run(self.root)
        self.assertNotRegex(self.made(), 'id="(kill-matrix|mutation)"')
        self.put_outcomes()
        text = self.made()
        self.assertNotIn("<script>alert", text)
        matrix = text[text.index('<section id="kill-matrix"'):]
        self.assertRegex(
            matrix, r'<td class="num missed" title="[^"]*fails, [^"]*holds">1<small>[^/]*6[^/]*</'
        )
        self.assertRegex(matrix, r'<td class="num" title="a test [^"]*: fails">1</td>')
        self.assert_all_in(("check 4, clock 1", "83.3 %", "a.cpp:7"), text)

    def test_the_errors_of_a_case_alone(self) -> None:
        with h5py.File(self.root / "converge.h5", "w") as file:
            put_study(file)
            study = "studies/converge.strip.C.in-time"
            file.move("studies/time-order", study)
            put(file[study], claim="The step puts positions off by 3 mm.")
            figure = file[f"{study}/figures/x"]
            for curve in figure["curves"].values():
                curve.pop("marks", None)
                curve.create_dataset("marks", data=["unfinished"] * len(curve["x"]), dtype=TEXT)
            put(figure, caption="Hollow: outside the asymptotic range.")
        text = self.made()
        self.assert_all_in(
            ("how large the errors of a case are", "The step puts positions off by 3 mm."), text
        )
        self.assertNotIn("a solve on the way", text)  # the caption says what hollow means

    def test_a_file_name_in_a_run_leads_nowhere(self) -> None:
        put_run(self.root)
        with h5py.File(self.root / "run.h5", "r+") as file:
            put(file["cases/gone"], file="../../../etc/passwd")
        cases = load_run(self.root / "run.h5").cases
        self.assertEqual({case.path.parent for case in cases}, {self.root})

    def test_damaged_files_are_refused_or_named_on_the_page(self) -> None:
        put_run(self.root)
        entry = load_run(self.root / "run.h5").cases[0]
        (self.root / "fold.h5").write_bytes((self.root / "fold.h5").read_bytes()[:3000])
        self.assertIn("fold.h5 could not be read", draw_case(entry, self.root, 1000).problem)
        put_case(self.root, "fold")
        with h5py.File(self.root / "fold.h5", "r+") as file:
            file["mesh/triangles"][0] = [0, 1, 1000]
        self.assertIn("fold.h5 could not be drawn", draw_case(entry, self.root, 1000).problem)
        (self.root / "run.h5").write_bytes(b"no HDF5")
        with self.assertRaises(Unreadable):
            self.made()

    def test_a_page_that_cannot_be_written_leaves_the_old_one(self) -> None:
        put_run(self.root)
        page = self.root / "report.html"
        page.write_text("as it was")
        limit = subprocess.run(
            [sys.executable, str(REPORTS / "make_report.py"), str(self.root)], capture_output=True,
            text=True, check=False,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))
        )
        self.assert_refused(limit, "File too large")
        self.assertEqual(page.read_text(), "as it was")
        self.assertFalse(list(self.root.rglob("*.partial")))

    def test_a_folder_without_results_is_refused(self) -> None:
        with self.assertRaises(FileNotFoundError):
            read_folder(self.root)

    def test_the_loader_gives_numpy(self) -> None:
        put_run(self.root)
        run, case = load_run(self.root / "run.h5"), load_case(self.root / "fold.h5")
        self.assertEqual([finding.name for finding in run.findings], list(NAMES))
        self.assertEqual(case.positions(-1).shape, (4, 3))
        self.assertEqual(run.faults[0].caught_by, [NAMES[0], NAMES[2], "gone.check"])


def load_tests(loader: unittest.TestLoader, tests: unittest.TestSuite,
               _: str | None) -> unittest.TestSuite:
    """This file's tests, and those of the files named here, which are run with it."""
    names = ("page", "browser", "compare", "history", "needs", "errors", "pieces", "results",
             "summary", "site", "formulas", "campaign_page", "trials", "trust")
    tests.addTests(loader.loadTestsFromNames([f"tests.test_{name}" for name in names]))
    return tests


if __name__ == "__main__":
    unittest.main()
