#!/usr/bin/python3
"""Tests `foldproof compare`: frames that the program exported, damaged, moved and misnamed."""

import shutil
import unittest

import h5py
import numpy as np

from file_tests import SMALL_CASE
from program_case import ProgramCase, run


class Compare(ProgramCase):
    def setUp(self) -> None:
        super().setUp()
        self.assert_holds(self.simulate(self.write("small.toml", SMALL_CASE)))
        self.run_file = str(self.path / "out/small.h5")
        with h5py.File(self.run_file) as file:
            self.times = file["frames/time"][:]
        for form in ("ply", "obj"):
            self.assert_holds(run("export", self.run_file, "--format", form, "--out",
                                  self.path / form))

    def compare(self, *words: str) -> dict:
        return self.told("compare", self.run_file, *words, codes=(0,))

    def test_a_run_is_no_distance_from_itself(self) -> None:
        told = self.compare(str(self.path / "ply"))
        self.assertEqual(told["matching"], "vertex by vertex")
        self.assertEqual([frame["time"] for frame in told["frames"]], list(self.times))
        for frame in told["frames"]:
            self.assertEqual((frame["rms"], frame["largest"]), (0, 0))
            self.assertEqual(frame["run"], frame["frame"])

    def test_every_format_and_a_stored_run_are_compared(self) -> None:
        for form, most in (("pc2", 1e-7), ("npz", 0), ("usda", 1e-7)):
            self.assert_holds(run("export", self.run_file, "--format", form, "--out",
                                  self.path / form))
            told = self.compare(str(self.path / form))
            self.assertEqual(told["matching"], "vertex by vertex")
            np.testing.assert_allclose([frame["time"] for frame in told["frames"]], self.times)
            self.assertLessEqual(max(frame["largest"] for frame in told["frames"]), most)
        half = str(1 / (self.times[1] - self.times[0]) / 2)
        told = self.compare(str(self.path / "pc2/small.pc2"), "--rate", half)
        self.assertGreater(told["left_out"], 0)
        told = self.compare(self.run_file)
        self.assertEqual(max(frame["largest"] for frame in told["frames"]), 0)
        self.assertIn("knows its times",
                      self.assert_rejected("compare", self.run_file, self.run_file, "--rate", "5"))

    def test_arrays_of_any_kind_are_read_and_damaged_archives_are_refused(self) -> None:
        with h5py.File(self.run_file) as file:
            arrays = {"vertices": file["frames/positions"][:], "faces": file["mesh/triangles"][:],
                      "times": self.times}
        for how, save in (("any", np.savez), ("packed", np.savez_compressed)):
            others = {"vertices": np.asfortranarray(arrays["vertices"]),
                      "faces": arrays["faces"].astype(">u8")}
            save(self.path / f"{how}.npz", **(arrays | others))
            told = self.compare(str(self.path / f"{how}.npz"))
            self.assertEqual(max(frame["largest"] for frame in told["frames"]), 0)
        whole = (self.path / "any.npz").read_bytes()
        hurt = bytearray(whole)
        hurt[whole.index(b"NUMPY") + 200] ^= 1  # of the vertices
        (self.path / "hurt.npz").write_bytes(hurt)
        (self.path / "cut.npz").write_bytes(whole[:-30])
        for name, change in (("poses", {"vertices": None}), ("flat", {"vertices": np.ones(3)}),
                             ("words", {"vertices": np.array([[["a"] * 3]])}),
                             ("faces", {"faces": arrays["faces"] + 2}),
                             ("times", {"times": [0, 1]}), ("fps", {"times": None, "fps": 0})):
            kept = {key: value for key, value in (arrays | change).items() if value is not None}
            np.savez(self.path / f"{name}.npz", **kept)
        for name, said in (
            ("hurt", "checksum"), ("cut", "no ZIP archive"), ("poses", "no array 'vertices'"),
            ("flat", "of shape [F, N, 3]"), ("words", "holds no numbers"),
            ("faces", "names no vertex from 0 to"), ("times", "2 values for"), ("fps", "'fps'")
        ):
            told = self.assert_rejected("compare", self.run_file, str(self.path / f"{name}.npz"))
            self.assertIn(said, told)

    def test_points_without_faces_are_compared_one_sided(self) -> None:
        head = "ply\nformat ascii 1.0\nelement vertex 2\n"
        axes = "".join(f"property float {axis}\n" for axis in "xyz")
        self.write("scan/s1.ply", f"{head}{axes}end_header\n0 0 0\n0 0 1\n")
        scan = str(self.path / "scan")
        told = self.compare(scan, "--rate", "30")
        self.assertEqual(told["matching"], "one-sided, points to the run's surface")
        self.assertIsNone(told["frames"][0]["frame"]["crossings"])
        self.assertIn("one-sided", run("compare", self.run_file, scan, "--rate", "30").stdout)

    def test_times_come_from_a_file_a_rate_or_the_folder(self) -> None:
        obj, times = str(self.path / "obj"), "".join(f"{time}\n" for time in self.times)
        told = self.compare(obj)  # by the times.txt that export wrote
        self.assertEqual([frame["time"] for frame in told["frames"]], list(self.times))
        (self.path / "obj/times.txt").unlink()
        self.assert_refused(run("compare", self.run_file, obj), "--times FILE or --rate FPS")
        rate = str(1 / (self.times[1] - self.times[0]))
        by_file = self.compare(obj, "--times", self.write("when.txt", "# seconds\n" + times))
        by_rate = self.compare(obj, "--rate", rate)
        (self.path / "obj/times.txt").write_text(times)
        for told in (by_file, by_rate, self.compare(obj)):
            self.assertLess(max(frame["largest"] for frame in told["frames"]), 1e-6)
        late = self.compare(obj, "--rate", rate, "--start", str(self.times[1]))
        self.assertEqual(late["left_out"], 1)
        self.assertGreater(late["frames"][-1]["rms"], 0)

    def test_another_mesh_is_compared_by_nearest_points(self) -> None:
        self.write("mine/a1.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        told = self.compare(str(self.path / "mine"), "--rate", "30")
        self.assertEqual(told["matching"], "by nearest points")
        self.assertIsNone(told["frames"][0]["frame"]["stretch"])

    def test_frames_like_a_file_keep_its_records_and_sewn_frames_match(self) -> None:
        places = ["0 0 0", "1 0 0", "2 0 0", "0 1 0", "1 1 0", "1 0 0", "2 1 0", "1 1 0"]
        vertices = [f"v {place}" for place in places]
        records = ["vt 0 1", "g left", "f 1/1 2/1 5/1 4/1", "g right", "f 6//1 3/1/1 -2 -1 # e"]
        self.write("two.obj", "\n".join(vertices + records))
        case = ('[cloth]\nmesh = "two.obj"\nseams = 1e-6\ndensity = 1\nmove = [0, 0, 0.5]\n'
                "[stretch]\nstiffness = 1\n[time]\nend = 0.1\n")
        self.assert_holds(self.simulate(self.write("two.toml", case)))
        stored, like = str(self.path / "out/two.h5"), str(self.path / "two.obj")
        self.assert_holds(run("export", stored, "--format", "obj", "--like", like, "--out",
                              self.path / "like"))
        lines = (self.path / "like/two.0000.obj").read_text(encoding="utf-8").split("\n")
        self.assertEqual(lines, [f"{vertex[:-1]}0.5" for vertex in vertices] + records[:4]
                         + ["f 6 3/1 -2 -1", ""])
        told = self.told("compare", stored, str(self.path / "like"), codes=(0,))
        self.assertEqual((told["matching"], told["frames"][-1]["rms"]), ("vertex by vertex", 0))

    def test_the_result_is_a_study_that_the_report_shows(self) -> None:
        self.compare(str(self.path / "ply"), "--out", str(self.path / "result"))
        with h5py.File(self.path / "result/run.h5") as file:
            self.assertIn("compare.small", file["studies"])
        self.assertIn("compare.small", self.page_of(self.path / "result"))

    def test_what_cannot_be_matched_is_refused_in_a_line(self) -> None:
        empty, two, obj = (str(self.path / name) for name in ("empty", "two", "obj"))
        (self.path / "empty").mkdir()
        for name in ("a1.obj", "b1.obj"):
            self.write(f"two/{name}", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        few, words = self.write("few.txt", "0\n"), self.write("words.txt", "0\nsoon\n")
        for typed, said in (
            ((empty,), "holds no frame"), ((two, "--rate", "5"), "2 sequences"),
            ((str(self.path / "none"),), "there is no such folder"),
            ((obj, "--times", few), "1 times for"), ((obj, "--times", words), "words.txt:2"),
            ((obj, "--rate", "30", "--start", "1e6"), "no frame lies in the run's time"),
            ((obj, "--rate", "0"), "above 0"),
            ((obj, "--rate", "5", "--times", few), "give one of them"),
            ((obj, "--start", "1"), "--rate")
        ):
            self.assertIn(said, self.assert_rejected("compare", self.run_file, *typed))
        broken = self.path / "broken"
        shutil.copytree(self.path / "ply", broken)
        first = broken / "small.0000.ply"
        first.write_bytes(first.read_bytes()[:-5])
        self.assert_refused(run("compare", self.run_file, broken), first.name)


if __name__ == "__main__":
    unittest.main()
