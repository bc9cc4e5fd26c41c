"""Tests of what others open: films and exported files. Run by test_views.py."""
from __future__ import annotations

import importlib
import json
import os
import shutil
import struct
import subprocess
import sys
import unittest
from pathlib import Path

import h5py
import numpy as np

from data.cloth_values import all_values
from tests.made_up_case import TWO, WithCase
from tests.report_test import REPORTS

# a python that has bpy
BPY = Path(os.environ.get("FOLDPROOF_BPY", REPORTS.parent / "build/engines/bpy/bin/python"))


class Films(WithCase):
    """make_film.py."""

    def film(self, *options: str, **environment: str) -> subprocess.CompletedProcess[str]:
        """Runs the script on the case."""
        return self.typed("make_film.py", self.path, *options, **environment)

    def test_what_is_missing_is_named_in_one_line(self) -> None:
        self.assert_refused(self.film(PATH=str(self.root)), "apt install ffmpeg")
        for script in ("make_film.py", "make_report.py", "export.py"):
            run = subprocess.run(
                [sys.executable, "-S", str(REPORTS / script)], text=True, check=False,
                capture_output=True
            )
            self.assert_refused(run, "apt install python3-numpy python3-h5py")

    def test_what_is_typed_wrong_is_refused_in_one_line(self) -> None:
        for options, said in (
            (("--size", "axb"), "WIDTHxHEIGHT"), (("--fps", "0"), "--fps"),
            (("--out", "film.avi"), "ends in .mp4"),
            (("--out", "nowhere/film.mp4"), "no folder nowhere")
        ):
            self.assert_refused(self.film(*options), said)

    @unittest.skipUnless(shutil.which("ffmpeg"), "no ffmpeg: the package ffmpeg has it")
    def test_films_have_the_size_the_length_and_the_format_that_were_asked_for(self) -> None:
        for kind, codec in (("mp4", "h264"), ("gif", "gif")):
            out = self.root / f"film.{kind}"
            run = self.film(
                "--out", str(out), "--size", "320x240", "--fps", "5", "--field", "strain"
            )
            self.assertEqual((run.returncode, run.stderr), (0, ""))
            shown = "stream=codec_name,width,height,pix_fmt,nb_read_frames"
            probe = subprocess.run(
                ["ffprobe", "-v", "error", "-select_streams", "v", "-count_frames", "-of", "json",
                 "-show_entries", shown, str(out)],
                capture_output=True, text=True, check=True
            )
            said = json.loads(probe.stdout)["streams"][0]
            self.assertEqual((said["codec_name"], said["width"], said["height"]), (codec, 320, 240))
            # 3 s, and the last frame stands
            self.assertAlmostEqual(int(said["nb_read_frames"]), 5 * 3.6, delta=1)
            if kind == "mp4":
                self.assertEqual(said["pix_fmt"], "yuv420p")
        self.assertFalse(list(self.root.glob("*.partial*")))

    @unittest.skipUnless(shutil.which("ffmpeg"), "no ffmpeg: the package ffmpeg has it")
    def test_what_cannot_be_filmed_is_said_in_one_line(self) -> None:
        with h5py.File(self.path, "r+") as file:
            del file["frames/object_distance"]
        self.assert_refused(self.film("--field", "phi"), "no field 'phi'; it has: speed")
        self.assert_refused(self.film("--out", "/nowhere/film.mp4"), "nowhere")
        self.path.write_bytes(b"no HDF5")
        self.assert_refused(self.film(), "no HDF5 file")


def reader(module: str) -> object | None:
    """A module that reads what is written here, by other hands; None if it is not installed."""
    try:
        return importlib.import_module(module)
    except ImportError:
        return None


