#!/usr/bin/python3
"""Tests of what shows cloth: pictures, fields, the view in the page, films, exported files:
reports/tests/test_views.py"""
from __future__ import annotations

import base64
import json
import shutil
import sys
import unittest
import zlib
from io import BytesIO
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import h5py  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib import image  # noqa: E402

from data.cloth_values import all_values, edges_of  # noqa: E402
from make_report import make_report  # noqa: E402
from pages.chromium import Browser  # noqa: E402
from pictures.camera import choose_camera  # noqa: E402
from pictures.case_fields import fields_of, most_telling  # noqa: E402
from pictures.case_scene import CaseScene  # noqa: E402
from pictures.cloth_picture import Cloth, Scenery, picture_of, webp_bytes  # noqa: E402
from pictures.look import BACK, FRONT  # noqa: E402
from plots.angle_spectrum import folded_beyond, plot_angle_spectrum  # noqa: E402
from plots.case_plots import plot_diagnostics  # noqa: E402
from plots.contact_maps import plot_contacts  # noqa: E402
from tests.made_up_case import SQUARE, TWO, WithCase, in_the_view  # noqa: E402
from tests.made_up_run import HOSTILE  # noqa: E402
from tests.report_test import REPORTS  # noqa: E402
from viewer.view_data import frames_to_turn, make_view  # noqa: E402


class Pictures(unittest.TestCase):
    """The renderer by itself."""

    @staticmethod
    def seen(picture: np.ndarray, camera: object, places: list[list[float]]) -> list[np.ndarray]:
        """The colours at places [m]."""
        points, _ = camera.project(np.array(places), 1)
        return [picture[int(point[1]), int(point[0])].astype(int) for point in points]

    def test_the_nearer_triangle_hides_the_farther_and_sides_have_their_colours(self) -> None:
        near_front, far_back = [[0, 1, 2], [1, 3, 2]], [[4, 6, 5], [5, 6, 7]]
        x = np.concatenate([1.2 * SQUARE, SQUARE + [0.6, 0.6, -1.0]])
        triangles = np.array(near_front + far_back)
        camera = choose_camera([x], triangles)
        self.assertGreater(camera.toward[2], 0)
        picture = picture_of(Cloth(x, triangles, np.zeros(8, dtype=bool)), camera)
        both, far_alone = self.seen(picture, camera, [[0.9, 0.9, 0.0], [1.4, 1.5, -1.0]])
        self.assertEqual(both[0] > both[2], FRONT[0] > FRONT[2])
        self.assertEqual(far_alone[0] > far_alone[2], BACK[0] > BACK[2])

    def test_cloth_that_lies_on_an_object_hides_it(self) -> None:
        table = Scenery(
            2.0 * SQUARE - [0.5, 0.5, 0.0], TWO, np.zeros(4, dtype=bool), np.zeros(3), 1.0
        )
        camera = choose_camera([SQUARE], TWO, table.x)
        picture = picture_of(Cloth(SQUARE, TWO, np.zeros(4, dtype=bool)), camera, table)
        cloth, object_alone = self.seen(picture, camera, [[0.5, 0.4, 0.0], [1.4, 1.3, 0.0]])
        self.assertGreater(cloth[0] - cloth[2], 30)
        self.assertLess(abs(object_alone[0] - object_alone[2]), 30)

    def test_particles_that_are_not_finite_leave_the_rest_drawn(self) -> None:
        x = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [np.nan, 1, 0]], dtype=float)
        camera = choose_camera([np.nan_to_num(x)], TWO)
        picture = picture_of(Cloth(x, TWO, np.ones(4, bool)), camera)
        self.assertGreater((picture[:, :, 3] > 0).mean(), 0.1)

    def test_cloth_above_the_ground_casts_a_shadow_and_the_ground_ends_nowhere(self) -> None:
        cloth = SQUARE[:, [0, 2, 1]] - [0.5, 0.0, 0.5]             # level, at the height 0
        floor = 20.0 * cloth - [0.0, 0.4, 0.0]
        for up in (TWO, TWO[:, ::-1]):
            scenery = Scenery(floor, up, np.ones(4, dtype=bool), np.zeros(3), 0.71)
            camera = choose_camera([cloth], TWO[:, ::-1], floor / 8)
            picture = picture_of(
                Cloth(cloth, TWO[:, ::-1], np.zeros(4, dtype=bool)), camera, scenery
            )
            light = np.array([-0.52, 0.74, 0.42]) @ np.stack(
                [camera.right, camera.up, camera.toward]
            )
            below = np.array([0.0, 0.0, 0.4]) - (0.4 / light[1]) * light
            dark, = self.seen(picture, camera, [below.tolist()])
            ground = (picture[:, :, 3] > 250) & (np.ptp(picture[:, :, :3].astype(int), axis=2) < 12)
            self.assertLess(dark[0] + 25, np.percentile(picture[ground][:, 0], 90))
        self.assertLess(picture[[0, 0, -1, -1], [0, -1, 0, -1], 3].max(), 30)

    def test_the_file_keeps_outlines_and_nearly_all_of_the_colours(self) -> None:
        cloth = Cloth(SQUARE, TWO, np.zeros(4, dtype=bool))
        picture = picture_of(cloth, choose_camera([SQUARE], TWO))
        read = np.asarray(image.imread(BytesIO(webp_bytes(picture)), format="webp")).astype(int)
        np.testing.assert_array_equal(read[:, :, 3], picture[:, :, 3])
        inside = picture[:, :, 3] == 255
        self.assertLess(np.abs(read - picture)[inside].mean(), 3.0)


