"""The made-up case with all that pictures, films and exported files are made of, for tests."""
from __future__ import annotations

import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

from data.results import Case, load_case
from tests.made_up_run import put, put_case

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], dtype=float)
TWO = np.array([[0, 1, 2], [1, 3, 2]])


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
        ground["rotation"], ground["translation"] = np.tile([1.0, 0, 0, 0], (4, 1)), np.zeros(
            (4, 3)
        )
    return folder / "fold.h5"


class WithCase(unittest.TestCase):
    """Tests on the made-up case, in a folder of its own."""

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        self.path = put_whole_case(self.root)

    def case(self) -> Case:
        """The case, read."""
        return load_case(self.path)
