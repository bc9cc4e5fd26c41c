#!/usr/bin/python3
"""Tests that nothing is lost: kills at any moment, full disks, missing rights.

Usage: scripts/tests/test_durability.py [--kills N] [options of unittest]   (default: 10 kills)
"""

import json
import os
import random
import resource
import shutil
import subprocess
import sys
import time
import unittest
from pathlib import Path
from typing import Any, NamedTuple

import h5py

from file_tests import LED_CASE, SEED, SMALL_CASE, TRIANGLES, FileTest, content_of
from program_case import ROOT, run, run_until

KILLS = 10
NOBODY = 65534
CHECK = ("check", "bending.forces-sum-to-zero", "--out")


class KilledCase(NamedTuple):
    file: str
    options: list[str]
    content: dict[str, bytes]  # of the run that nothing interrupts
    xdmf: str
    told: dict
    seconds: float  # how long it takes


class Kills(FileTest):
    """kill -9 at random moments, some runs twice; every run ends with the bits of the uninterrupted
    one."""

    def cases(self) -> list[tuple[str, list[str]]]:
        for name in ("hard/sticky_layers.toml", "hard/two_layers.obj", "grab.toml",
                     "hard/reef_fold.toml"):
            shutil.copy(ROOT / "cases" / name, self.path)
        self.write("led.toml", LED_CASE)
        settings = {
            "led": "", "sticky_layers": "time.end=0.1 time.frames_per_second=200",
            "grab": "time.end=0.34 expect.is_lifted.at_least=1e-3 cloth.columns=8 cloth.rows=8",
            "reef_fold": "time.end=0.02 time.frames_per_second=900"
        }
        return [(str(self.path / f"{name}.toml"), [f"--set={key}" for key in keys.split()])
                for name, keys in settings.items()]

    def told_by(self, file: str, options: list[str], *more: str, out: str) -> dict:
        """Output of a run without its clock time and folder, and what it says on the side."""
        done = self.simulate(file, *options, *more, "--json", out=out)
        self.assertIn(done.returncode, (0, 1), done.stderr)
        name = Path(file).stem
        self.assertEqual(sorted(path.name for path in (self.path / out).iterdir()),
                         [f"{name}.h5", f"{name}.xdmf"])
        self.said = done.stderr
        return {key: value for key, value in json.loads(done.stdout).items()
                if key not in ("seconds", "file")}

    def run_uninterrupted(self, file: str, options: list[str]) -> KilledCase:
        name, start = Path(file).stem, time.monotonic()
        told = self.told_by(file, options, out=f"whole/{name}")
        seconds = time.monotonic() - start
        stored = self.path / "whole" / name / name
        return KilledCase(file, options, content_of(stored.with_suffix(".h5")),
                          stored.with_suffix(".xdmf").read_text(), told, seconds)

    def run_and_kill(self, case: KilledCase, out: Path, wait: float, *more: str) -> bool:
        """Starts the run, kills it after `wait` seconds; whether it was still running."""
        end = time.monotonic() + wait
        done = run_until(lambda _: time.monotonic() > end, "simulate", case.file, *case.options,
                         "--out", out, *more)
        self.assertIn(done.returncode, (-9, 0, 1))
        return done.returncode == -9

    def require_whole_files(self, case: KilledCase, out: Path) -> None:
        """Every file that does not say it is partial is whole."""
        for path in (p for p in out.rglob("*") if p.is_file() and p.suffix != ".partial"):
            if path.suffix == ".xdmf":
                self.assertEqual(path.read_text(), case.xdmf)
            elif path.parent == out:
                self.assertEqual(content_of(path), case.content)
            else:
                with h5py.File(path, "r") as file:
                    self.assertEqual(len(file.attrs["content"]), 16)
                    file.visititems(
                        lambda _, item: item[()] if isinstance(item, h5py.Dataset) else None)

    def finish(self, case: KilledCase, out: str = "out") -> str:
        """Resumes to the end and compares with the uninterrupted run. Returns
        what was said of the resumption."""
        self.assertEqual(self.told_by(case.file, case.options, "--resume", out=out), case.told)
        stored = self.path / out / Path(case.file).stem
        self.assertEqual(content_of(stored.with_suffix(".h5")), case.content)
        self.assertEqual(stored.with_suffix(".xdmf").read_text(), case.xdmf)
        return self.said

    def test_a_run_that_is_killed_at_any_moment_resumes_to_the_same_bits(self) -> None:
        cases = [self.run_uninterrupted(*case) for case in self.cases()]
        moments = random.Random(SEED)
        hits = again = resumed = damaged = 0
        for number in range(KILLS):
            case, out = cases[number % len(cases)], self.path / f"trial{number}"
            with self.subTest(kill=number, case=case.file):
                hits += self.run_and_kill(case, out, moments.uniform(0, 1.1 * case.seconds))
                self.require_whole_files(case, out)
                if moments.random() < 0.5:
                    again += self.run_and_kill(case, out, moments.uniform(0, case.seconds),
                                               "--resume")
                    self.require_whole_files(case, out)
                said = self.finish(case, out.name)
                resumed += "resumed from frame" in said
                damaged += "damaged" in said
            shutil.rmtree(out, ignore_errors=True)
        print(f"\n{KILLS} trials (seed {SEED}): {hits} runs killed, {again} of them twice or when"
              f" resumed, {resumed} resumed from a checkpoint, {damaged} of them found a damaged"
              " one", flush=True)
        self.assertEqual(damaged, 0)
        self.assertGreater(resumed, KILLS // 8)

    def stop_short(self) -> tuple[KilledCase, Path]:
        """A run that is killed when it has written a dozen checkpoints; their folder."""
        case = self.run_uninterrupted(*self.cases()[0])
        kept = self.path / "out/led.checkpoints"
        run_until(lambda _: (kept / "000012.h5").exists(), "simulate", case.file, "--out", self.out)
        self.assertTrue((kept / "000012.h5").exists())
        return case, kept

    def test_a_damaged_checkpoint_is_named_and_the_one_before_is_taken(self) -> None:
        case, kept = self.stop_short()
        last = sorted(kept.glob("*.h5"))[-1]
        with h5py.File(last, "r+") as file:
            file["past/0/numbers"][5] += 1e-9
        said = self.finish(case)
        self.assertIn(f"{last}: this checkpoint is damaged and left out", said)
        self.assertIn(f"resumed from frame {int(last.stem) - 1},", said)

    def test_another_mesh_is_told_from_the_one_that_was_read(self) -> None:
        mesh = self.write("any.obj", TRIANGLES)
        case = self.write("own.toml", '[cloth]\nmesh = "any.obj"\ndensity = 0.1\n[gravity]\n'
                                      '[time]\nend = 9\nstep = 1e-4\n')
        kept = self.path / "out/own.checkpoints/000002.h5"
        run_until(lambda _: kept.exists(), "simulate", case, "--out", self.out)
        Path(mesh).write_text(TRIANGLES.replace("v 1 1 0", "v 1 1 0.01"))
        self.assert_refused(self.simulate(case, "--resume"), "other meshes")

    def test_a_restart_removes_checkpoints_and_leaves_other_files(self) -> None:
        case, kept = self.stop_short()
        (kept / "notes.txt").write_text("mine")
        self.assert_refused(self.simulate(case.file), "led.checkpoints", "--resume", "--restart")
        self.assert_holds(self.simulate(case.file, "--restart"))
        self.assertEqual([path.name for path in kept.iterdir()], ["notes.txt"])
        self.assertEqual(content_of(self.path / "out/led.h5"), case.content)


class FullDisk(FileTest):
    """A failed write is an error; existing files stay, and the run can be resumed."""

    def assert_cannot_write(self, most: int, *command: str, mentions: str = "cannot be written",
                            **how: Any) -> None:
        """Of a command under which no file may grow beyond so many bytes."""
        self.assert_refused(run(*command, limits={resource.RLIMIT_FSIZE: most}, **how), mentions)

    def files_in(self, folder: Path) -> dict[str, bytes]:
        return {path.name: path.read_bytes() for path in folder.iterdir()
                if path.is_file() and path.suffix != ".partial"}

    def test_a_file_that_may_grow_no_further_loses_nothing(self) -> None:
        case, out = self.write("small.toml", SMALL_CASE), self.path / "out"
        self.assert_holds(self.simulate(case))
        content, size = content_of(out / "small.h5"), (out / "small.h5").stat().st_size
        other = (case, "--set", "time.max_steps=1000")
        stops = random.Random(SEED)
        for most in [0, 1, 700, 2048, 4096, size - 1, *(stops.randrange(size) for _ in range(12))]:
            with self.subTest(bytes=most):
                before = self.files_in(out)
                self.assert_cannot_write(most, "simulate", *other, "--out", self.out)
                self.assertEqual(self.files_in(out), before)
                self.assert_holds(self.simulate(*other, "--resume"))
                again = content_of(out / "small.h5") | {"@case_text": content["@case_text"]}
                self.assertEqual(again, content)
                shutil.rmtree(out)
                self.assert_holds(self.simulate(case))

    def test_findings_and_verdicts_are_all_there_or_as_they_were(self) -> None:
        self.assert_holds(run(*CHECK, self.out))
        out = self.path / "out"
        before = self.files_in(out)
        for most in (0, 500, 4000, len(before["run.h5"]) - 1):
            self.assert_cannot_write(most, *CHECK, self.out, "--restart")
            self.assertEqual(self.files_in(out), before)
            self.assertFalse(list(out.glob("*.partial")))

    def test_level_sets_and_reports_too(self) -> None:
        shutil.copy(ROOT / "cases/statue.ply", self.path)
        case = self.write("draped.toml", (ROOT / "cases/drape_statue.toml").read_text())
        kept, page = self.path / "kept", self.path / "out/report.html"
        self.assert_cannot_write(1000, "simulate", case, "--set", "time.end=0.01", "--set",
                                 "object.cells=10", "--cache", str(kept), "--out", self.out)
        self.assertFalse(list(kept.iterdir()))
        self.assertIn(self.simulate(self.write("small.toml", SMALL_CASE)).returncode, (0, 1))
        page.write_text("as it was")
        self.assert_cannot_write(3000, "report", self.out, mentions="report could not be made")
        self.assertEqual(page.read_text(), "as it was")
        self.assertFalse(list(page.parent.rglob("*.partial")))

    def test_standard_output_that_is_full_is_an_error(self) -> None:
        with open("/dev/full", "wb") as full:
            for command in ("golden springs --count 9", "list checks", "list --json"):
                self.assert_refused(run(*command.split(), stdout=full.fileno()),
                                    "standard output cannot be written")

    def test_a_disk_that_is_really_full(self) -> None:
        if os.geteuid() != 0:
            self.skip_and_say("only root mounts a small file system")
        disk = self.path / "disk"
        disk.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=96k", "tmpfs", disk],
                                 capture_output=True, text=True, check=False)
        if mounted.returncode != 0:
            self.skip_and_say(f"a small file system cannot be mounted here: {mounted.stderr}")
        try:
            (disk / "small.h5").write_text("as it was")
            done = self.simulate(self.write("small.toml", SMALL_CASE), out="disk")
            self.assert_refused(done, "cannot be written")
            self.assertEqual((disk / "small.h5").read_text(), "as it was")
            self.assertIn(run("check", "bending", "--out", disk).returncode, (0, 2))
        finally:
            subprocess.run(["umount", disk], check=True)


