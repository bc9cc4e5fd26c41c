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
from typing import NamedTuple

import h5py

sys.dont_write_bytecode = True

from file_tests import (
    LED_CASE, PROGRAM, ROOT, SEED, SMALL_CASE, TRIANGLES, FileTest, content_of, run
)  # noqa: E402

KILLS = 10
NOBODY = 65534


class KilledCase(NamedTuple):
    file: str
    options: tuple[str, ...]
    content: dict[str, bytes]  # of the run that nothing interrupts
    xdmf: str
    told: dict
    seconds: float  # how long it takes


class Kills(FileTest):
    """kill -9 at random moments, some runs twice; every run ends with the
    bits of the uninterrupted one."""

    def cases(self) -> list[tuple[str, tuple[str, ...]]]:
        for name in (
            "hard/sticky_layers.toml", "hard/two_layers.obj", "grab.toml", "hard/reef_fold.toml"
        ):
            shutil.copy(ROOT / "cases" / name, self.path)
        return [
            (self.write("led.toml", LED_CASE), ()),
            (
                str(self.path / "sticky_layers.toml"),
                ("--set", "time.end=0.1", "--set", "time.frames_per_second=200"),
            ),
            (
                str(self.path / "grab.toml"),
                (
                    "--set", "time.end=0.34", "--set", "expect.is_lifted.at_least=1e-3", "--set",
                    "cloth.columns=8", "--set", "cloth.rows=8"
                ),
            ),
            (
                str(self.path / "reef_fold.toml"),
                ("--set", "time.end=0.02", "--set", "time.frames_per_second=900"),
            ),
        ]

    def run_uninterrupted(self, file: str, options: tuple[str, ...]) -> KilledCase:
        name = Path(file).stem
        start = time.monotonic()
        done = self.simulate(file, *options, "--json", out=f"whole/{name}")
        seconds = time.monotonic() - start
        self.assertIn(done.returncode, (0, 1), done.stderr)
        out = self.path / "whole" / name
        self.assertEqual(
            sorted(path.name for path in out.iterdir()), [f"{name}.h5", f"{name}.xdmf"]
        )
        return KilledCase(
            file, options, content_of(out / f"{name}.h5"), (out / f"{name}.xdmf").read_text(),
            self.report_of(done.stdout), seconds
        )

    def report_of(self, printed: str) -> dict:
        """Output of a run without its clock time and folder."""
        return {
            key: value
            for key, value in json.loads(printed).items()
            if key not in ("seconds", "file")
        }

    def run_and_kill(self, case: KilledCase, out: Path, wait: float, *more: str) -> bool:
        """Starts the run, kills it after `wait` seconds; whether it was still running."""
        command = [str(PROGRAM), "simulate", case.file, *case.options, "--out", str(out), *more]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            process.wait(wait)
            return False
        except subprocess.TimeoutExpired:
            process.kill()
            code = process.wait()
            # it may have finished in the moment before the signal
            self.assertIn(code, (-9, 0, 1))
            return code == -9

    def require_whole_files(self, case: KilledCase, out: Path) -> int:
        """Every file that does not say it is partial is whole.
        Returns the number of checkpoints."""
        checkpoints = 0
        for path in (p for p in out.rglob("*") if p.is_file() and p.suffix != ".partial"):
            if path.suffix == ".xdmf":
                self.assertEqual(path.read_text(), case.xdmf)
            elif path.parent == out:
                self.assertEqual(content_of(path), case.content)
            else:
                checkpoints += 1
                with h5py.File(path, "r") as file:
                    self.assertEqual(len(file.attrs["content"]), 16)
                    file.visititems(
                        lambda _, item: item[()] if isinstance(item, h5py.Dataset) else None
                    )
        return checkpoints

    def finish(self, case: KilledCase, out: Path) -> str:
        """Resumes to the end and compares with the uninterrupted run. Returns
        what was said of the resumption."""
        name = Path(case.file).stem
        done = run("simulate", case.file, *case.options, "--out", str(out), "--resume", "--json")
        self.assertIn(done.returncode, (0, 1), done.stderr)
        self.assertEqual(self.report_of(done.stdout), case.told)
        self.assertEqual(
            sorted(path.name for path in out.iterdir()), [f"{name}.h5", f"{name}.xdmf"]
        )
        self.assertEqual(content_of(out / f"{name}.h5"), case.content)
        self.assertEqual((out / f"{name}.xdmf").read_text(), case.xdmf)
        return done.stderr

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
                    again += self.run_and_kill(
                        case, out, moments.uniform(0, case.seconds), "--resume"
                    )
                    self.require_whole_files(case, out)
                said = self.finish(case, out)
                resumed += "resumed from frame" in said
                damaged += "damaged" in said
            shutil.rmtree(out, ignore_errors=True)
        print(
            (
                f"\n{KILLS} trials (seed {SEED}): {hits} runs killed, {again} of them twice or when"
                f" resumed, {resumed} resumed from a checkpoint, {damaged} of them found a"
                " damaged one"
            ),
            flush=True,
        )
        self.assertEqual(damaged, 0)
        self.assertGreater(resumed, KILLS // 8)

    def stop_short(self) -> tuple[KilledCase, Path]:
        """A run that is killed when it has written a dozen checkpoints."""
        case, out = self.run_uninterrupted(*self.cases()[0]), self.path / "out"
        process = subprocess.Popen([str(PROGRAM), "simulate", case.file, "--out", str(out)],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while process.poll() is None and not (out / "led.checkpoints/000012.h5").exists():
            time.sleep(0.002)
        process.kill()
        process.wait()
        self.assertTrue((out / "led.checkpoints/000012.h5").exists())
        return case, out

    def test_a_damaged_checkpoint_is_named_and_the_one_before_is_taken(self) -> None:
        case, out = self.stop_short()
        last = sorted((out / "led.checkpoints").glob("*.h5"))[-1]
        with h5py.File(last, "r+") as file:
            file["past/0/numbers"][5] += 1e-9
        said = self.finish(case, out)
        self.assertIn(f"{last}: this checkpoint is damaged and left out", said)
        self.assertIn(f"resumed from frame {int(last.stem) - 1},", said)

    def test_a_checkpoint_of_something_else_is_refused_and_stays(self) -> None:
        case, out = self.stop_short()
        before = {path.name: path.read_bytes() for path in (out / "led.checkpoints").glob("*.h5")}
        self.assert_rejected(
            run(
                "simulate", case.file, "--set", "gravity.acceleration=[0,-9,0]", "--out", str(out),
                "--resume"
            ),
            "another case text",
            "--restart",
        )
        with h5py.File(out / "led.checkpoints/000000.h5") as file:
            self.assertIn("code ", file.attrs["program"])
        self.assertEqual(
            before,
            {path.name: path.read_bytes() for path in (out / "led.checkpoints").glob("*.h5")},
        )
        self.finish(case, out)

    def test_another_mesh_is_told_from_the_one_that_was_read(self) -> None:
        mesh = self.write("any.obj", TRIANGLES)
        case = self.write(
            "own.toml",
            '[cloth]\nmesh = "any.obj"\ndensity = 0.1\n[gravity]\n[time]\nend = 9\nstep = 1e-4\n',
        )
        process = subprocess.Popen(
            [str(PROGRAM), "simulate", case, "--out", str(self.path / "out")],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        while process.poll() is None and not (self.path / "out/own.checkpoints/000002.h5").exists():
            time.sleep(0.002)
        process.kill()
        process.wait()
        Path(mesh).write_text(TRIANGLES.replace("v 1 1 0", "v 1 1 0.01"))
        self.assert_rejected(self.simulate(case, "--resume"), "other meshes")

    def test_a_restart_removes_checkpoints_and_leaves_other_files(self) -> None:
        case, out = self.stop_short()
        mine = out / "led.checkpoints/notes.txt"
        mine.write_text("mine")
        self.assert_rejected(
            run("simulate", case.file, "--out", str(out)), "led.checkpoints", "--resume",
            "--restart"
        )
        self.assertEqual(run("simulate", case.file, "--out", str(out), "--restart").returncode, 0)
        self.assertEqual([path.name for path in (out / "led.checkpoints").iterdir()], ["notes.txt"])
        self.assertEqual(content_of(out / "led.h5"), case.content)


class FullDisk(FileTest):
    """A failed write is an error; existing files stay, and the run can be resumed."""

    def files_in(self, folder: Path) -> dict[str, bytes]:
        return {
            path.name: path.read_bytes()
            for path in folder.iterdir()
            if path.is_file() and path.suffix != ".partial"
        }

    def test_a_file_that_may_grow_no_further_loses_nothing(self) -> None:
        case = self.write("small.toml", SMALL_CASE)
        self.assertEqual(self.simulate(case).returncode, 0)
        before, content = self.files_in(self.path / "out"), content_of(self.path / "out/small.h5")
        size = (self.path / "out/small.h5").stat().st_size
        stops = random.Random(SEED)
        for most in [0, 1, 700, 2048, 4096, size - 1, *(stops.randrange(size) for _ in range(12))]:
            with self.subTest(bytes=most):
                done = self.simulate(
                    case, "--set", "time.max_steps=1000", limits={resource.RLIMIT_FSIZE: most}
                )
                self.assert_rejected(done, "cannot be written")
                self.assertEqual(self.files_in(self.path / "out"), before)
                self.assertEqual(
                    self.simulate(
                        case, "--set", "time.max_steps=1000", "--resume", out="out"
                    ).returncode,
                    0,
                )
                again = content_of(self.path / "out/small.h5")
                again["@case_text"] = content["@case_text"]
                self.assertEqual(again, content)
                shutil.rmtree(self.path / "out")
                self.assertEqual(self.simulate(case).returncode, 0)
                before = self.files_in(self.path / "out")

    def test_findings_and_verdicts_are_all_there_or_as_they_were(self) -> None:
        out = self.path / "out"
        self.assertEqual(
            run("check", "bending.forces-sum-to-zero", "--out", str(out)).returncode, 0
        )
        before = self.files_in(out)
        for most in (0, 500, 4000, len(before["run.h5"]) - 1):
            done = run(
                "check", "bending.forces-sum-to-zero", "--out", str(out), "--restart",
                limits={resource.RLIMIT_FSIZE: most}
            )
            self.assert_rejected(done, "cannot be written")
            self.assertEqual(self.files_in(out), before)
            self.assertFalse(list(out.glob("*.partial")))

    def test_level_sets_and_reports_too(self) -> None:
        text = (ROOT / "cases/drape_statue.toml").read_text()
        shutil.copy(ROOT / "cases/statue.obj", self.path)
        case = self.write("draped.toml", text)
        short = (
            "--set", "time.end=0.01", "--set", "object.cells=10", "--cache", str(self.path / "kept")
        )
        self.assert_rejected(
            self.simulate(case, *short, limits={resource.RLIMIT_FSIZE: 1000}), "kept",
            "cannot be written"
        )
        self.assertFalse(list((self.path / "kept").iterdir()))
        out = self.path / "out"
        self.assertIn(self.simulate(self.write("small.toml", SMALL_CASE)).returncode, (0, 1))
        (out / "report.html").write_text("as it was")
        self.assert_rejected(
            run("report", str(out), limits={resource.RLIMIT_FSIZE: 3000}),
            "report could not be made",
        )
        self.assertEqual((out / "report.html").read_text(), "as it was")
        self.assertFalse(list(out.rglob("*.partial")))

    def test_standard_output_that_is_full_is_an_error(self) -> None:
        with open("/dev/full", "wb") as full:
            for command in (["golden", "springs", "--count", "9"], ["list"], ["list", "--json"]):
                self.assert_rejected(
                    run(*command, stdout=full.fileno()), "standard output cannot be written"
                )

    def test_a_disk_that_is_really_full(self) -> None:
        if os.geteuid() != 0:
            self.skip_and_say("only root mounts a small file system")
        disk = self.path / "disk"
        disk.mkdir()
        mounted = subprocess.run(
            ["mount", "-t", "tmpfs", "-o", "size=96k", "tmpfs", str(disk)], capture_output=True,
            text=True
        )
        if mounted.returncode != 0:
            self.skip_and_say(
                f"a small file system cannot be mounted here: {mounted.stderr.strip()}"
            )
        try:
            (disk / "small.h5").write_text("as it was")
            done = self.simulate(self.write("small.toml", SMALL_CASE), out="disk")
            self.assert_rejected(done, "cannot be written")
            self.assertEqual((disk / "small.h5").read_text(), "as it was")
            full = run("check", "bending", "--out", str(disk))
            self.assertIn(full.returncode, (0, 2))
        finally:
            subprocess.run(["umount", str(disk)], check=True)


class Rights(FileTest):
    """Folders that may not be written, and output paths that are something else."""

    def as_nobody(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        return run(*arguments, user=NOBODY if os.geteuid() == 0 else None)

    def test_a_folder_without_rights_is_named(self) -> None:
        case, out = self.write("small.toml", SMALL_CASE), self.path / "out"
        out.mkdir()
        (out / "small.h5").write_text("as it was")
        out.chmod(0o555)
        probe = subprocess.run(
            ["/bin/sh", "-c", f"test -x '{PROGRAM}' && test -r '{case}'"], check=False,
            **({"user": NOBODY, "group": NOBODY, "extra_groups": []} if os.geteuid() == 0 else {})
        )
        if probe.returncode != 0:
            self.skip_and_say("an unprivileged user cannot reach the program here")
        self.assert_rejected(self.as_nobody("simulate", case, "--out", str(out)), str(out))
        self.assert_rejected(
            self.as_nobody("simulate", case, "--out", str(out / "new")), "new",
            "cannot make this folder"
        )
        self.assert_rejected(
            self.as_nobody("check", "bending.forces-sum-to-zero", "--out", str(out)), str(out)
        )
        self.assert_rejected(self.as_nobody("report", str(out)), "report")
        self.assertEqual([path.name for path in out.iterdir()], ["small.h5"])
        self.assertEqual((out / "small.h5").read_text(), "as it was")
        out.chmod(0o755)

    def test_an_input_without_rights_is_named(self) -> None:
        if os.geteuid() != 0:
            self.skip_and_say("only root runs as another user")
        case = self.write("secret.toml", SMALL_CASE)
        Path(case).chmod(0o600)
        self.assert_rejected(
            self.as_nobody("simulate", case, "--out", "/tmp/never"), "secret.toml",
            "Permission denied"
        )

    def test_an_output_path_that_is_a_file_or_a_folder(self) -> None:
        case, taken = self.write("small.toml", SMALL_CASE), self.write("taken", "mine")
        self.assert_rejected(
            run("simulate", case, "--out", taken), "taken", "cannot make this folder"
        )
        (self.path / "out/small.h5").mkdir(parents=True)
        self.assert_rejected(self.simulate(case), "small.h5", "what is there is no file")
        (self.path / "out/small.h5").rmdir()
        (self.path / "out/small.checkpoints").write_text("mine")
        self.assert_rejected(self.simulate(case), "small.checkpoints")
        self.assertEqual((self.path / "out/small.checkpoints").read_text(), "mine")
        self.assertEqual(Path(taken).read_text(), "mine")
        (self.path / "out2/run.h5").mkdir(parents=True)
        self.assert_rejected(
            run("check", "bending.forces-sum-to-zero", "--out", str(self.path / "out2")), "run.h5"
        )


def main() -> None:
    global KILLS
    arguments = sys.argv[:1]
    rest = iter(sys.argv[1:])
    for argument in rest:
        if argument == "--kills":
            KILLS = int(next(rest))
        else:
            arguments.append(argument)
    unittest.main(argv=arguments)


if __name__ == "__main__":
    main()
