"""Tests of numbers, labels, tables and maps by themselves; run with
reports/tests/test_reports.py."""
from __future__ import annotations

import re
import unittest

import numpy as np

from data.quantities import (
    cells_html, number_text, order_html, quantity_html, quantity_text, unit_text
)
from data.results import load_run
from pages.counts import margin_percent
from plots.contact_maps import flatten_to_plane
from plots.map_plots import edges_of
from tests.made_up_run import put_run
from tests.report_test import FolderTest


class Pieces(FolderTest):
    """Numbers, labels and pictures by themselves."""

    def test_numbers(self) -> None:
        written = {
            1.234e-14: "1.23×10⁻¹⁴", -0.5: "−0.5", 12345.0: "12\u202f345", 0.0: "0",
            0.10421: "0.104", float("nan"): "NaN", float("-inf"): "−∞", 1e-9: "1×10⁻⁹",
            2.5e9: "2.5×10⁹"
        }
        for value, text in written.items():
            self.assertEqual(number_text(value), text)
        self.assertEqual(unit_text("kg m^2/s"), "kg m²/s")
        self.assertEqual(unit_text("m^(-2)"), "m⁻²")
        self.assertEqual(unit_text("of (1 + a^2) times the size"), "of (1 + a²) times the size")
        self.assertIn(">1.00001<", quantity_html(1.0000096, "1", beside=1.0))
        self.assertIn(">1.00<", quantity_html(1.0000096, "1", beside=2.0))
        self.assertIn("<sup>−9</sup>", quantity_html(1e-9, "N"))
        self.assertEqual((quantity_text(0.5, "m/s"), quantity_text(0.5, "1")), ("0.5 m/s", "0.5"))

    def test_numbers_that_were_written_keep_their_digits(self) -> None:
        for text, shown in (
            ("-0.0424239822", "−0.0424239822"),
            ("1.50e-05", "1.50\u200a×\u200a10<sup>−5</sup>"),
            ("0.10", "0.10"),
            ("12345e67", "12345e67"),  # may be a commit
            ("-", "-"),
        ):
            said = str(cells_html([text, "a word"])[0])
            self.assertEqual(re.sub("</?span[^>]*>", "", said), shown)
        self.assertIn("–", order_html(float("nan")))

    def test_cells_of_a_map_lie_around_their_points(self) -> None:
        for places, scale, edges in (
            ([1.0, 2.0, 4.0], "linear", [0.5, 1.5, 3.0, 5.0]), ([1.0, 100.0], "log", [0.1, 10, 1e3])
        ):
            np.testing.assert_allclose(edges_of(np.array(places), scale), edges)

    def test_margin_bar_says_nothing_about_nan(self) -> None:
        put_run(self.root)
        findings = load_run(self.root / "run.h5").findings
        self.assertIsNone(margin_percent(findings[1]))
        self.assertAlmostEqual(margin_percent(findings[0]), 100 * 3.2 / 44 / 1.25)


class ContactMaps(unittest.TestCase):
    def test_a_tube_is_unrolled_and_a_flat_sheet_keeps_its_shape(self) -> None:
        angles, heights = np.meshgrid(np.linspace(-np.pi, np.pi, 25)[:-1], np.linspace(0.0, 0.5, 5))
        tube = np.column_stack(
            [0.2 * np.cos(angles.ravel()), heights.ravel(), 0.2 * np.sin(angles.ravel())]
        )
        flat = flatten_to_plane(tube)
        np.testing.assert_allclose(np.ptp(flat, axis=0), [0.2 * 2 * np.pi * 23 / 24, 0.5])
        sheet = np.column_stack([angles.ravel(), heights.ravel(), np.full(angles.size, 0.3)])
        np.testing.assert_array_equal(flatten_to_plane(sheet), sheet[:, :2])

    def test_a_shape_that_cannot_be_laid_flat_has_no_map(self) -> None:
        self.assertIsNone(flatten_to_plane(np.random.default_rng(5).normal(size=(50, 3))))
