#!/usr/bin/python3
"""Tests `foldproof judge --frames`: frames that the program exported, whole and damaged, as a user
without an adapter meets them.

scripts/tests/test_judge_frames.py [--program FILE] [--all] [JudgeFrames.test_...]
--program: instead of build/foldproof; --all: the own frames of every shipped case, which takes
an hour
"""

import json
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

import h5py
import numpy as np

from program_case import ROOT, ProgramCase, run

CASE = "drape_sphere"
RATE = ("--rate", "30")
FORMS = ("obj", "ply", "pc2", "npz", "usda")
# shipped cases of some seconds, among them the one that rests within 1e-12 m on a slope, the one
# that slides there, the one whose folds turn fastest between two frames, the one whose bending
# energy changes most by rounding, and the one that starts crossed, with layers that touch
QUICK_CASES = ("incline", "incline_slides", "spinning_sphere", "hanging_sheet", "hinge", "pinch",
               "hard/stiff_bending", "hard/reef_fold")
SHIPPED = sorted(str(file.relative_to(ROOT / "cases").with_suffix(""))
                 for file in (ROOT / "cases").rglob("*.toml") if "\n[time]" in file.read_text())
# Limits on strain come before objects and self-collision, which stretch springs once more.
NOT_HELD = {"hard/fast": {"frames.springs-stay-within-limits"}}
own_cases = SHIPPED if "--all" in sys.argv else QUICK_CASES


class JudgeFrames(ProgramCase):
    def setUp(self) -> None:
        super().setUp()
        self.assert_holds(self.simulate(CASE))
        for form in ("ply", "obj"):
            run("export", f"{self.out}/{CASE}.h5", "--format", form, "--out", self.path / form)

    def run_judge(self, form: str, *words: str) -> subprocess.CompletedProcess[str]:
        return run("judge", "--frames", self.path / form, "--case", CASE, *words)

    def judge(self, form: str, *words: str) -> dict[str, str]:
        done = self.run_judge(form, "--json", *words)
        self.assertIn(done.returncode, (0, 1), done.stderr)
        return {row["name"]: row["outcome"] for row in json.loads(done.stdout)["findings"]}

    def test_frames_of_the_reference_meet_every_law(self) -> None:
        for form in FORMS:
            run("export", f"{self.out}/{CASE}.h5", "--format", form, "--out", self.path / form)
            outcomes = self.judge(form)
            self.assertLessEqual(set(outcomes.values()), {"holds", "not applicable"})
            for law in ("never-cross-themselves", "energy-stays-in-budget"):  # of its particles
                self.assertEqual(outcomes[f"frames.{law}"], "holds")

    def test_a_stray_file_and_frames_of_upper_case_endings(self) -> None:
        for frame in (self.path / "obj").glob(f"{CASE}.*.obj"):
            frame.rename(frame.with_suffix(".OBJ"))
        self.assertEqual(self.judge("obj", *RATE)["frames.end-is-reached"], "holds")
        shutil.copy(self.path / f"obj/{CASE}.0003.OBJ", self.path / f"obj/{CASE}.OBJ")
        self.assert_refused(self.run_judge("obj", *RATE), f"{CASE}.OBJ: has no number")

    def test_a_damaged_frame_is_found_and_both_stand_on_one_page(self) -> None:
        shutil.copytree(self.path / "obj", self.path / "bad")
        last = sorted((self.path / "bad").glob("*.obj"))[-1]
        lines = [line.split() for line in last.read_text(encoding="utf-8").splitlines()]
        sunk = [[*line[:2], str(float(line[2]) - 0.1), *line[3:]] if line[:1] == ["v"] else line
                for line in lines]
        last.write_text("\n".join(map(" ".join, sunk)) + "\n", encoding="utf-8")
        outs = [str(self.path / f"judged_{form}") for form in ("obj", "bad")]
        for form, out in zip(("obj", "bad"), outs):
            outcomes = self.judge(form, *RATE, "--out", out, "--name", form)
            self.assertEqual(outcomes["frames.vertices-stay-outside"],
                             "holds" if form == "obj" else "fails")
        self.assertIn(f"frames.{CASE}", self.page_of(outs[1]))
        self.assertIn("frames.vertices-stay-outside", self.page_of(*outs, name="compare.html"))
        done = self.run_judge("bad", *RATE, "--baseline", f"{outs[0]}/verdicts.json")
        self.assertEqual(done.returncode, 1)
        self.assertIn("worse: frames.vertices-stay-outside", done.stdout)

    def test_other_units_are_told_from_a_wrong_motion(self) -> None:
        done = self.run_judge("obj", *RATE, "--set", "cloth.width=0.9")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("suspect units, axes, the order of vertices", done.stdout)

    def test_a_gap_in_the_numbers_is_named_where_a_rate_counts_them(self) -> None:
        frames = sorted((self.path / "obj").glob(f"{CASE}.*.obj"))
        lost = frames[3]
        lost.unlink()
        number = int(lost.stem.rsplit(".", 1)[-1])
        self.assert_refused(self.run_judge("obj", *RATE), f"frame {number} is missing before it")
        for frame in frames[1::2]:  # every other frame, at half the rate
            frame.unlink(missing_ok=True)
        self.assertEqual(self.judge("obj", "--rate", "15")["frames.end-is-reached"], "holds")

    def test_another_mesh_is_told_in_words(self) -> None:
        frame = sorted((self.path / "obj").glob(f"{CASE}.*.obj"))[0]
        text = frame.read_text(encoding="utf-8").splitlines()
        at = next(k for k, line in enumerate(text) if line.startswith("f "))
        word, *corners = text[at].split()
        for order, said in (((0, 2, 1), "one of the case's turned over"),
                            ((0, 0, 1), "none of the case's")):
            text[at] = " ".join([word, *(corners[k] for k in order)])
            frame.write_text("\n".join(text) + "\n", encoding="utf-8")
            heading = self.run_judge("obj", *RATE).stdout.splitlines()[1]
            self.assertIn("vertex order cannot match, triangle 0,", heading)
            self.assertIn(said, heading)
            self.assertIn("judged as another mesh", heading)

    def test_a_page_of_frames_speaks_of_no_solver(self) -> None:
        outs = [str(self.path / f"judged_{form}") for form in ("obj", "ply")]
        for form, out in zip(("obj", "ply"), outs):
            count = len(self.judge(form, "--out", out))
        for page in (self.page_of(outs[0]), self.page_of(*outs, name="compare.html")):
            self.assertIn("needs prescribed particles", page)
            self.assertIn(f"{count} findings on", page)
            for word in ("this solver", "its adapter", "does not offer", "own process"):
                self.assertNotIn(word, page)

    def test_bad_input_is_one_line(self) -> None:
        obj = str(self.path / "obj")
        (self.path / "obj/times.txt").unlink()
        for typed, said in (
            (("--frames", obj), "--case"), (("--case", CASE), "--frames"),
            (("--frames", obj, "--case", CASE), "--times FILE or --rate FPS"),
            (("--frames", obj, "--case", "no_such_case"), "no_such_case"),
            (("--frames", obj, "--case", CASE, "--solver", "x"), "--solver"),
            (("--frames", obj, "--case", CASE, *RATE, "--settings", "a=1"), "--settings"),
            (("--solver", "x", "--set", "time.end=1"), "--frames"), ((), "--solver")
        ):
            self.assertIn(said, self.assert_rejected("judge", *typed))


