"""The made-up case with all that pictures, films and exported files are made of, for tests."""
from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np

from data.results import Case, load_case
from tests.made_up_run import put, put_case
from tests.report_test import FolderTest

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], dtype=float)
TWO = np.array([[0, 1, 2], [1, 3, 2]])

# how a script in a page sees and drives the view of the case
_VIEW = """
  const figure = document.querySelector("figure.view");
  const wait = (ms) => new Promise((done) => setTimeout(done, ms));
  const drawn = async (count) => {
    for (let k = 0; k < 400 && !(figure.dataset.drawn >= count); ++k) await wait(50);
  };
  const press = (key) =>
    figure.querySelector("canvas").dispatchEvent(new KeyboardEvent("keydown", { key }));
  const after = async (act) => {                        // what is seen once the act has been drawn
    const before = Number(figure.dataset.drawn);
    act();
    await drawn(before + 1);
    const copy = document.createElement("canvas"), pen = copy.getContext("2d");
    Object.assign(copy, { width: 80, height: 60 });
    pen.drawImage(figure.querySelector("canvas"), 0, 0, 80, 60);
    return Array.from(pen.getImageData(0, 0, 80, 60).data);
  };
  const show = (row) => {
    const slider = figure.querySelector("input[type=range]");
    slider.value = row; slider.dispatchEvent(new Event("input"));
  };
  figure.scrollIntoView();
"""


def in_the_view(script: str) -> str:
    """The body of a function of the page, made to be asked."""
    return f"(async () => {{{_VIEW}{script}}})()"


def put_whole_case(folder: Path) -> Path:
    """The made-up case with all that fields are made of, and a ground below it."""
    put_case(folder, "fold")
    with h5py.File(folder / "fold.h5", "r+") as file:
        x = file["frames/positions"][:]
        x[:, 3, 2] += 0.2 * np.arange(4)
        file["frames/positions"][...] = x
        file["mesh/rest_positions"] = 0.8 * SQUARE
        file["frames/velocities"] = np.stack([x[:, :, 2], 0 * x[:, :, 0], 2 * x[:, :, 2]], axis=2)
        file["frames/object_distance"] = x[:, :, 2] - 0.05
        ground = file.create_group("objects/2")
        put(ground, name="ground", shape="half_space", friction=0.5)
        ground["vertices"] = 6.0 * SQUARE - [3.0, 3.0, 0.1]
        ground["triangles"] = TWO.astype(np.int32)
        ground["rotation"] = np.tile([1.0, 0, 0, 0], (4, 1))
        ground["translation"] = np.zeros((4, 3))
    return folder / "fold.h5"


class WithCase(FolderTest):
    """Tests on the made-up case, in a folder of its own."""

    def setUp(self) -> None:
        super().setUp()
        self.path = put_whole_case(self.root)

    def case(self) -> Case:
        """The case, read."""
        return load_case(self.path)