class Fields(WithCase):
    """Fields against what is known of a sheet of two triangles that folds."""

    def test_an_object_turns_and_moves_by_its_pose_or_deforms(self) -> None:
        case = self.case()
        scenery = CaseScene(case, [0, 3]).scenery(3)
        np.testing.assert_allclose(case.objects[0].positions(1)[1], [0.0, 0.5, 0.1], atol=1e-15)
        np.testing.assert_allclose(case.objects[1].positions(3)[2], [0.0, 0.5, 0.6], atol=1e-15)
        np.testing.assert_array_equal(scenery.ground, [False] * 7 + [True] * 4)

    def test_values_are_those_of_the_definitions(self) -> None:
        values, x = all_values(self.case()), self.case().every_frame("positions")
        np.testing.assert_allclose(values["speed"], np.hypot(x[:, :, 2], 2 * x[:, :, 2]))
        np.testing.assert_allclose(values["phi"], x[:, :, 2] - 0.05)
        np.testing.assert_allclose(values["strain"][0], 0.25)      # 1 m where 0.8 m is at rest
        np.testing.assert_allclose(values["angle"][0], 0.0, atol=1e-12)
        with h5py.File(self.path, "r+") as file:
            file["frames/positions"][1] = SQUARE * [1, 1, 0] + [
                [0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 1]
            ]
        angle = all_values(self.case())["angle"][1]
        a, b = (np.cross(*edges) for edges in (([1, 0, 0], [0, 1, 0]), ([0, 1, 1], [-1, 0, 1])))
        between = np.arccos(a @ b / np.linalg.norm(a) / np.linalg.norm(b))
        # the hinge is that of particles 1 and 2
        np.testing.assert_allclose(angle, [0.0, between, between, 0.0])

    def test_spectrum_counts_what_is_folded_as_far_or_farther(self) -> None:
        beyond = folded_beyond(np.array([0.0, 10.0, 10.0, 90.0, np.nan]))
        half_degrees = [0, 20, 21, 180, 181]
        np.testing.assert_allclose(beyond[half_degrees], [1.0, 0.75, 0.25, 0.25, 0.0])
        self.assertEqual(plot_angle_spectrum(self.case(), "few", self.root), [])   # of one hinge

    def test_what_is_roundings_is_no_field(self) -> None:
        with h5py.File(self.path, "r+") as file:
            file["frames/velocities"][...] = 1e-15
        self.assertEqual(
            [field.name for field in fields_of(self.case(), [0, 1, 2, 3])],
            ["strain", "angle", "phi"],
        )

    def test_the_most_telling_field_is_smooth_and_has_many_colours(self) -> None:
        case = self.case()
        fields = {field.name: field for field in fields_of(case, [0, 1, 2, 3])}
        line = np.column_stack([np.arange(99), np.arange(1, 100)])
        smooth, noise, flat = fields["speed"], fields["strain"], fields["angle"]
        smooth.values = np.linspace(0.0, smooth.high, 100)[None]
        noise.values = np.random.default_rng(17).uniform(0.0, noise.high, (1, 100))
        flat.values = np.full((1, 100), 0.5 * flat.high)
        field, row = most_telling([noise, flat, smooth], [0], line)
        self.assertEqual((field.name, row), ("speed", 0))
        self.assertIsNone(most_telling([], [0], edges_of(case.triangles)))
        flat.values = np.full((3, 100), 0.5 * flat.high)
        # what moves as one is shown where it came to
        self.assertEqual(most_telling([flat], [0, 1, 2], line)[1], 2)

    def test_what_is_zero_throughout_is_not_plotted(self) -> None:
        lines = {
            caption.split()[0]: plot
            for caption, plot in plot_diagnostics(self.case(), "fold", self.root)
        }
        self.assertEqual(set(lines), {"Energies", "Linear", "Conjugate"})
        with h5py.File(self.path, "r+") as file:
            for name in ("cg_iterations", "linear_momentum", "gravity_energy", "kinetic_energy"):
                file[f"diagnostics/{name}"][...] = 0.0
        self.assertEqual(plot_diagnostics(self.case(), "fold", self.root), [])

    def test_contacts_are_shown_in_the_frame_that_has_most(self) -> None:
        def caption(*last: float) -> str:
            """Of the map of the case whose last frame has these distances."""
            with h5py.File(self.path, "r+") as file:
                file["frames/object_distance"][...] = [
                    [9.0] * 4, [9.0, 0.1, -0.1, 0.2], [9.0, 9.0, 9.0, 0.1], last
                ]
            ((words, _),) = plot_contacts(self.case(), "fold", self.root)
            return words
        self.assertRegex(
            caption(9.0, 9.0, 9.0, 9.0),
            "objects at 1 s, .* 1 of 4 particles are inside, by at most 0.1 m"
        )
        self.assertRegex(
            caption(9.0, 0.1, 0.1, 0.2), "objects at 3 s, .* No particle is inside by more"
        )
        with h5py.File(self.path, "r+") as file:
            file["frames/object_distance"][...] = 9.0
        self.assertEqual(plot_contacts(self.case(), "fold", self.root), [])