class ExportedFiles(WithCase):
    """export.py, and the XDMF that the program writes, through readers of others."""

    def exported(self, kind: str) -> Path:
        """The folder that the script has filled."""
        run = self.typed("export.py", self.path, "--format", kind, "--out", self.root / kind)
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        return self.root / kind

    @unittest.skipUnless(reader("meshio"), "no meshio: the package python3-meshio has it")
    def test_obj_and_ply_hold_all_points_triangles_and_fields(self) -> None:
        meshio, case = reader("meshio"), self.case()
        values = all_values(case)
        for kind in ("obj", "ply"):
            folder = self.exported(kind)
            times = [folder / "times.txt"] if kind == "obj" else []
            files = 4 * (1 + len(case.objects)) + len(times)
            self.assertEqual(len(list(folder.iterdir())), files)
            for path in times:
                np.testing.assert_array_equal(np.loadtxt(path), case.frame_times)
            for frame in range(4):
                mesh = meshio.read(folder / f"fold.{frame:04d}.{kind}")
                np.testing.assert_array_equal(mesh.points, case.positions(frame))
                np.testing.assert_array_equal(mesh.cells_dict["triangle"], TWO)
                turned = meshio.read(folder / f"fold-object-0.{frame:04d}.{kind}")
                np.testing.assert_array_equal(turned.points, case.objects[0].positions(frame))
                if kind == "ply":
                    for name in ("speed", "strain", "angle", "phi"):
                        np.testing.assert_array_equal(mesh.point_data[name], values[name][frame])

    @unittest.skipUnless(reader("meshio"), "no meshio: the package python3-meshio has it")
    def test_xdmf_holds_all_frames_and_fields(self) -> None:
        folder, case = self.exported("xdmf"), self.case()
        values = all_values(case)
        with reader("meshio").xdmf.TimeSeriesReader(folder / "fold.xdmf") as read:
            points, cells = read.read_points_cells()
            np.testing.assert_array_equal(points, case.positions(0))
            np.testing.assert_array_equal(cells[0].data, TWO)
            self.assertEqual(read.num_steps, 4)
            for frame in range(4):
                time, of_points, _ = read.read_data(frame)[:3]
                self.assertEqual(time, case.frame_times[frame])
                np.testing.assert_array_equal(
                    of_points["velocity"], case.every_frame("velocities")[frame]
                )
                for name in ("speed", "strain", "angle", "phi"):
                    np.testing.assert_array_equal(of_points[name], values[name][frame])

    def test_caches_hold_all_points_faces_and_times(self) -> None:
        case = self.case()
        points = [case.every_frame("positions"),
                  np.stack([case.objects[0].positions(frame) for frame in range(4)])]
        for name, x in zip(("fold", "fold-object-0"), points):
            with np.load(self.exported("npz") / f"{name}.npz") as npz:
                np.testing.assert_array_equal(npz["vertices"], x)
                np.testing.assert_array_equal(npz["times"], case.frame_times)
                self.assertAlmostEqual(float(npz["fps"]), 3 / np.ptp(case.frame_times), 6)
            pc2 = (self.exported("pc2") / f"{name}.pc2").read_bytes()
            self.assertEqual(struct.unpack("<12siiffi", pc2[:32]),
                             (b"POINTCACHE2\0", 1, x.shape[1], 0, 1, 4))
            np.testing.assert_array_equal(np.frombuffer(pc2[32:], "<f4"), x.astype("<f4").ravel())
            np.testing.assert_array_equal(np.loadtxt(self.root / "pc2/times.txt"), case.frame_times)
        with np.load(self.root / "npz/fold.npz") as npz:
            np.testing.assert_array_equal(npz["faces"], TWO)

    @unittest.skipUnless(reader("pxr.UsdGeom"), "not installed: usd-core of PyPI reads USD")
    def test_usd_reads_all_points_velocities_and_times(self) -> None:
        case, path = self.case(), self.exported("usda") / "fold.usda"
        stage = reader("pxr.Usd").Stage.Open(str(path))
        mesh = reader("pxr.UsdGeom").Mesh(stage.GetDefaultPrim())
        self.assertEqual(reader("pxr.UsdGeom").GetStageMetersPerUnit(stage), 1)
        codes = mesh.GetPointsAttr().GetTimeSamples()
        np.testing.assert_allclose(np.array(codes) / stage.GetTimeCodesPerSecond(),
                                   case.frame_times, atol=1e-9)
        np.testing.assert_array_equal(
            np.reshape(mesh.GetFaceVertexIndicesAttr().Get(), (-1, 3)), TWO)
        for attribute, field in ((mesh.GetPointsAttr(), "positions"),
                                 (mesh.GetVelocitiesAttr(), "velocities")):
            read = np.array([attribute.Get(code) for code in codes])
            np.testing.assert_array_equal(read, case.every_frame(field).astype("f4"))

    @unittest.skipUnless(BPY.exists(), f"skipped: not installed: no {BPY} with bpy of PyPI")
    def test_blender_opens_caches_usd_and_alembic_with_the_same_vertices(self) -> None:
        words = (REPORTS / "DATA.md").read_text(encoding="utf-8")
        lines = words.split("```python\nimport bpy", 1)[1].split("```", 1)[0]
        self.exported("pc2"), self.exported("usda")
        run = subprocess.run([BPY, "-c", ASK_BLENDER.format(lines=f"import bpy{lines}")],
                             text=True, check=False, capture_output=True, cwd=self.root)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        for name in ("usda", "pc2", "abc"):
            with np.load(self.root / f"{name}.npz") as npz:
                np.testing.assert_allclose(npz["vertices"], self.case().every_frame("positions"),
                                           atol=1e-6, err_msg=name)
                np.testing.assert_array_equal(npz["faces"], TWO)

    @unittest.skipUnless(
        shutil.which("pvpython"), "no pvpython: the package python3-paraview has it"
    )
    def test_paraview_reads_both_kinds_of_xdmf(self) -> None:
        case = self.case()
        # what the program writes, and its numbers of 4 bytes
        with h5py.File(self.path, "r+") as file:
            text = program_xdmf(
                self.path.name, file["frames/time"][:], file["frames/positions"].shape,
                len(case.triangles)
            )
        (self.root / "fold.xdmf").write_text(text, encoding="utf-8")
        for path in (self.root / "fold.xdmf", self.exported("xdmf") / "fold.xdmf"):
            run = subprocess.run(
                ["pvpython", "-c", ASK_PARAVIEW, str(path)], text=True, check=False,
                capture_output=True
            )
            told = json.loads(run.stdout.splitlines()[-1]) if run.stdout.strip() else {}
            self.assertEqual(told.get("times"), case.frame_times.tolist(), run.stderr)
            for frame in range(4):
                np.testing.assert_allclose(told["points"][frame], case.positions(frame), atol=1e-15)
                np.testing.assert_allclose(
                    told["velocities"][frame], case.every_frame("velocities")[frame], atol=1e-15
                )
            self.assertEqual(told["triangles"], len(TWO))

    def test_a_file_that_is_no_simulation_is_refused_in_one_line(self) -> None:
        self.path.write_bytes(b"no HDF5")
        run = self.typed("export.py", self.path, "--format", "ply", "--out", self.root)
        self.assert_refused(run, "no HDF5 file")


