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
REPORTS = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(REPORTS))

import h5py  # noqa: E402

from data.hdf5_values import plain  # noqa: E402
from data.results import load_case, load_run  # noqa: E402
from data.unreadable import Unreadable  # noqa: E402
from make_report import make_report, read_folder  # noqa: E402
from pages.page import Anchors  # noqa: E402
from pages.trust import kinds_of, tolerances_of  # noqa: E402
from tests.made_up_run import (
    HOSTILE, NAMES, TEXT, put, put_case, put_finding, put_run, put_study
)  # noqa: E402
from tests.report_test import ReportTest  # noqa: E402


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
        cls.folder = tempfile.TemporaryDirectory()
        root = Path(cls.folder.name)
        put_run(root)
        cls.figures = root / "figures"
        cls.text = make_report(root, root / "report.html", cls.figures, for_papers=True).read_text(
            encoding="utf-8"
        )
        cls.seen = Seen(cls.text)

    @classmethod
    def tearDownClass(cls) -> None:
        cls.folder.cleanup()

    def test_page_needs_nothing_beside_it(self) -> None:
        for reference in self.seen.references:
            self.assertRegex(reference, r"^(#|data:image/(webp|png);base64,)")
        self.assertNotRegex(self.text, r"url\((?!#)")
        self.assertNotIn("@import", self.text)
        self.assertFalse({"link", "iframe", "object"} & set(self.seen.tags))
        self.assertEqual(
            re.findall("<script[^>]*>", self.text), ["<script>"] * self.text.count("<script")
        )

    def test_hostile_text_is_escaped(self) -> None:
        self.assertNotIn("<script>alert", self.text)
        self.assertNotIn("<img src=x", self.text)
        self.assertIn("&lt;script&gt;", self.text)

    def test_what_no_xml_may_hold_is_in_no_page_and_no_figure(self) -> None:
        no_text = "[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ufffe\uffff]"
        self.assertIsNone(re.search(no_text, self.text))
        figures = list(self.figures.glob("*.svg"))
        self.assertTrue(figures)
        for path in figures:
            text = path.read_text(encoding="utf-8")
            self.assertIsNone(re.search(no_text, text), path.name)
            tags = {
                element.tag.rpartition("}")[2]
                for element in ElementTree.fromstring(text.encode("utf-8")).iter()
            }
            self.assertFalse({"script", "img", "b", "i"} & tags, path.name)

    def test_bytes_that_are_no_text_are_shown_as_such(self) -> None:
        self.assertEqual(plain("a\udcff\x00\ufffe\n"), "a\ufffd\ufffd\ufffd\n")
        self.assertIn("g++ \ufffd\ufffd&lt;i&gt;", self.text)

    def test_inline_figures_are_well_formed_and_hold_text_only(self) -> None:
        for svg in re.findall(r"<svg.*?</svg>", self.text, re.S):
            names = {element.tag for element in ElementTree.fromstring(svg).iter()}
            self.assertFalse({"script", "img", "b", "i", "foreignObject"} & names)

    def test_inline_figures_hold_nothing_that_no_reader_sees(self) -> None:
        plots = re.findall(r'<svg class="plot".*?</svg>', self.text, re.S)
        self.assertTrue(plots)
        for svg in plots:
            named = set(re.findall(r'(?:href="|url\()#([^")]+)', svg))
            self.assertEqual(set(re.findall(r' id="([^"]+)"', svg)), named)
            self.assertNotRegex(svg, r"<g>|<style|<metadata|<!--")
            for key in ("d", "x", "y", "width", "height"):
                self.assertNotRegex(svg, rf' {key}="[^"]*\.\d{{3}}')

    def test_inline_figures_are_a_third_smaller_than_their_files(self) -> None:
        plots = re.findall(r'<svg class="plot".*?</svg>', self.text, re.S)
        drawn = [
            path
            for path in self.figures.glob("*.svg")
            if not path.stem.endswith(("-pictures", "-field"))
        ]
        self.assertEqual(len(plots), len(drawn))
        without_images = [
            len(re.sub(r'"data:[^"]*"', "", text))
            for text in (
                "".join(plots),
                "".join(path.read_text(encoding="utf-8") for path in drawn),
            )
        ]
        self.assertLess(without_images[0], 2 / 3 * without_images[1])

    def test_every_finding_has_its_own_anchor(self) -> None:
        anchors = Anchors()
        for name in NAMES:
            self.assertEqual(self.seen.ids.count(anchors.of(name)), 1, name)
        self.assertIn(NAMES[0], self.seen.ids)

    def test_ids_are_unique_and_links_lead_somewhere(self) -> None:
        self.assertEqual(len(self.seen.ids), len(set(self.seen.ids)))
        for reference in self.seen.references:
            if reference.startswith("#"):
                self.assertIn(reference[1:], self.seen.ids)

    def test_nan_is_shown_as_nan(self) -> None:
        row = self.text[self.text.index(f'id="{NAMES[1]}"'):]
        measured = re.search(r'data-label="measured">(.*?)</span>', row)
        self.assertIsNotNone(measured)
        self.assertIn("NaN", measured[1])

    def test_claims_link_to_their_findings(self) -> None:
        first = self.text.index('id="T1"')
        row = self.text[first:self.text.index('id="T17"')]
        self.assertIn(f'href="#{NAMES[0]}"', row)
        self.assertIn("not in this run", row)
        self.assertNotIn("rules otherwise", row)

    def test_a_ruling_other_than_recorded_is_said(self) -> None:
        self.assertIn("rules otherwise than recorded", self.text[self.text.index('id="T17"'):])

    def test_studies_for_the_choice_of_an_integrator_come_first(self) -> None:
        places = [
            self.text.index(text)
            for text in (
                'id="studies"', 'id="integrators"', 'id="study-stability-oscillator"',
                'id="study-time-order"'
            )
        ]
        self.assertEqual(places, sorted(places))

    def test_points_of_a_map_without_a_value_are_counted(self) -> None:
        self.assertIn("Hatched: 3 of 20 points", self.text)

    def test_diverged_runs_have_their_strip_and_hollow_markers_are_explained(self) -> None:
        self.assertRegex(self.text, r">\s*diverged\s*<")
        self.assertIn("Hollow: a solve on the way of that run did not finish.", self.text)
        self.assertNotIn("point not drawn", self.text[self.text.index('id="study-time-order"'):])

    def test_epsilon_is_defined_once(self) -> None:
        self.assertEqual(self.text.count("<dfn"), 1)

    def test_faults_are_counted_as_listed_and_caught(self) -> None:
        row = self.text[self.text.index(f'id="{NAMES[0]}"'):]
        self.assertEqual(re.search(r'data-label="faults">(.*?)</span>', row)[1], "1 / 1")

    def test_missing_case_is_named(self) -> None:
        self.assertIn("gone.h5 could not be read", self.text)

    def test_figures_are_written(self) -> None:
        for name in (
            "time-order-x", "stability-oscillator-radius", "fold-pictures", "fold-energies",
            "fold-momenta", "fold-solves"
        ):
            for kind in ("svg", "pdf", "png"):
                self.assertGreater((self.figures / f"{name}.{kind}").stat().st_size, 500, name)

    def test_same_input_gives_the_same_page(self) -> None:
        root = Path(self.folder.name)
        again = make_report(root, root / "again.html", root / "again", for_papers=True).read_text(
            encoding="utf-8"
        )
        self.assertEqual(again, self.text)