class ExportedCases(ProgramCase):
    def write_text(self, case: str, form: str) -> None:
        """OBJ frames with another format of their numbers."""
        with h5py.File(f"{self.out}/{case}.h5") as file:
            frames, times = file["frames/positions"][:], file["frames/time"][:]
            faces = [f"f {a} {b} {c}" for a, b, c in file["mesh/triangles"][:] + 1]
        self.write("frames/times.txt", "".join(f"{time:.9g}\n" for time in times))
        for number, frame in enumerate(frames):
            rows = ["v " + " ".join(form % x for x in row) for row in frame]
            self.write(f"frames/{case}_{number}.obj", "\n".join(rows + faces) + "\n")

    def write_single(self, case: str) -> None:
        """An archive of float32, deflated."""
        with h5py.File(f"{self.out}/{case}.h5") as file:
            np.savez_compressed(
                self.path / "frames/single.npz", fps=1 / file["frames/time"][1],
                vertices=file["frames/positions"][:].astype("f4"),
                faces=file["mesh/triangles"][:])

    def test_own_frames_meet_every_law_at_the_digits_of_every_format(self) -> None:
        for shipped in own_cases:
            case = Path(shipped).name
            self.assert_holds(self.simulate(shipped))
            for form in ("%.6f", "%.9g", "npz", "pc2", "usda"):
                (self.path / "frames").mkdir()
                if form.startswith("%"):
                    self.write_text(case, form)
                elif form == "npz":
                    self.write_single(case)
                else:
                    run("export", f"{self.out}/{case}.h5", "--format", form, "--out",
                        self.path / "frames")
                with self.subTest(case=case, form=form):
                    told = self.told("judge", "--frames", self.path / "frames", "--case", shipped)
                    others = {row["name"] for row in told["findings"]
                              if row["outcome"] not in ("holds", "not applicable")}
                    self.assertEqual(others, NOT_HELD.get(shipped, set()))
                shutil.rmtree(self.path / "frames")

    def test_an_exported_body_moves_cloth_in_every_format(self) -> None:
        ball = """
[[object]]
name = "ball"
shape = "statue"
height = 0.3
subdivisions = 3
cells = 8
interval = 0.02
deform = [{ kind = "twist", amplitude = 20, period = 0.2 }]
"""
        cloth = """
[cloth]
shape = "sheet"
width = 0.2
height = 0.2
columns = 3
rows = 3
density = 0.2
move = [0, 0.5, 0]
[gravity]
[stretch]
stiffness = 20
[time]
end = 0.04
frames_per_second = 50
"""
        self.assert_holds(self.simulate(self.write("own.toml", cloth + ball)))
        with h5py.File(f"{self.out}/own.h5") as file:
            faces = file["objects/0/triangles"][:] + 1
        for form in FORMS:
            out = self.path / form
            run("export", f"{self.out}/own.h5", "--format", form, "--out", out)
            for other in [*out.glob("own.*")]:
                other.unlink()  # the cloth's
            frames = form if form in ("obj", "ply") else f"{form}/own-object-0.{form}"
            keys = f'frames = "{frames}"\ncells = 8\n'
            if form == "pc2":
                text = "v 0 0 0\n" * (faces.max() - 1) + "v 1 1 1\n"
                self.write("b.obj", text + "".join(f"f {a} {b} {c}\n" for a, b, c in faces))
                keys += 'mesh = "b.obj"\n'
            if form not in ("npz", "usda"):
                keys += "interval = 0.02\n"
            text = cloth + "[[object]]\n" + keys
            self.assert_holds(self.simulate(self.write(f"{form}.toml", text)))
            read = [h5py.File(f"{self.out}/{name}.h5")["objects/0/positions"][:]
                    for name in ("own", form)]
            np.testing.assert_allclose(*read, atol=1e-7)


if __name__ == "__main__":
    unittest.main(argv=[word for word in sys.argv if word != "--all"])
