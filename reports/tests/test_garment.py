"""Tests of what a page shows of a garment; run with reports/tests/test_views.py."""
from __future__ import annotations

import h5py
import numpy as np

from data.cloth_values import edges_of, rest_lengths
from data.garment import garment_of, warp_of
from make_report import make_report
from pictures.case_fields import fields_of
from pictures.garment_pictures import make_garment_view
from plots.pattern_plot import outlines, warp_strokes
from tests.made_up_case import WithCase
from tests.made_up_run import put

EASE = 0.25


class GarmentPages(WithCase):
    """The made-up square as two panels: the second one's side of the diagonal is longer."""

    def setUp(self) -> None:
        super().setUp()
        with h5py.File(self.path, "r+") as file:
            diagonal = np.sqrt(2) * (1 + EASE)
            flat = [[[0, 0], [1, 0], [0, 1]], [[3, 0], [4, 1], [3 + diagonal, 0]]]
            file["mesh/pattern"] = np.array(flat, float)
            put(file["mesh/pattern"], panels=2, ease=0.2, seams=diagonal)
            file["mesh/fabric"] = np.array([0, 1], np.int32)
            for k, density in enumerate((0.2, 0.4)):
                put(file.create_group(f"fabrics/{k}"), name="<b>knit"[3 * k:], density=density,
                    bending=1e-5, warp=300.0, weft=150.0, shear=60.0, direction=k * np.pi / 2)
            put(file.create_group("air"), density=1.2)
            file["air/wind"] = np.array([3.0, 0.0, 4.0])

    def test_a_seam_has_two_lengths_and_fabrics_their_masses(self) -> None:
        made = garment_of(self.case())
        self.assertEqual(len(made.seams), 1)
        self.assertAlmostEqual(made.seams[0].eased_percent, 100 * EASE, 5)
        self.assertAlmostEqual(made.fabrics[0].mass, 0.2 * 0.5)
        self.assertAlmostEqual(made.fabrics[1].area, 0.5 * np.sqrt(2) * (1 + EASE))
        np.testing.assert_allclose(warp_of(made, np.array([1])), [[0, 1]], atol=1e-12)

    def test_rest_lengths_are_those_of_the_panels(self) -> None:
        of = dict(zip(map(tuple, edges_of(self.case().triangles)), rest_lengths(self.case())))
        self.assertAlmostEqual(of[0, 1], 1.0)
        self.assertAlmostEqual(of[1, 2], np.sqrt(2) * (1 + EASE / 2))

    def test_outlines_and_strokes_are_those_of_the_panels(self) -> None:
        made = garment_of(self.case())
        loops = outlines(made.pattern)
        self.assertEqual(sorted(len(loop) for loop in loops), [3, 3])
        quarters = np.array([[[0, 0], [1, 0], [0, 1]], [[1, 0], [2, 0], [0, 2]],
                             [[1, 0], [0, 2], [0, 1]]], float)
        np.testing.assert_allclose(sorted(map(tuple, outlines(quarters)[0])),
                                   [(0, 0), (0, 2), (2, 0)])
        strokes = warp_strokes(made)
        self.assertGreater(len(strokes), 20)
        across, along = np.ptp(strokes, axis=1).T
        self.assertTrue(((strokes[:, 0, 0] > 2) == (along > 0.01)).all())
        self.assertTrue(((strokes[:, 0, 0] < 2) == (across > 0.01)).all())

    def test_the_page_names_fabrics_ease_and_wind(self) -> None:
        written = make_report(self.root, self.root / "report.html", self.root / "figures")
        page = written.read_text(encoding="utf-8")
        self.assert_all_in(("&lt;b&gt;knit", "The flat pattern: 2 panels", 'class="wind"',
                            'velocity (<span class="n">3</span>'), page)
        self.assertNotIn("<b>knit", page)
        self.assertIn("fabric, blue: <b>knit, orange: knit",
                      [field.label for field in fields_of(self.case(), [0, 1])])

    def test_a_case_without_these_parts_has_none_of_it(self) -> None:
        with h5py.File(self.path, "r+") as file:
            for name in ("mesh/pattern", "mesh/fabric", "fabrics", "air"):
                del file[name]
        self.assertIsNone(make_garment_view(self.case(), "fold", self.root))
        self.assertNotIn("fabric", [field.name for field in fields_of(self.case(), [0, 1])])
