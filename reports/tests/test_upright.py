"""Tests of where up is: a case that is turned as a whole, gravity with it, looks
the same. Run by test_views.py."""
from __future__ import annotations

import argparse
import shutil
import unittest
from pathlib import Path

import h5py
import numpy as np

from data.results import load_case
from make_film import film_of, picture_bytes
from make_report import make_report
from pages.chromium import Browser
from pictures.camera import up_against, upright_axes
from pictures.case_pictures import select_frames
from pictures.cloth_picture import picture_of
from tests.made_up_case import WithCase, in_the_view, put_whole_case

DOWN = np.array([0.0, -9.8, 0.0])
# takes y to z, and z to -y
QUARTERS = {"-z": np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]], dtype=float),
            # takes y to -x, and x to y
            "+x": np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]], dtype=float)}
ASLANT = np.array([[1, 0, 0], [0, 0.8, -0.6], [0, 0.6, 0.8]])                     # of an incline

TWO_LOOKS = in_the_view("""
  figure.querySelector(".open-view").click();
  await drawn(1);
  const first = await after(() => show(2));
  await after(() => press("ArrowUp"));
  await after(() => press("ArrowLeft"));
  return [first, await after(() => press("ArrowLeft"))];
""")


def put_turned_case(folder: Path, turn: np.ndarray) -> Path:
    """The made-up case, its ground and its gravity turned as a whole (3 x 3)."""
    folder.mkdir()
    path = put_whole_case(folder)
    with h5py.File(path, "r+") as file:
        del file["objects/0"]                       # its poses would have to be turned, too
        for name in (
            "frames/positions", "frames/velocities", "mesh/rest_positions", "objects/1/vertices",
            "objects/1/positions", "objects/2/vertices"
        ):
            turned = file[name][:] @ turn.T
            del file[name]
            file[name] = turned
        file["gravity"] = turn @ DOWN
    return path


class Upright(WithCase):
    """The made-up case with gravity along -y, beside the same turned."""

    def setUp(self) -> None:
        super().setUp()
        self.plain = put_turned_case(self.root / "plain", np.eye(3))

    def assert_alike(self, seen: np.ndarray, expected: np.ndarray) -> None:
        """Pictures of one shape whose values all but agree; roundings move
        outlines by a sample here and there."""
        self.assertEqual(seen.shape, expected.shape)
        self.assertGreater(len(np.unique(expected)), 20)
        self.assertLess((np.abs(seen.astype(int) - expected.astype(int)) > 8).mean(), 0.002)

    def test_axes_are_right_handed_and_up_is_against_gravity(self) -> None:
        for gravity in (
            *(turn @ DOWN for turn in QUARTERS.values()), ASLANT @ DOWN, -DOWN, DOWN,
            np.array([1e-9, 9.8, 0.0])
        ):
            axes = upright_axes(up_against(gravity))
            np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-15)
            self.assertGreater(np.linalg.det(axes), 0.99)
            np.testing.assert_allclose(axes[1] * np.linalg.norm(gravity), -gravity, atol=1e-14)
        np.testing.assert_array_equal(upright_axes(up_against(DOWN)), np.eye(3))
        for nothing in (None, np.zeros(3), np.array([np.nan, 0.0, 0.0])):
            np.testing.assert_array_equal(up_against(nothing), [0.0, 1.0, 0.0])

    def test_pictures_and_films_of_a_case_that_is_turned_are_the_same(self) -> None:
        def drawn(path: Path) -> tuple[np.ndarray, np.ndarray]:
            _, scene = select_frames(load_case(path))
            film = film_of(scene.case, argparse.Namespace(field=None, size=(320, 240), fps=5))
            frame = np.frombuffer(picture_bytes(film, 2), dtype=np.uint8)
            return picture_of(scene.cloth(2), scene.camera, scene.scenery(2)), frame
        expected = drawn(self.plain)
        for name, turn in QUARTERS.items():
            for seen, like in zip(drawn(put_turned_case(self.root / name, turn)), expected):
                self.assert_alike(seen, like)

    def test_the_camera_stands_upright_on_a_slope(self) -> None:
        camera, sloping = (select_frames(load_case(path))[1].camera
                           for path in (self.plain, put_turned_case(self.root / "aslant", ASLANT)))
        for axis, turned in zip(
            (camera.right, camera.up, camera.toward), (sloping.right, sloping.up, sloping.toward)
        ):
            np.testing.assert_allclose(turned, ASLANT @ axis, atol=1e-12)

    @unittest.skipUnless(shutil.which("chromium"), "no chromium: the package chromium has it")
    def test_the_view_of_a_case_that_is_turned_is_the_same_and_turns_about_its_up(self) -> None:
        def looks(path: Path) -> list[np.ndarray]:
            page = make_report(path.parent, path.parent / "report.html", path.parent / "figures")
            with Browser() as browser:
                browser.open(page, still=True)
                return [np.array(look) for look in browser.evaluate(TWO_LOOKS)]
        expected = looks(self.plain)
        self.assertGreater((np.abs(expected[0] - expected[1]) > 8).mean(), 0.02)
        for name, turn in QUARTERS.items():
            for seen, like in zip(looks(put_turned_case(self.root / name, turn)), expected):
                self.assert_alike(seen, like)
