#!/usr/bin/python3
"""Tests of the report generator on small made-up runs: reports/test_reports.py"""
from __future__ import annotations

import re
import sys
import tempfile
import unittest
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

sys.dont_write_bytecode = True

import h5py  # noqa: E402
import numpy as np  # noqa: E402

from camera import choose_camera  # noqa: E402
from cloth_picture import BACK, FRONT, picture_of  # noqa: E402
from make_report import make_report, read_folder  # noqa: E402
from page import Anchors, margin_percent, shown_rows  # noqa: E402
from quantities import number_text, quantity_html, unit_text  # noqa: E402
from results import Column, load_case, load_run  # noqa: E402
from study_plots import spread  # noqa: E402

HOSTILE = '<script>alert("1")</script> & <img src=x onerror=alert(1)>'
NAMES = ("bending.forces-sum-to-zero", "bending.damping-dissipates", "springs.limit", "time-order.hinge.C.x",
         "bench.bending-elastic", "sticking.<img src=x onerror=alert(1)>")
TEXT = h5py.string_dtype()


def put(item: h5py.Group | h5py.Dataset, **said: Any) -> None:
    """Sets attributes; lists become arrays of strings."""
    for key, value in said.items():
        item.attrs[key] = np.array(value, dtype=TEXT) if isinstance(value, list) and value else value


def put_finding(file: h5py.File, order: int, name: str, kind: str, **said: Any) -> None:
    """Adds one finding with a little evidence."""
    group = file.create_group(f"findings/{name}")
    usual = dict(order=order, kind=kind, study="", claim=f"Claim of {name}.", source="BMF03 section 4",
                 measured=3.2e-15, bound=4.4e-14, uncertainty=0.0, unit="N", why_bound="200 roundings",
                 outcome="holds", note="", seconds=0.1, faults=["flipped-sign"])
    put(group, **(usual | said))
    angles = group.create_dataset("evidence/angle", data=np.linspace(-3, 3, 40))
    put(angles, order=0, unit="rad")
    mesh = group.create_dataset("evidence/mesh", data=np.array([HOSTILE] * 40, dtype=object), dtype=TEXT)
    put(mesh, order=1, unit="")


def put_study(file: h5py.File) -> None:
    """Adds a study with one figure of two curves, one of them partly NaN."""
    study = file.create_group("studies/time-order")
    put(study, order=1, claim="Second order.", source="BMF03", about=HOSTILE, seconds=1.0)
    figure = file.create_group("studies/time-order/figures/x")
    put(figure, order=1, title="Error of the position", x_label="step", x_unit="s", y_label="error $x$ <b>",
        y_unit="m", x_scale="log", y_scale="log", slope=2.0, caption=HOSTILE)
    h = 0.02 / 2.0 ** np.arange(5)
    for k in range(2):
        curve = figure.create_group(f"curves/{k}")
        put(curve, order=k, label=f"scheme {k} {HOSTILE}", floor=1e-9)
        curve["x"], curve["y"] = h, np.where((h > 0.01) & (k == 1), np.nan, h ** 2)
        curve["pair_orders"] = np.full(4, 2.0)


def put_case(folder: Path, name: str) -> None:
    """Writes a case of two triangles that fold over a few frames."""
    with h5py.File(folder / f"{name}.h5", "w") as file:
        put(file, case_name=name, title=HOSTILE, about="", built=["4 particles", "gravity"],
            case_text="[sheet]\n", stopped="", seconds=1.0, commit="abcdef",
            command=f"build/foldproof run cases/{name}.toml")
        rest = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], dtype=float)
        file["mesh/triangles"] = np.array([[0, 1, 2], [1, 3, 2]], dtype=np.int32)
        file["mesh/held"] = np.array([1, 0, 0, 0], dtype=np.uint8)
        file["frames/time"] = np.arange(4.0)
        file["frames/positions"] = np.array([rest + [0, 0, 0.1 * k] * rest[:, :1] for k in range(4)])
        for key, values in dict(time=np.linspace(0, 3, 900), kinetic_energy=np.full(900, np.nan),
                                gravity_energy=np.linspace(1, 0, 900), linear_momentum=np.ones((900, 3)),
                                angular_momentum=np.zeros((900, 3)), cg_iterations=np.zeros(900),
                                cg_residual=np.zeros(900)).items():
            put(file.create_dataset(f"diagnostics/{key}", data=values), unit="1")