def unpacked(text: str) -> tuple[dict, dict[str, np.ndarray]]:
    """The header and the arrays of a view, undone as viewer_data.js does it."""
    whole = zlib.decompress(base64.b64decode(text), -15)
    end = 4 + int.from_bytes(whole[:4], "little")
    header, arrays, at = json.loads(whole[4:end]), {}, end
    for about in header["arrays"]:
        count, size = about["count"], 4 if about["kind"] == "floats" else about["kind"]
        part = np.frombuffer(whole[at:at + count * size], dtype=np.uint8)
        at += count * size
        if about["kind"] == "floats":
            arrays[about["name"]] = part.view("<f4")
            continue
        unsigned = sum(
            part[k * count : (k + 1) * count].astype(np.int64) << (8 * k) for k in range(size)
        )
        arrays[about["name"]] = (unsigned >> 1) ^ -(unsigned & 1)
    assert at == len(whole)
    return header, arrays


ASK_THE_VIEW = in_the_view("""
  const problems = [], told = { problems };
  addEventListener("error", (event) => problems.push(event.message));
  addEventListener("unhandledrejection", (event) => problems.push(String(event.reason)));
  console.warn = console.error = (text) => problems.push(String(text));
  const differ = (a, b) => a.filter((value, k) => Math.abs(value - b[k]) > 8).length;
  figure.querySelector(".open-view").click();
  await drawn(6);                                       // it plays
  press(" ");
  await wait(300);
  told.drawn = Number(figure.dataset.drawn);
  const colours = figure.querySelector("select");
  const first = await after(() => show(0));
  told.covered = first.filter((value, k) => k % 4 === 3 && value > 128).length;
  told.time = figure.querySelector("output").textContent;
  const turned = await after(() => press("ArrowLeft"));
  const later = await after(() => press("."));
  told.colours = colours.options.length;
  const recoloured = await after(() => {
    colours.value = -1; colours.dispatchEvent(new Event("change"));
  });
  Object.assign(told, { turned: differ(first, turned), moved: differ(turned, later),
                        recoloured: differ(later, recoloured) });
  press("Escape");
  told.closed = !figure.querySelector("canvas") && !figure.classList.contains("running");
  return told;
""")
ASK_FOR_REST = in_the_view("""
  figure.querySelector(".open-view").click();
  await drawn(1);
  await wait(700);
  return [figure.querySelector(".play").textContent,
          figure.querySelector("input").value, figure.dataset.frame];
""")
ASK_WITHOUT_WEBGL = in_the_view("""
  HTMLCanvasElement.prototype.getContext = () => null;
  figure.querySelector(".open-view").click();
  while (!figure.querySelector(".no-view")) await wait(50);
  return [figure.querySelector(".no-view").textContent,
          figure.querySelector("img").offsetHeight > 50];
""")


