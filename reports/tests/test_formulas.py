"""Tests of formulas in sentences, of the record of seeded faults, and of drawings of set-ups."""
from __future__ import annotations

import json
import re
import unittest
import xml.etree.ElementTree as ElementTree
from dataclasses import replace

from data.edit_digest import edit_digest
from data.fault_record import commits_of, with_record
from data.formulas import formula_html, formula_text
from data.results import Fault
from data.unreadable import Unreadable
from pictures.sketches import HEIGHT, WIDTH, drawn_studies, sketch_of
from tests.report_test import FolderTest


class Formulas(unittest.TestCase):
    def test_powers_indices_and_greek_letters_are_set(self) -> None:
        times = "\u200a×\u200a"
        for plain, shown in (
            ("h of order dx^2 rho/kd", "h of order dx<sup>2</sup> ρ/kd"),
            ("d(theta)/dt = sum of u_i.v_i", "dθ/dt = sum of u<sub>i</sub>·v<sub>i</sub>"),
            ("sqrt(tau_s^2 + 4/omega^2)", "√(τ<sub>s</sub><sup>2</sup> + 4/ω<sup>2</sup>)"),
            ("e^(mu turn), M^{-1/2}", "e<sup>μ turn</sup>, M<sup>−1/2</sup>"),
            ("x <= 1e-12, 2.5e-7 +- .1", f"x ≤ 10<sup>−12</sup>, 2.5{times}10<sup>−7</sup> ± 0.1"),
            ("(h / 2 s)^1.99, x^-0.86, x^2. 4e-07",
             "(h / 2 s)<sup>1.99</sup>, x<sup>−0.86</sup>, x<sup>2</sup>. "
             f"4{times}10<sup>−7</sup>"),
            ("-0.5, a rate of -1.55 (-2e-3)", f"−0.5, a rate of −1.55 (−2{times}10<sup>−3</sup>)"),
            ("t^ and d^.", "t\u0302 and d\u0302."),
            ("m E_kin, h/h_limit", "m E<sub>kin</sub>, h/h<sub>limit</sub>"),
        ):
            self.assertEqual(formula_html(plain), shown)

    def test_words_names_and_settings_stay(self) -> None:
        for text in (
            "a picture of a method", "stays-within-strain-limits", "drape_sphere",
            "bending.stiffness=3e-4", "rhombus, taut, picks", "cases/hinge.toml", "v0.2.0",
            "pi-rate.x"
        ):
            self.assertEqual(formula_html(text), text)

    def test_text_is_escaped_once(self) -> None:
        self.assertEqual(formula_html("a < b & c^2"), "a &lt; b &amp; c<sup>2</sup>")
        self.assertEqual(formula_html(formula_html("a < b^2")), "a &lt; b<sup>2</sup>")

    def test_plots_have_unicode(self) -> None:
        self.assertEqual(
            formula_text("largest stable omega h, dx^-3, 1e-9"), "largest stable ω h, dx⁻³, 10⁻⁹"
        )


class FaultRecord(FolderTest):
    def setUp(self) -> None:
        super().setUp()
        self.file = self.root / "outcomes.json"
        self.fault = Fault(
            "slip", "reference/types.h", "a + b", "a - b", "sums", ["sums.add-up"], "not run",
            ["a test"]
        )
        lines = [f"abc caught 0123 {edit_digest(self.fault)}", "abc caught 4567", "def caught 89ab"]
        self.file.write_text(json.dumps(lines))

    def test_an_outcome_is_recalled_with_its_commit(self) -> None:
        [found] = with_record([self.fault], self.file)
        self.assertEqual((found.outcome, found.commit), ("caught", "abc"))
        self.assertEqual(commits_of([found, self.fault]), [("abc", 1)])

    def test_a_fault_that_was_edited_since_or_run_is_as_it_was(self) -> None:
        for edited in (
            {"find": "a * b"}, {"replace": "b - a"}, {"file": "reference/math.h"},
            {"caught_by": []}, {"caught_by_tests": []}, {"outcome": "SURVIVED"}
        ):
            other = replace(self.fault, **edited)
            self.assertEqual(with_record([other], self.file), [other])

    def test_a_record_may_be_missing_but_not_damaged(self) -> None:
        self.file.write_text('["abc"]')
        with self.assertRaisesRegex(Unreadable, "outcomes.json"):
            with_record([self.fault], self.file)
        self.file.unlink()
        self.assertEqual(with_record([self.fault], self.file), [self.fault])


class Sketches(unittest.TestCase):
    def test_each_is_whole_and_stays_in_its_box(self) -> None:
        for study in drawn_studies():
            sketch = sketch_of(study)
            root = ElementTree.fromstring(str(sketch.svg))
            self.assertEqual(root.get("aria-label"), sketch.words)
            for path in root.iter("path"):
                numbers = [float(number) for number in re.findall(r"-?[0-9.]+", path.get("d"))]
                self.assertTrue(all(0 <= x <= WIDTH for x in numbers[::2]), study)
                self.assertTrue(all(0 <= y <= HEIGHT for y in numbers[1::2]), study)
        self.assertIsNone(sketch_of("no-such-study"))