class Rights(FileTest):
    """Folders that may not be written, and output paths that are something else."""

    USER = NOBODY if os.geteuid() == 0 else None

    def test_a_folder_without_rights_is_named(self) -> None:
        case, out = self.write("small.toml", SMALL_CASE), self.path / "out"
        self.write("out/small.h5", "as it was")
        out.chmod(0o555)
        try:
            reaches = run("--version", user=self.USER).returncode == 0
        except PermissionError:
            reaches = False
        if not reaches:
            self.skip_and_say("an unprivileged user cannot reach the program here")
        for command, mentions in (
            (("simulate", case, "--out", self.out), self.out),
            (("simulate", case, "--out", self.out + "/new"), "new: cannot make this folder"),
            ((*CHECK, self.out), self.out), (("report", self.out), "report")
        ):
            self.assert_refused(run(*command, user=self.USER), mentions)
        self.assertEqual([path.name for path in out.iterdir()], ["small.h5"])
        self.assertEqual((out / "small.h5").read_text(), "as it was")
        out.chmod(0o755)

    def test_an_input_without_rights_is_named(self) -> None:
        if os.geteuid() != 0:
            self.skip_and_say("only root runs as another user")
        case = self.write("secret.toml", SMALL_CASE)
        Path(case).chmod(0o600)
        self.assert_refused(run("simulate", case, "--out", "/tmp/never", user=NOBODY),
                            "secret.toml", "Permission denied")

    def test_an_output_path_that_is_a_file_or_a_folder(self) -> None:
        case, taken = self.write("small.toml", SMALL_CASE), self.write("taken", "mine")
        self.assert_refused(run("simulate", case, "--out", taken), "taken",
                            "cannot make this folder")
        (self.path / "out/small.h5").mkdir(parents=True)
        self.assert_refused(self.simulate(case), "small.h5", "what is there is no file")
        (self.path / "out/small.h5").rmdir()
        kept = self.write("out/small.checkpoints", "mine")
        self.assert_refused(self.simulate(case), "small.checkpoints")
        for file in (kept, taken):
            self.assertEqual(Path(file).read_text(), "mine")
        (self.path / "out2/run.h5").mkdir(parents=True)
        self.assert_refused(run(*CHECK, self.path / "out2"), "run.h5")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--kills"]:
        KILLS = int(sys.argv[2])
        del sys.argv[1:3]
    unittest.main()
