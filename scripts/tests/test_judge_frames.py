#!/usr/bin/python3
"""Tests `foldproof judge --frames`: frames that the program exported, whole and damaged, as a user
without an adapter meets them."""

import json
import shutil
import sys
import unittest

sys.dont_write_bytecode = True

from file_tests import FileTest, run  # noqa: E402

CASE = "drape_sphere"
RATE = ("--rate", "30")


class JudgeFrames(FileTest):

    def setUp(self) -> None:
        super().setUp()
        self.assertEqual(self.simulate(CASE).returncode, 0)
        for form in ("ply", "obj"):
            run(
                "export", str(self.path / f"out/{CASE}.h5"), "--format", form, "--out",
                str(self.path / form)
            )

    def judge(self, form: str, *words: str) -> dict[str, str]:
        done = run("judge", "--frames", str(self.path / form), "--case", CASE, "--json", *words)
        self.assertIn(done.returncode, (0, 1), done.stderr)
        return {row["name"]: row["outcome"] for row in json.loads(done.stdout)["findings"]}

    def test_frames_of_the_reference_meet_every_law(self) -> None:
        for form in ("ply", "obj"):
            outcomes = self.judge(form)
            self.assertLessEqual(set(outcomes.values()), {"holds", "not applicable"})
            self.assertEqual(outcomes["frames.never-cross-themselves"], "holds")

    def test_a_damaged_frame_is_found_and_both_stand_on_one_page(self) -> None:
        shutil.copytree(self.path / "obj", self.path / "bad")
        last = sorted((self.path / "bad").glob("*.obj"))[-1]
        lines = [line.split() for line in last.read_text(encoding="utf-8").splitlines()]
        sunk = [
            [*line[:2], str(float(line[2]) - 0.1), *line[3:]] if line and line[0] == "v" else line
            for line in lines
        ]
        last.write_text("\n".join(map(" ".join, sunk)) + "\n", encoding="utf-8")
        outs = [str(self.path / f"judged_{form}") for form in ("obj", "bad")]
        for form, out in zip(("obj", "bad"), outs):
            outcomes = self.judge(form, *RATE, "--out", out, "--name", form)
            self.assertEqual(
                outcomes["frames.vertices-stay-outside"], "holds" if form == "obj" else "fails"
            )
        for arguments in (outs[1:], outs):
            done = run("report", *arguments)
            self.assertEqual(done.returncode, 0, done.stderr)
        page = (self.path / "judged_bad/compare.html").read_text(encoding="utf-8")
        self.assertIn("frames.vertices-stay-outside", page)
        alone = (self.path / "judged_bad/report.html").read_text(encoding="utf-8")
        self.assertIn(f"frames.{CASE}", alone)
        baseline = f"{outs[0]}/verdicts.json"
        done = run(
            "judge", "--frames", str(self.path / "bad"), "--case", CASE, *RATE, "--baseline",
            baseline
        )
        self.assertEqual(done.returncode, 1)
        self.assertIn("worse: frames.vertices-stay-outside", done.stdout)

    def test_other_units_are_told_from_a_wrong_motion(self) -> None:
        done = run(
            "judge", "--frames", str(self.path / "obj"), "--case", CASE, *RATE, "--set",
            "cloth.width=0.9"
        )
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("suspect units, axes, the order of vertices", done.stdout)

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
            self.assert_rejected(run("judge", *typed), said)


if __name__ == "__main__":
    unittest.main()
