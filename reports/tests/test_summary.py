"""Tests of the page of verdict: its words, its numbers, its sheet; run with
reports/tests/test_reports.py."""
from __future__ import annotations

import ast
import json
import re
import tempfile
from pathlib import Path
from unittest import mock

import h5py
import numpy as np

from make_report import make_summary
from pages.sentences import Number, Quoted, html_of, markdown_of
from tests.made_up_run import HOSTILE, TEXT, made_up_verdicts, put, put_claim, put_finding, put_run
from tests.report_test import REPORTS, FolderTest
from tests.test_browser import require_browser

MOST_WORDS = 450
SUPPORTS = (
    "stability-sheet.limit-does-not-depend-on-damping.both.A",
    "variable-step-stability.alternating-steps-resonate.A",
    "mesh-error.usual-step-error-is-below-a-tenth-of-it", "bending-rigidity.depends-on-pattern",
    "case.drop.never-crosses-itself", "case.drop.stays-outside",
    "pointwise-contact.a-thin-pin-passes-through"
)


def put_table(file: h5py.File, study: str, **columns: list) -> None:
    """Adds a study with one table; blanks of the names are written as underscores."""
    put(
        file.require_group(f"studies/{study}"), order=20, claim="", source="", about="", seconds=1.0
    )
    table = file.create_group(f"studies/{study}/tables/0")
    put(table, order=0, title=study)
    for order, (name, values) in enumerate(columns.items()):
        is_text = isinstance(values[0], str)
        kept = np.array(values, dtype=object if is_text else float)
        put(table.create_dataset(name, data=kept, dtype=TEXT if is_text else None), order=order,
            unit="%" if "error" in name else "1")


def put_priced_run(folder: Path, scale: float = 1.0) -> None:
    """A made-up run with all that conclusions are drawn from; its
    numbers are multiplied by `scale`."""
    put_run(folder)
    with h5py.File(folder / "run.h5", "a") as file:
        put(
            file, subject="foldproof reference", subject_version="9.8.7", tier="quick",
            date="2031-02-03T04:05:06Z"
        )
        for order, name in enumerate(SUPPORTS, start=30):
            put_finding(
                file, order, name, "check", measured=0.0137 * scale, bound=0.0171 * scale, unit="m"
            )
        put_table(
            file, "work-precision", scene=["a", "b"], error_wanted=[1.7 * scale] * 2,
            by=["work"] * 2, cheapest_method=["RK4", "B"], next_best=["A", "A"],
            it_costs_this_many_times_as_much=[1.31 * scale, 1.42 * scale],
            C_costs_this_many_times_as_much=[2.53 * scale, 3.64 * scale]
        )
        put_table(
            file, "stability-sheet", width_of_a_cell=[0.3 * scale, 0.123 * scale],
            schemes_A_and_B=[5.0, 17.9 * scale], forward_Euler=[60.0, 812.0 * scale]
        )
        put_table(
            file, "mesh-error", cells_along_a_side=[5.0, 19.0],
            error_of_the_mesh=[9.0, 0.457 * scale], error_of_the_step=[1.0, 0.00291 * scale]
        )
        put_table(
            file, "bending-rigidity", least=[0.219 * scale, 0.3], greatest=[0.4, 2.77 * scale]
        )
        put_table(file, "crossing-queries", asked=[7013.0, 11.0], missed=[0.0, 3.0])