def put_run(folder: Path) -> None:
    """Writes a run with every kind of finding, a study, two cases (one missing) and faults."""
    with h5py.File(folder / "run.h5", "w") as file:
        put(file, schema=1, commit="abcdef", tree="dirty", cpu=HOSTILE, seconds=3.0,
            command="build/foldproof verify")
        put_finding(file, 1, NAMES[0], "check")
        put_finding(file, 2, NAMES[1], "check", measured=np.nan, outcome="fails", note=HOSTILE)
        put_finding(file, 3, NAMES[2], "check", outcome="inconclusive", why_bound=HOSTILE)
        put_finding(file, 4, NAMES[3], "study", study="time-order")
        put_finding(file, 5, NAMES[4], "bench", outcome="measured", better="higher", bound=1e7, measured=2e7)
        put_finding(file, 6, NAMES[5], "study", study="one that was not run", outcome="not applicable")
        put_study(file)
        put_case(folder, "fold")
        put(file.create_group("cases/fold"), order=1, file="fold.h5", title=HOSTILE, about=HOSTILE,
            stopped="")
        put(file.create_group("cases/gone"), order=2, file="gone.h5", title="gone", about="", stopped="")
        row = dict(name="flipped-sign", file="forces/bending.cpp", find="a < b && c", replace="a > b",
                   law="momentum", caught_by=f"{NAMES[0]}, {NAMES[2]}, gone.check", outcome="caught")
        for key, value in row.items():
            file.create_dataset(f"faults/{key}", data=np.array([value], dtype=object), dtype=TEXT)


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
        cls.text = make_report(root, root / "report.html", cls.figures).read_text(encoding="utf-8")
        cls.seen = Seen(cls.text)

    @classmethod
    def tearDownClass(cls) -> None:
        cls.folder.cleanup()

    def test_page_needs_nothing_beside_it(self) -> None:
        for reference in self.seen.references:
            self.assertRegex(reference, r"^(#|data:image/png;base64,)")
        self.assertNotRegex(self.text, r"url\((?!#)")
        self.assertNotIn("@import", self.text)
        self.assertFalse({"script", "link", "iframe", "object"} & set(self.seen.tags))

    def test_hostile_text_is_escaped(self) -> None:
        self.assertNotIn("<script", self.text)
        self.assertNotIn("<img src=x", self.text)
        self.assertIn("&lt;script&gt;", self.text)

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

    def test_missing_case_is_named(self) -> None:
        self.assertIn("gone.h5 could not be read", self.text)

    def test_figures_are_written(self) -> None:
        for name in ("time-order-x", "fold-pictures", "fold-energies", "fold-momenta", "fold-solves"):
            for kind in ("svg", "pdf", "png"):
                self.assertGreater((self.figures / f"{name}.{kind}").stat().st_size, 500, name)

    def test_same_input_gives_the_same_page(self) -> None:
        root = Path(self.folder.name)
        again = make_report(root, root / "again.html", root / "again").read_text(encoding="utf-8")
        self.assertEqual(again, self.text)