def program_xdmf(file: str, times: np.ndarray, shape: tuple[int, ...], triangles: int) -> str:
    """The XDMF that verification/files/trajectory_file.cpp writes: its own text, filled in."""
    source = (REPORTS.parent / "verification" / "files" / "trajectory_file.cpp").read_text(
        encoding="utf-8"
    )
    head, frame = (
        source.split(f'{name} = R"(', 1)[1].split(')";', 1)[0]
        for name in ("xdmf_head", "xdmf_frame")
    )
    filled = [
        frame.replace("{time:.17g}", f"{time:.17g}").format(
            frame=k, file=file, triangles=triangles, particles=shape[1], frames=shape[0]
        )
        for k, time in enumerate(times)
    ]
    return head + "".join(filled) + "    </Grid>\n  </Domain>\n</Xdmf>\n"


ASK_BLENDER = """
import os
import bpy
bpy.ops.wm.read_factory_settings(use_empty=True)

def save(name):
    bpy.context.view_layer.objects.active = next(
        each for each in bpy.data.objects if each.type == "MESH")
    exec({lines!r}, {{}})
    os.rename("cloth.npz", name + ".npz")

bpy.ops.wm.usd_import(filepath="usda/fold.usda")
save("usda")
bpy.ops.wm.alembic_export(filepath="fold.abc", start=0, end=bpy.context.scene.frame_end)
bpy.context.object.modifiers.clear()
cache = bpy.context.object.modifiers.new("cache", "MESH_CACHE")
cache.cache_format, cache.filepath, cache.frame_start = "PC2", "pc2/fold.pc2", 0
save("pc2")
bpy.context.object.select_set(True)
bpy.ops.object.delete()
bpy.ops.wm.alembic_import(filepath="fold.abc", as_background_job=False)
save("abc")
"""
ASK_PARAVIEW = """
import json, sys
from paraview.simple import XDMFReader
from paraview import servermanager
from vtkmodules.util.numpy_support import vtk_to_numpy
reader = XDMFReader(FileNames=[sys.argv[1]])
reader.UpdatePipelineInformation()
told = {"times": list(reader.TimestepValues), "points": [], "velocities": []}
for time in told["times"]:
    reader.UpdatePipeline(time)
    grid = servermanager.Fetch(reader)
    while grid.IsA("vtkMultiBlockDataSet"):
        grid = grid.GetBlock(0)
    told["points"].append(vtk_to_numpy(grid.GetPoints().GetData()).tolist())
    told["velocities"].append(vtk_to_numpy(grid.GetPointData().GetArray("velocity")).tolist())
    told["triangles"] = grid.GetNumberOfCells()
print(json.dumps(told))
"""