class OnePage(FolderTest):
    """The summary of a made-up run."""

    def made(self, earlier: Path | None = None) -> tuple[str, str]:
        """Words of the page, and the Markdown."""
        with mock.patch("make_report.print_page"):  # a browser takes seconds
            outs = make_summary(self.root, earlier)
        text = outs[0].read_text(encoding="utf-8")
        body = re.sub(r"<[^>]+>", "", text[text.index("<body"):].replace("</dt>", " "))
        return re.sub(r"\s", " ", body), outs[1].read_text(encoding="utf-8")

    def test_every_number_is_that_of_the_run(self) -> None:
        for scale in (1.0, 1.1):
            with self.subTest(scale=scale), tempfile.TemporaryDirectory() as folder:
                self.root = Path(folder)
                put_priced_run(self.root, scale)
                for text in self.made():
                    for number in (
                        1.7, 2.53, 3.64, 1.31, 1.42, 0.123, 17.9, 812.0, 0.457, 0.00291, 0.219,
                        2.77, 0.0137
                    ):
                        digits = f"{number * scale:.0f}" if number > 99 else f"{number * scale:.3g}"
                        self.assertIn(digits[:4].rstrip("0"), text)
                    self.assert_all_in(("7024", "19", "9.8.7"), text)

    def test_methods_that_are_tied_win_together(self) -> None:
        put_run(self.root)
        with h5py.File(self.root / "run.h5", "a") as file:
            put_table(
                file, "work-precision", scene=["a", "b"], error_wanted=[1.7] * 2, by=["work"] * 2,
                cheapest_method=["RK4", "A"], next_best=["A", "B"],
                it_costs_this_many_times_as_much=[1.04, 1.5],
                C_costs_this_many_times_as_much=[2.5, 3.6], tied=["A", ""]
            )
        page, markdown = self.made()
        for text in (page, markdown):
            self.assertRegex(text, r"RK4\W+and \W*A\W+tied on")
            self.assertNotIn("No integrator is cheapest everywhere", text)

    def test_words_between_the_numbers_hold_no_digit(self) -> None:
        for name in ("conclusions", "solver_words", "summary"):
            tree = ast.parse((REPORTS / "pages" / f"{name}.py").read_text(encoding="utf-8"))
            sources = {
                id(one)
                for call in ast.walk(tree)
                if isinstance(call, ast.Call)
                and isinstance(call.func, ast.Name)
                and call.func.id in ("Number", "count_of")
                for one in ast.walk(call)
            }
            for one in ast.walk(tree):
                if (
                    isinstance(one, ast.Constant)
                    and isinstance(one.value, str)
                    and id(one) not in sources
                ):
                    self.assertNotRegex(one.value, r"\d", f"{name}.py:{one.lineno}")

    def test_it_is_read_in_two_minutes(self) -> None:
        put_priced_run(self.root)
        with h5py.File(self.root / "run.h5", "a") as file:
            for number in range(2, 9):
                put_claim(file, number, f"X{number}", "refuted", [])
                put(file[f"claims/X{number}"], statement="word " * 60)
        for text in self.made():
            words = [word for word in text.split() if re.search(r"\w", word)]
            self.assertLessEqual(len(words), MOST_WORDS)
            self.assertIn("X2", text)

    def test_a_conclusion_falls_with_its_finding(self) -> None:
        put_priced_run(self.root)
        for text in self.made():
            self.assertIn("Damping does not shorten the stable step", text)
        with h5py.File(self.root / "run.h5", "a") as file:
            file[f"findings/{SUPPORTS[0]}"].attrs["outcome"] = "fails"
            del file[f"findings/{SUPPORTS[2]}"]
        for text in self.made():
            self.assertNotIn("Damping does not shorten the stable step", text)
            self.assertRegex(text, rf"Not shown by this run: `?{SUPPORTS[0]}`? fails")
            self.assertNotIn("the mesh, not the step", text)

    def test_what_does_not_hold_is_named_first(self) -> None:
        put_priced_run(self.root)
        text, markdown = self.made()
        self.assertRegex(text, r"\d+ of \d+ findings hold; 1 fail")
        self.assertIn("`bending.damping-dissipates`", markdown[:markdown.index("## Scope")])

    def test_what_changed_since_an_earlier_run(self) -> None:
        put_priced_run(self.root)
        now, before = made_up_verdicts(), made_up_verdicts()
        before["program"]["date"] = "2026-11-21T06:51:18Z"
        before["findings"][1]["outcome"] = "holds"
        (self.root / "verdicts.json").write_text(json.dumps(now))
        (self.root / "before").mkdir()
        (self.root / "before" / "verdicts.json").write_text(json.dumps(before))
        for program in (now["program"], before["program"]):
            program["command"] = "build/foldproof verify"
        markdown = self.made(self.root / "before")[1]
        self.assertIn(
            "Since 2026-11-21 06:51 0123456: 1 worse, 0 new or changed otherwise; worse: `b`",
            markdown,
        )
        before["program"]["tier"] = "full"
        (self.root / "before" / "verdicts.json").write_text(json.dumps(before))
        self.assertIn("not comparable", self.made(self.root / "before")[1])

    def test_faults_are_run_or_not(self) -> None:
        put_priced_run(self.root)
        for outcome, said in (
            ("not run", "1 is listed; none was run"),
            ("SURVIVED", "Of 1 seeded fault 0 were caught, 1 survived"),
        ):
            with h5py.File(self.root / "run.h5", "a") as file:
                file["faults/outcome"][0] = outcome
            self.assertIn(said, self.made()[1])

    def test_nothing_is_asked_of_a_network_and_hostile_words_are_escaped(self) -> None:
        put_priced_run(self.root)
        with h5py.File(self.root / "run.h5", "a") as file:
            put(file, subject=HOSTILE)
        with mock.patch("make_report.print_page"):
            outs = make_summary(self.root, None)
        text = outs[0].read_text(encoding="utf-8")
        self.assertEqual(re.findall(r'(?:src|href)="|url\(|@import|<script|<link', text), [])
        self.assertNotIn("<img", text)
        self.assertNotRegex(outs[1].read_text(encoding="utf-8"), r"(?<!\\)<")

    def test_a_run_without_studies_has_a_page_too(self) -> None:
        put_run(self.root)
        (self.root / "run.h5").unlink()
        for text in self.made():
            self.assertIn("single simulations", text)

    def test_pieces_are_escaped(self) -> None:
        pieces = [
            "a < b ", Number(1e-7, "m^2", ""), " ", Quoted("<i>*x*", ""), " ",
            Quoted("a`b", "", is_name=True)
        ]
        self.assertIn("&lt;i&gt;", html_of(pieces))
        self.assertEqual(markdown_of(pieces), r"a < b 1×10⁻⁷ m² \<i\>\*x\* `a b`")

    def test_the_pdf_is_one_sheet(self) -> None:
        require_browser()
        put_priced_run(self.root)
        content = make_summary(self.root, None)[2].read_bytes()
        self.assertEqual(len(re.findall(rb"/Type\s*/Page\b", content)), 1)

    def test_without_a_browser_the_rest_is_written_and_a_line_says_so(self) -> None:
        put_priced_run(self.root)
        done = self.typed("make_report.py", self.root, "--summary", PATH=str(self.root))
        self.assertEqual(done.returncode, 0)
        self.assertEqual(done.stdout, f"{self.root}/summary.html\n{self.root}/summary.md\n")
        self.assertEqual(len(done.stderr.splitlines()), 1)
        self.assertIn("summary.pdf was not written", done.stderr)