class PartsMissing(unittest.TestCase):
    """Runs that lack parts."""

    def setUp(self) -> None:
        self.folder = tempfile.TemporaryDirectory()
        self.root = Path(self.folder.name)
        self.addCleanup(self.folder.cleanup)

    def made(self) -> str:
        """The text of the folder's report."""
        page = make_report(self.root, self.root / "report.html", self.root / "figures")
        return page.read_text(encoding="utf-8")

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
        self.assertIn('id="case-fold"', self.made())

    def test_bench_alone(self) -> None:
        with h5py.File(self.root / "bench.h5", "w") as file:
            put_finding(file, 1, NAMES[4], "bench", outcome="measured", better="lower")
        self.assertIn("not judged", self.made())

    def test_empty_folder_is_refused(self) -> None:
        with self.assertRaises(FileNotFoundError):
            read_folder(self.root)

    def test_loader_gives_numpy(self) -> None:
        put_run(self.root)
        run, case = load_run(self.root / "run.h5"), load_case(self.root / "fold.h5")
        self.assertEqual([finding.name for finding in run.findings], list(NAMES))
        self.assertEqual(case.positions(-1).shape, (4, 3))
        self.assertEqual(run.faults[0].caught_by, [NAMES[0], NAMES[2], "gone.check"])


class Pieces(unittest.TestCase):
    """Numbers, labels and pictures by themselves."""

    def test_numbers(self) -> None:
        written = {1.234e-14: "1.23×10⁻¹⁴", -0.5: "−0.5", 12345.0: "12\u202f345", 0.0: "0", 0.10421: "0.104",
                   float("nan"): "NaN", float("-inf"): "−∞", 1e-9: "1×10⁻⁹", 2.5e9: "2.5×10⁹"}
        for value, text in written.items():
            self.assertEqual(number_text(value), text)
        self.assertEqual(unit_text("kg m^2/s"), "kg m²/s")
        self.assertIn("<sup>−9</sup>", quantity_html(1e-9, "N"))

    def test_long_tables_say_what_they_leave_out(self) -> None:
        shown = shown_rows([Column("step", "1", np.arange(1001.0))])
        self.assertEqual(len(shown.first) + shown.left_out + len(shown.last), 1001)

    def test_margin_bar_says_nothing_about_nan(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            put_run(Path(folder))
            findings = load_run(Path(folder) / "run.h5").findings
        self.assertIsNone(margin_percent(findings[1]))
        self.assertAlmostEqual(margin_percent(findings[0]), 100 * (np.log10(3.2 / 44) + 4) / 5)

    def test_labels_keep_their_order_and_distance(self) -> None:
        placed = spread([0.5, 0.5, 0.51, 0.98], 0.1)
        self.assertEqual(placed, sorted(placed))
        self.assertGreater(min(np.diff(placed)), 0.099)

    def test_the_nearer_triangle_hides_the_farther_and_sides_have_their_colours(self) -> None:
        square = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], dtype=float)
        near_front, far_back = [[0, 1, 2], [1, 3, 2]], [[4, 6, 5], [5, 6, 7]]
        x = np.concatenate([1.2 * square, square + [0.6, 0.6, -1.0]])
        triangles = np.array(near_front + far_back)
        camera = choose_camera([x], triangles)
        self.assertGreater(camera.toward[2], 0)
        picture = picture_of(x, triangles, np.zeros(8, dtype=bool), camera)
        points, _ = camera.project(np.array([[0.9, 0.9, 0.0], [1.4, 1.5, -1.0]]), 1)
        both, far_alone = (picture[int(point[1]), int(point[0]), :3].astype(int) for point in points)
        self.assertEqual(both[0] > both[2], FRONT[0] > FRONT[2])
        self.assertEqual(far_alone[0] > far_alone[2], BACK[0] > BACK[2])

    def test_particles_that_are_not_finite_leave_the_rest_drawn(self) -> None:
        x = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [np.nan, 1, 0]], dtype=float)
        triangles = np.array([[0, 1, 2], [1, 3, 2]])
        picture = picture_of(x, triangles, np.ones(4, bool), choose_camera([np.nan_to_num(x)], triangles))
        self.assertGreater((picture[:, :, 3] > 0).mean(), 0.1)


if __name__ == "__main__":
    unittest.main()