class ViewInThePage(WithCase):
    """The data of the view, and the view itself in a browser."""

    def view(self, most: int = 10**6) -> tuple[object, dict, dict[str, np.ndarray]]:
        """The view of the case, and what its text holds."""
        case = self.case()
        frames = frames_to_turn(case)
        view = make_view(CaseScene(case, frames), frames, fields_of(case, frames), most)
        return view, *unpacked(view.text)

    def test_places_are_those_of_the_file_to_within_the_error_that_is_said(self) -> None:
        view, header, arrays = self.view()
        x = self.case().every_frame("positions")
        first, later = np.split(arrays["positions"].reshape(4, 3, 4), [1])
        codes = np.cumsum(np.concatenate([np.cumsum(first, axis=2), later]), axis=0) % 65536
        places = np.array(header["box"]["low"]) + np.array(header["box"]["step"]) * codes.transpose(
            0, 2, 1
        )
        self.assertAlmostEqual(np.linalg.norm(places - x, axis=2).max(), view.error, delta=1e-15)
        self.assertLess(view.error, 0.87 * np.ptp(x, axis=(0, 1)).max() / 65535)
        np.testing.assert_array_equal(np.cumsum(arrays["triangles"]).reshape(-1, 3), TWO)
        self.assertEqual((view.frames, view.of_frames, view.not_whole), (4, 4, 0))
        self.assertEqual([part["ground"] for part in header["objects"]], [False, False, True])
        self.assertEqual([part["deforms"] for part in header["objects"]], [False, True, False])
        self.assertEqual(len(arrays["object 2 poses"]), 7)          # it never moves
        self.assertEqual(
            [field["name"] for field in header["fields"]], ["speed", "strain", "angle", "phi"]
        )

    def test_frames_that_are_not_whole_are_left_out_and_counted(self) -> None:
        with h5py.File(self.path, "r+") as file:
            file["frames/positions"][2, 1, 0] = np.nan
        view, header, _ = self.view()
        self.assertEqual((view.frames, view.not_whole, header["times"]), (3, 1, [0.0, 1.0, 3.0]))

    def test_a_case_too_large_for_the_page_is_thinned_or_has_no_view(self) -> None:
        with h5py.File(self.path, "r+") as file:
            for name in ("time", "positions", "velocities", "object_distance"):
                rows = np.concatenate([file[f"frames/{name}"][:]] * 8)
                del file[f"frames/{name}"]
                file[f"frames/{name}"] = np.arange(32.0) if name == "time" else rows
            for k, names in enumerate(
                (("rotation", "translation"), ("positions",), ("rotation", "translation"))
            ):
                for name in names:
                    rows = np.concatenate([file[f"objects/{k}/{name}"][:]] * 8)
                    del file[f"objects/{k}/{name}"]
                    file[f"objects/{k}/{name}"] = rows + np.random.default_rng(k).uniform(
                        size=(32,) + (1,) * (rows.ndim - 1)
                    )
        whole, _, _ = self.view()
        thinned, header, _ = self.view(len(whole.text) - 200)
        self.assertLess(thinned.frames, whole.frames)
        self.assertEqual(np.diff(header["times"]).tolist(), [thinned.stride] * (thinned.frames - 1))
        case = self.case()
        self.assertIsNone(make_view(CaseScene(case, [0]), [0, 1], [], 500))

    def test_the_program_stands_once_and_data_are_no_program(self) -> None:
        text = make_report(self.root, self.root / "report.html", self.root / "figures").read_text(
            encoding="utf-8"
        )
        self.assertEqual(text.count("async function unpack("), 1)
        self.assertRegex(text, r"<template>[A-Za-z0-9+/=]+</template>")
        self.assertNotIn(HOSTILE[:13], text)
        for name in ("viewer_data.js", "viewer_gl.js", "viewer.js"):
            self.assertNotRegex(
                (REPORTS / "viewer" / name).read_text(encoding="utf-8"),
                r"(?i)</script|<!--|https?://|innerHTML|fetch\(",
            )

    @unittest.skipUnless(shutil.which("chromium"), "no chromium: the package chromium has it")
    def test_the_view_draws_and_plays_in_a_browser(self) -> None:
        page = make_report(self.root, self.root / "report.html", self.root / "figures")
        with Browser() as browser:
            browser.open(page)
            told = browser.evaluate(ASK_THE_VIEW)
        self.assertEqual(told["problems"], [])
        self.assertGreater(told["drawn"], 3)
        self.assertGreater(told["covered"], 200)
        for what in ("turned", "moved", "recoloured"):
            self.assertGreater(told[what], 100, what)
        self.assertEqual((told["time"], told["colours"], told["closed"]), ("0.00 s", 5, True))

    @unittest.skipUnless(shutil.which("chromium"), "no chromium: the package chromium has it")
    def test_without_webgl_the_picture_stays_and_who_wants_rest_sees_no_film(self) -> None:
        page = make_report(self.root, self.root / "report.html", self.root / "figures")
        with Browser() as browser:
            browser.open(page, still=True)
            still = browser.evaluate(ASK_FOR_REST)
            browser.open(page)
            told = browser.evaluate(ASK_WITHOUT_WEBGL)
        self.assertEqual((still[0], still[1]), ("Play", still[2]))
        self.assertEqual(told, ["Only the picture: no WebGL 2", True])


def load_tests(
    loader: unittest.TestLoader, tests: unittest.TestSuite, _: str | None
) -> unittest.TestSuite:
    """This file's tests, those of garments, of films and exported files, of where up is, and of the
    keyboard."""
    for name in (
        "tests.test_garment", "tests.test_exports", "tests.test_upright", "tests.test_keyboard"
    ):
        tests.addTests(loader.loadTestsFromName(name))
    return tests


if __name__ == "__main__":
    unittest.main()