class PartsMissing(ReportTest):
    """Runs that lack parts."""

    def test_checks_alone(self) -> None:
        with h5py.File(self.root / "run.h5", "w") as file:
            put_finding(file, 1, NAMES[0], "check")
        text = self.made()
        self.assertIn(NAMES[0], Seen(text).ids)
        self.assertNotIn('id="cases"', text)
        self.assertNotIn('id="studies"', text)

    def test_empty_run(self) -> None:
        h5py.File(self.root / "run.h5", "w").close()
        self.assertIn("</html>", self.made())

    def test_case_files_alone(self) -> None:
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
        findings = [
            {"name": "a", "outcome": "did not run"},
            {"name": "b", "outcome": "did not run"},
        ]
        told = {"program": {"date": HOSTILE}, "findings": findings}
        (self.root / "verdicts.json").write_text(json.dumps(told))
        self.assertIn("did not finish: 2 checks, studies and cases", self.made())
        Seen(self.made())

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
        self.assertRegex(
            text,
            (
                r"<dt>Reproduce</dt><dd><code class=\"command\">build/foldproof run"
                r" cases/fold.toml</code>"
            ),
        )
        provenance = re.search(r'<section id="provenance">.*?</section>', text, re.DOTALL)[0]
        self.assertNotIn("abcdef", provenance)          # of one simulation, not of both
        Seen(text)

    def test_tolerances_begin_with_the_tightest(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            put_run(Path(folder))
            findings = load_run(Path(folder) / "run.h5").findings
        ranked = tolerances_of(findings).ranked
        self.assertEqual(
            [entry.used for entry in ranked], sorted((entry.used for entry in ranked), reverse=True)
        )
        self.assertTrue(all(entry.finding.outcome != "measured" for entry in ranked))
        self.assertNotIn(NAMES[1], [entry.finding.name for entry in ranked])  # NaN has no margin

    def test_labels_are_counted_and_empirical_bounds_listed(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            with h5py.File(root / "run.h5", "w") as file:
                put_finding(
                    file, 0, "case.a.runs-to-its-end", "check", scope="generic",
                    certainty="counted", basis="reasoned"
                )
                put_finding(
                    file, 1, "b.c", "check", scope="specific", certainty="computed",
                    basis="empirical", why_bound="empirical: seen"
                )
                put_finding(
                    file, 2, "d.e", "bench", outcome="measured", scope="specific",
                    certainty="timed once", basis="empirical"
                )
                put_finding(
                    file, 3, "f.g", "check", scope="specific", certainty="computed",
                    basis="reasoned"
                )
            kinds = kinds_of(load_run(root / "run.h5").findings)
        self.assertEqual(kinds.judged, 3)
        self.assertEqual(kinds.scopes, [("specific", 2), ("generic", 1)])
        self.assertEqual(kinds.certainties, [("computed", 2), ("counted", 1)])
        self.assertEqual([finding.name for finding in kinds.empirical], ["b.c"])
        self.assertAlmostEqual(kinds.empirical_percent(), 100 / 3)

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

    def test_the_kill_matrix_shows_what_failed_and_by_how_much(self) -> None:
        put_run(self.root)
        self.assertNotIn('id="kill-matrix"', self.made())
        self.put_outcomes()
        text = self.made()
        self.assertNotIn("<script>alert", text)
        matrix = text[text.index('<section id="kill-matrix"'):]
        self.assertRegex(
            matrix, r'<td class="num missed" title="[^"]*fails, [^"]*holds">1<small>[^/]*6[^/]*</'
        )
        self.assertRegex(matrix, r'<td class="num" title="a test [^"]*: fails">1</td>')

    def test_the_mutation_score_is_shown_where_it_is_known(self) -> None:
        put_run(self.root)
        self.assertNotIn('id="mutation"', self.made())
        self.put_outcomes()
        text = self.made()
        self.assertIn("check 4, clock 1", text)
        self.assertIn("83.3 %", text)
        self.assertIn("a.cpp:7", text)

    def test_bench_alone(self) -> None:
        with h5py.File(self.root / "bench.h5", "w") as file:
            put_finding(file, 1, NAMES[4], "bench", outcome="measured", better="lower")
        self.assertIn("targets that no verdict depends on", self.made())

    def test_the_errors_of_a_case_alone(self) -> None:
        with h5py.File(self.root / "converge.h5", "w") as file:
            put_study(file)
            file.move("studies/time-order", "studies/converge.strip.C.in-time")
            file["studies/converge.strip.C.in-time"].attrs[
                "claim"
            ] = "The step puts positions off by 3 mm."
            figure = file["studies/converge.strip.C.in-time/figures/x"]
            for curve in figure["curves"].values():
                if "marks" in curve:
                    del curve["marks"]
                curve.create_dataset("marks", data=["unfinished"] * len(curve["x"]), dtype=TEXT)
            figure.attrs["caption"] = "Hollow: outside the asymptotic range."
        text = self.made()
        self.assertIn("how large the errors of a case are", text)
        self.assertIn("The step puts positions off by 3 mm.", text)
        self.assertIn("outside the asymptotic range", text)
        self.assertNotIn("a solve on the way", text)

    def test_a_file_name_in_a_run_leads_nowhere(self) -> None:
        put_run(self.root)
        with h5py.File(self.root / "run.h5", "r+") as file:
            put(file["cases/gone"], file="../../../etc/passwd")
        self.assertEqual(
            {case.path.parent for case in load_run(self.root / "run.h5").cases}, {self.root}
        )

    def test_damaged_files_are_refused_or_named_on_the_page(self) -> None:
        put_run(self.root)
        (self.root / "fold.h5").write_bytes((self.root / "fold.h5").read_bytes()[:3000])
        self.assertIn("fold.h5 could not be read", self.made())
        put_case(self.root, "fold")
        with h5py.File(self.root / "fold.h5", "r+") as file:
            file["mesh/triangles"][0] = [0, 1, 1000]
        self.assertIn("fold.h5 could not be drawn", self.made())
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
        self.assertEqual(limit.returncode, 2)
        self.assertEqual(len(limit.stderr.strip().splitlines()), 1, limit.stderr)
        self.assertIn("File too large", limit.stderr)
        self.assertEqual(page.read_text(), "as it was")
        self.assertFalse(list(self.root.rglob("*.partial")))

    def test_empty_folder_is_refused(self) -> None:
        with self.assertRaises(FileNotFoundError):
            read_folder(self.root)

    def test_loader_gives_numpy(self) -> None:
        put_run(self.root)
        run, case = load_run(self.root / "run.h5"), load_case(self.root / "fold.h5")
        self.assertEqual([finding.name for finding in run.findings], list(NAMES))
        self.assertEqual(case.positions(-1).shape, (4, 3))
        self.assertEqual(run.faults[0].caught_by, [NAMES[0], NAMES[2], "gone.check"])


def load_tests(loader: unittest.TestLoader, tests: unittest.TestSuite,
               _: str | None) -> unittest.TestSuite:
    """This file's tests, and those of the files named here, which are run with it."""
    names = ("page", "compare", "history", "needs", "errors", "pieces", "results", "summary",
             "site", "formulas", "campaign_page", "trials", "trust")
    tests.addTests(loader.loadTestsFromNames([f"tests.test_{name}" for name in names]))
    return tests


if __name__ == "__main__":
    unittest.main()
