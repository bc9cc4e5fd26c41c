#!/usr/bin/python3
"""Tests that nothing is lost and nothing trusted: kills at any moment, full disks, missing rights, damaged files,
input without end, names that lead elsewhere.

Usage: scripts/test_durability.py [--kills N] [options of unittest]   (default: 10 kills)
"""

import json
import os
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import NamedTuple

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "build" / "foldproof"
KILLS = 10
SEED = 20030726
NOBODY = 65534
CLOCK = 300  # s: what takes longer hangs

LED_CASE = """
[cloth]
shape = "sheet"
pattern = "jittered"
jitter = 0.2
width = 0.3
height = 0.3
columns = 9
rows = 9
density = 0.2
[gravity]
[stretch]
stiffness = 20.0
damping = 0.03
[bending]
stiffness = 2e-5
damping = 1e-6
[[hold]]
particles = [0, 1]
amplitude = [0.02, 0.01, 0.03]
frequency = 3.1
from = 0.0505
until = 0.131
[[hold]]
top = 0.05
[time]
end = 0.4
frames_per_second = 60
step = 0.001
integrator = "BDF2"
[solver]
tolerance = 1e-8
[expect.takes_steps]
at_least = 3
why = "a trial"
[expect.crosses_itself]
at_most = 0
why = "a trial"
"""

SMALL_CASE = """
title = "Small <script>alert(1)</script> & 'one'"
[cloth]
shape = "sheet"
pattern = "one_diagonal"
width = 0.4
height = 0.4
columns = 10
rows = 10
density = 0.2
move = [-0.2, -0.2, 0.23]
[stretch]
stiffness = 20.0
damping = 0.03
[[object]]
shape = "sphere"
radius = 0.25
name = "<b>\\u0001ball\\" onload='x'"
[[sticky]]
surface = { of = "cloth", triangles = [0, 1] }
particles = { particles = [60, 61, 62] }
stiffness = 10
forecast_time = 0.01
near = 1.0
far = 2.0
[time]
end = 0.02
frames_per_second = 200
step = 0.001
"""

TRIANGLES = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n"


def run(*arguments: str, limits: dict[int, int] | None = None, user: int | None = None,
        stdout: int = subprocess.PIPE) -> subprocess.CompletedProcess[str]:
    """Runs the program under limits (of `resource`), or as another user; one that hangs raises TimeoutExpired."""
    def set_limits() -> None:
        for what, most in (limits or {}).items():
            resource.setrlimit(what, (most, most))
    as_user = {} if user is None else {"user": user, "group": user, "extra_groups": []}
    return subprocess.run([str(PROGRAM), *arguments], stdout=stdout, stderr=subprocess.PIPE, text=True, errors="replace",
                          timeout=CLOCK, check=False, preexec_fn=set_limits if limits else None, **as_user)


def content_of(path: Path) -> dict[str, bytes]:
    """All datasets of an HDF5 file but clock times, by name, with shape and type."""
    found: dict[str, bytes] = {}

    def see(name: str, item: h5py.Group | h5py.Dataset) -> None:
        if isinstance(item, h5py.Dataset) and name != "diagnostics/seconds":
            found[name] = repr((item.shape, item.dtype)).encode() + item[()].tobytes()
    with h5py.File(path, "r") as file:
        file.visititems(see)
        for key in ("case_name", "case_text", "integrator", "stopped"):
            found[f"@{key}"] = str(file.attrs[key]).encode()
    return found


class DurabilityTest(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = tempfile.TemporaryDirectory(prefix="foldproof durability ")
        self.path = Path(self.folder.name)
        self.path.chmod(0o755)  # for the tests as another user

    def tearDown(self) -> None:
        self.folder.cleanup()

    def write(self, name: str, text: str) -> str:
        (self.path / name).parent.mkdir(parents=True, exist_ok=True)
        (self.path / name).write_text(text)
        return str(self.path / name)

    def simulate(self, case: str, *arguments: str, out: str = "out", **how: object) -> subprocess.CompletedProcess[str]:
        return run("simulate", case, *arguments, "--out", str(self.path / out), **how)

    def refused(self, done: subprocess.CompletedProcess[str], *mentions: str) -> None:
        """The exit code is 2, and the last line of standard error is an error that mentions this."""
        self.assertEqual(done.returncode, 2, done.stderr)
        last = done.stderr.strip().splitlines()[-1] if done.stderr.strip() else ""
        self.assertNotIn("Traceback", done.stderr)
        for part in mentions:
            self.assertIn(part, last)

    def skip_and_say(self, why: str) -> None:
        print(f"\nskipped: {self.id()}: {why}", flush=True)
        self.skipTest(why)


class KilledCase(NamedTuple):
    file: str
    options: tuple[str, ...]
    content: dict[str, bytes]  # of the run that nothing interrupts
    xdmf: str
    told: dict
    seconds: float  # how long it takes


class Kills(DurabilityTest):
    """kill -9 at random moments, some runs twice; every run ends with the bits of the uninterrupted one."""

    def cases(self) -> list[tuple[str, tuple[str, ...]]]:
        for name in ("hard/sticky_layers.toml", "hard/two_layers.obj", "grab.toml", "hard/reef_fold.toml"):
            shutil.copy(ROOT / "cases" / name, self.path)
        return [(self.write("led.toml", LED_CASE), ()),
                (str(self.path / "sticky_layers.toml"), ("--set", "time.end=0.1", "--set", "time.frames_per_second=200")),
                (str(self.path / "grab.toml"), ("--set", "time.end=0.34", "--set", "expect.is_lifted.at_least=0",
                                               "--set", "cloth.columns=8", "--set", "cloth.rows=8")),
                (str(self.path / "reef_fold.toml"), ("--set", "time.end=0.02", "--set", "time.frames_per_second=900"))]

    def uninterrupted(self, file: str, options: tuple[str, ...]) -> KilledCase:
        name = Path(file).stem
        start = time.monotonic()
        done = self.simulate(file, *options, "--json", out=f"whole/{name}")
        seconds = time.monotonic() - start
        self.assertIn(done.returncode, (0, 1), done.stderr)
        out = self.path / "whole" / name
        self.assertEqual(sorted(path.name for path in out.iterdir()), [f"{name}.h5", f"{name}.xdmf"])
        return KilledCase(file, options, content_of(out / f"{name}.h5"), (out / f"{name}.xdmf").read_text(),
                          self.told_by(done.stdout), seconds)

    def told_by(self, printed: str) -> dict:
        """What a run says of itself but its clock time and folder."""
        return {key: value for key, value in json.loads(printed).items() if key not in ("seconds", "file")}

    def killed_run(self, case: KilledCase, out: Path, wait: float, *more: str) -> bool:
        """Starts the run, kills it after `wait` seconds; whether it was still running."""
        command = [str(PROGRAM), "simulate", case.file, *case.options, "--out", str(out), *more]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            process.wait(wait)
            return False
        except subprocess.TimeoutExpired:
            process.kill()
            self.assertEqual(process.wait(), -9)
            return True

    def require_whole_files(self, case: KilledCase, out: Path) -> int:
        """Every file that does not say it is partial is whole. Returns the number of checkpoints."""
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
                    file.visititems(lambda _, item: item[()] if isinstance(item, h5py.Dataset) else None)
        return checkpoints

    def finish(self, case: KilledCase, out: Path) -> str:
        """Resumes to the end and compares with the uninterrupted run. Returns what was said of the resumption."""
        name = Path(case.file).stem
        done = run("simulate", case.file, *case.options, "--out", str(out), "--resume", "--json")
        self.assertIn(done.returncode, (0, 1), done.stderr)
        self.assertEqual(self.told_by(done.stdout), case.told)
        self.assertEqual(sorted(path.name for path in out.iterdir()), [f"{name}.h5", f"{name}.xdmf"])
        self.assertEqual(content_of(out / f"{name}.h5"), case.content)
        self.assertEqual((out / f"{name}.xdmf").read_text(), case.xdmf)
        return done.stderr

    def test_a_run_that_is_killed_at_any_moment_resumes_to_the_same_bits(self) -> None:
        cases = [self.uninterrupted(*case) for case in self.cases()]
        moments = random.Random(SEED)
        hits = again = resumed = damaged = 0
        for number in range(KILLS):
            case, out = cases[number % len(cases)], self.path / f"trial{number}"
            with self.subTest(kill=number, case=case.file):
                hits += self.killed_run(case, out, moments.uniform(0, 1.1 * case.seconds))
                self.require_whole_files(case, out)
                if moments.random() < 0.5:
                    again += self.killed_run(case, out, moments.uniform(0, case.seconds), "--resume")
                    self.require_whole_files(case, out)
                said = self.finish(case, out)
                resumed += "resumed from frame" in said
                damaged += "damaged" in said
            shutil.rmtree(out, ignore_errors=True)
        print(f"\n{KILLS} trials (seed {SEED}): {hits} runs killed, {again} of them twice or when resumed, "
              f"{resumed} resumed from a checkpoint, {damaged} of which found a damaged one", flush=True)
        self.assertEqual(damaged, 0)
        self.assertGreater(resumed, KILLS // 8)

    def stopped_short(self) -> tuple[KilledCase, Path]:
        """A run that is killed when it has written a dozen checkpoints."""
        case, out = self.uninterrupted(*self.cases()[0]), self.path / "out"
        process = subprocess.Popen([str(PROGRAM), "simulate", case.file, "--out", str(out)],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while process.poll() is None and not (out / "led.checkpoints/000012.h5").exists():
            time.sleep(0.002)
        process.kill()
        process.wait()
        self.assertTrue((out / "led.checkpoints/000012.h5").exists())
        return case, out

    def test_a_damaged_checkpoint_is_named_and_the_one_before_is_taken(self) -> None:
        case, out = self.stopped_short()
        last = sorted((out / "led.checkpoints").glob("*.h5"))[-1]
        with h5py.File(last, "r+") as file:
            file["past/0/numbers"][5] += 1e-9
        said = self.finish(case, out)
        self.assertIn(f"{last}: this checkpoint is damaged and left out", said)
        self.assertIn(f"resumed from frame {int(last.stem) - 1},", said)

    def test_a_checkpoint_of_something_else_is_refused_and_stays(self) -> None:
        case, out = self.stopped_short()
        before = {path.name: path.read_bytes() for path in (out / "led.checkpoints").glob("*.h5")}
        self.refused(run("simulate", case.file, "--set", "gravity.acceleration=[0,-9,0]", "--out", str(out), "--resume"),
                     "another case text", "--resume")
        with h5py.File(out / "led.checkpoints/000000.h5") as file:
            self.assertIn("code ", file.attrs["program"])
        self.assertEqual(before, {path.name: path.read_bytes() for path in (out / "led.checkpoints").glob("*.h5")})
        self.finish(case, out)

    def test_another_mesh_is_told_from_the_one_that_was_read(self) -> None:
        mesh = self.write("any.obj", TRIANGLES)
        case = self.write("own.toml", '[cloth]\nmesh = "any.obj"\ndensity = 0.1\n[gravity]\n[time]\nend = 9\nstep = 1e-4\n')
        process = subprocess.Popen([str(PROGRAM), "simulate", case, "--out", str(self.path / "out")],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while process.poll() is None and not (self.path / "out/own.checkpoints/000002.h5").exists():
            time.sleep(0.002)
        process.kill()
        process.wait()
        Path(mesh).write_text(TRIANGLES.replace("v 1 1 0", "v 1 1 0.01"))
        self.refused(self.simulate(case, "--resume"), "other meshes")

    def test_without_resume_checkpoints_of_an_earlier_run_are_removed_and_other_files_stay(self) -> None:
        case, out = self.stopped_short()
        mine = out / "led.checkpoints/notes.txt"
        mine.write_text("mine")
        self.assertEqual(run("simulate", case.file, "--out", str(out)).returncode, 0)
        self.assertEqual([path.name for path in (out / "led.checkpoints").iterdir()], ["notes.txt"])
        self.assertEqual(content_of(out / "led.h5"), case.content)


class FullDisk(DurabilityTest):
    """What cannot be written is an error; what was there before stays, and a run can go on later."""

    def files_in(self, folder: Path) -> dict[str, bytes]:
        return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file() and path.suffix != ".partial"}

    def test_a_file_that_may_grow_no_further_loses_nothing(self) -> None:
        case = self.write("small.toml", SMALL_CASE)
        self.assertEqual(self.simulate(case).returncode, 0)
        before, content = self.files_in(self.path / "out"), content_of(self.path / "out/small.h5")
        size = (self.path / "out/small.h5").stat().st_size
        stops = random.Random(SEED)
        for most in [0, 1, 700, 2048, 4096, size - 1, *(stops.randrange(size) for _ in range(12))]:
            with self.subTest(bytes=most):
                done = self.simulate(case, "--set", "time.max_steps=1000", limits={resource.RLIMIT_FSIZE: most})
                self.refused(done, "cannot be written")
                self.assertEqual(self.files_in(self.path / "out"), before)
                self.assertEqual(self.simulate(case, "--set", "time.max_steps=1000", "--resume", out="out").returncode, 0)
                again = content_of(self.path / "out/small.h5")
                again["@case_text"] = content["@case_text"]
                self.assertEqual(again, content)
                shutil.rmtree(self.path / "out")
                self.assertEqual(self.simulate(case).returncode, 0)
                before = self.files_in(self.path / "out")

    def test_findings_and_verdicts_are_all_there_or_as_they_were(self) -> None:
        out = self.path / "out"
        self.assertEqual(run("check", "bending.forces-sum-to-zero", "--out", str(out)).returncode, 0)
        before = self.files_in(out)
        for most in (0, 500, 4000, len(before["run.h5"]) - 1):
            done = run("check", "bending.forces-sum-to-zero", "--out", str(out), limits={resource.RLIMIT_FSIZE: most})
            self.refused(done, "run.h5", "cannot be written")
            self.assertEqual(self.files_in(out), before)
            self.assertFalse(list(out.glob("*.partial")))

    def test_level_sets_and_reports_too(self) -> None:
        text = (ROOT / "cases/drape_statue.toml").read_text()
        shutil.copy(ROOT / "cases/statue.obj", self.path)
        case = self.write("draped.toml", text)
        short = ("--set", "time.end=0.01", "--set", "object.cells=10", "--cache", str(self.path / "kept"))
        self.refused(self.simulate(case, *short, limits={resource.RLIMIT_FSIZE: 1000}), "kept", "cannot be written")
        self.assertFalse(list((self.path / "kept").iterdir()))
        out = self.path / "out"
        self.assertIn(self.simulate(self.write("small.toml", SMALL_CASE)).returncode, (0, 1))
        (out / "report.html").write_text("as it was")
        self.refused(run("report", str(out), limits={resource.RLIMIT_FSIZE: 3000}), "report could not be made")
        self.assertEqual((out / "report.html").read_text(), "as it was")
        self.assertFalse(list(out.rglob("*.partial")))

    def test_standard_output_that_is_full_is_an_error(self) -> None:
        with open("/dev/full", "wb") as full:
            for command in (["golden", "springs", "--count", "9"], ["list"], ["list", "--json"]):
                self.refused(run(*command, stdout=full.fileno()), "standard output cannot be written")

    def test_a_disk_that_is_really_full(self) -> None:
        if os.geteuid() != 0:
            self.skip_and_say("only root mounts a small file system")
        disk = self.path / "disk"
        disk.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=96k", "tmpfs", str(disk)], capture_output=True, text=True)
        if mounted.returncode != 0:
            self.skip_and_say(f"a small file system cannot be mounted here: {mounted.stderr.strip()}")
        try:
            (disk / "small.h5").write_text("as it was")
            done = self.simulate(self.write("small.toml", SMALL_CASE), out="disk")
            self.refused(done, "cannot be written")
            self.assertEqual((disk / "small.h5").read_text(), "as it was")
            full = run("check", "bending", "--out", str(disk))
            self.assertIn(full.returncode, (0, 2))
        finally:
            subprocess.run(["umount", str(disk)], check=True)


class Rights(DurabilityTest):
    """Folders that may not be written, and output paths that are something else."""

    def as_nobody(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        return run(*arguments, user=NOBODY if os.geteuid() == 0 else None)

    def test_a_folder_without_rights_is_named(self) -> None:
        case, out = self.write("small.toml", SMALL_CASE), self.path / "out"
        out.mkdir()
        (out / "small.h5").write_text("as it was")
        out.chmod(0o555)
        probe = subprocess.run(["/bin/sh", "-c", f"test -x '{PROGRAM}' && test -r '{case}'"], check=False,
                               **({"user": NOBODY, "group": NOBODY, "extra_groups": []} if os.geteuid() == 0 else {}))
        if probe.returncode != 0:
            self.skip_and_say("an unprivileged user cannot reach the program here")
        self.refused(self.as_nobody("simulate", case, "--out", str(out)), str(out))
        self.refused(self.as_nobody("simulate", case, "--out", str(out / "new")), "new", "cannot make this folder")
        self.refused(self.as_nobody("check", "bending.forces-sum-to-zero", "--out", str(out)), str(out))
        self.refused(self.as_nobody("report", str(out)), "report")
        self.assertEqual([path.name for path in out.iterdir()], ["small.h5"])
        self.assertEqual((out / "small.h5").read_text(), "as it was")
        out.chmod(0o755)

    def test_an_input_without_rights_is_named(self) -> None:
        if os.geteuid() != 0:
            self.skip_and_say("only root runs as another user")
        case = self.write("secret.toml", SMALL_CASE)
        Path(case).chmod(0o600)
        self.refused(self.as_nobody("simulate", case, "--out", "/tmp/never"), "secret.toml", "Permission denied")

    def test_an_output_path_that_is_a_file_or_a_folder(self) -> None:
        case, taken = self.write("small.toml", SMALL_CASE), self.write("taken", "mine")
        self.refused(run("simulate", case, "--out", taken), "taken", "cannot make this folder")
        (self.path / "out/small.h5").mkdir(parents=True)
        self.refused(self.simulate(case), "small.h5", "what is there is no file")
        (self.path / "out/small.h5").rmdir()
        (self.path / "out/small.checkpoints").write_text("mine")
        self.refused(self.simulate(case), "small.checkpoints")
        self.assertEqual((self.path / "out/small.checkpoints").read_text(), "mine")
        self.assertEqual(Path(taken).read_text(), "mine")
        (self.path / "out2/run.h5").mkdir(parents=True)
        self.refused(run("check", "bending.forces-sum-to-zero", "--out", str(self.path / "out2")), "run.h5")


def damaged(content: bytes, chance: random.Random) -> bytes:
    """The bytes cut off somewhere, or with some flipped, zeroed or turned into the largest number; structures, which lie at
    the start of an HDF5 file, are hit as often as data."""
    if chance.random() < 0.25:
        return content[:chance.randrange(len(content))]
    result = bytearray(content)
    reach = len(content) if chance.random() < 0.5 else min(len(content), 6000)
    for _ in range(chance.choice((1, 1, 2, 5, 20))):
        at = chance.randrange(reach)
        kind = chance.randrange(3)
        if kind == 0:
            result[at] ^= 1 << chance.randrange(8)
        else:
            result[at:at + 8] = (b"\x00" if kind == 1 else b"\xff") * len(result[at:at + 8])
    return bytes(result)


class DamagedFiles(DurabilityTest):
    """HDF5 files with flipped bytes or cut short: an error or an answer, never a crash or a hang."""

    TRIALS = 100

    def judge(self, done: subprocess.CompletedProcess[str], number: int) -> int:
        self.assertIn(done.returncode, (0, 1, 2), f"damage {number}: {done.stderr[-300:]}")
        if done.returncode == 2:
            self.assertTrue(done.stderr.strip())
            self.assertLess(len(done.stderr.strip().splitlines()[-1]), 2000)
        return done.returncode

    def trials(self, source: Path, target: Path, commands: list[list[str]], count: int) -> None:
        chance = random.Random(SEED)
        content, refused, runs = source.read_bytes(), 0, 0
        for number in range(count):
            target.write_bytes(damaged(content, chance))
            for command in commands:
                refused += self.judge(run(*command, limits={resource.RLIMIT_CORE: 0}), number) == 2
                runs += 1
        print(f"\n{source.name}: {count} damages, {runs} commands, {refused} refused, the others answered", flush=True)

    def test_stored_runs(self) -> None:
        self.assertEqual(self.simulate(self.write("small.toml", SMALL_CASE)).returncode, 0)
        hurt = self.path / "hurt.h5"
        project = ["project", str(hurt), "--map", "plain", "--tau", "0.01", "--out", str(self.path / "projected")]
        self.trials(self.path / "out/small.h5", hurt, [["crossings", str(hurt)], project], self.TRIALS)

    def test_runs_and_cases_in_reports(self) -> None:
        self.assertEqual(self.simulate(self.write("small.toml", SMALL_CASE), out="first").returncode, 0)
        self.assertEqual(run("check", "bending.forces-sum-to-zero", "--out", str(self.path / "first")).returncode, 0)
        for name in ("run.h5", "small.h5"):
            out = self.path / f"of {name}"
            out.mkdir()
            self.trials(self.path / "first" / name, out / name, [["report", str(out)]], self.TRIALS // 20)

    def test_level_sets_that_are_kept(self) -> None:
        shutil.copy(ROOT / "cases/statue.obj", self.path)
        case = self.write("draped.toml", (ROOT / "cases/drape_statue.toml").read_text())
        command = ["simulate", case, "--set", "time.end=0.001", "--set", "object.cells=10", "--cache", str(self.path / "kept"),
                   "--out", str(self.path / "out")]
        self.assertIn(run(*command).returncode, (0, 1))
        kept = next((self.path / "kept").iterdir())
        whole = content_of(self.path / "out/draped.h5")
        shutil.copy(kept, self.path / "source.h5")
        self.trials(self.path / "source.h5", kept, [command], self.TRIALS // 5)
        self.assertEqual(content_of(self.path / "out/draped.h5"), whole)

    def test_checkpoints(self) -> None:
        case = self.write("led.toml", LED_CASE)
        process = subprocess.Popen([str(PROGRAM), "simulate", case, "--out", str(self.path / "out")],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while process.poll() is None and not (self.path / "out/led.checkpoints/000020.h5").exists():
            time.sleep(0.002)
        process.kill()
        process.wait()
        shutil.copytree(self.path / "out", self.path / "source")
        chance, content = random.Random(SEED), None
        for number in range(self.TRIALS // 10):
            shutil.rmtree(self.path / "out")
            shutil.copytree(self.path / "source", self.path / "out")
            hurt = self.path / f"out/led.checkpoints/{chance.randrange(21):06}.h5"
            hurt.write_bytes(damaged(hurt.read_bytes(), chance))
            self.assertEqual(self.judge(self.simulate(case, "--resume"), number), 0)
            content = content or content_of(self.path / "out/led.h5")
            self.assertEqual(content_of(self.path / "out/led.h5"), content)


class Limits(DurabilityTest):
    """Input without end is refused soon, in bounded memory, with file and line."""

    MOST = 2 << 30  # bytes of address space

    def soon_refused(self, *arguments: str, mentions: tuple[str, ...]) -> None:
        start = os.times()
        done = run(*arguments, limits={resource.RLIMIT_AS: self.MOST, resource.RLIMIT_CORE: 0})
        end = os.times()
        self.refused(done, *mentions)
        self.assertLess(end.children_user + end.children_system - start.children_user - start.children_system, 20)

    def long_file(self, name: str, line: bytes, lines: int, first: bytes = b"") -> str:
        with open(self.path / name, "wb") as file:
            file.write(first)
            for _ in range(lines // 10000):
                file.write(line * 10000)
        return str(self.path / name)

    def test_a_case_of_100_megabytes(self) -> None:
        case = self.long_file("huge.toml", b"# nothing\n", 10_000_000)
        self.soon_refused("simulate", case, mentions=("huge.toml", "1048576 bytes"))
        case = self.write("wide.toml", "# " + "x" * 70000 + "\n")
        self.soon_refused("simulate", case, mentions=("wide.toml:1", "65536 bytes"))

    def test_a_case_nested_without_end(self) -> None:
        for name, text in (("dots", "a" + ".a" * 30000 + " = 1\n"), ("lists", "a = " + "[" * 60000 + "\n"),
                           ("tables", "a = " + "{b = " * 12000 + "\n"), ("headers", "[a" + ".a" * 30000 + "]\n"),
                           ("quoted", "x = [ \"\"\"\n\"\"\", {" + '",".' * 12000 + "a = 1, b = \"\" } ]\n"),
                           ("digits", "1.1" + " . 1.1" * 9000 + " = 1\n"),
                           ("deepest", "[a" + ".a" * 2000 + "]\nb" + ".b" * 2000 + " = 1\nx\n")):
            with self.subTest(name):
                self.soon_refused("simulate", self.write(f"{name}.toml", text), mentions=(f"{name}.toml",))

    def test_a_mesh_of_ten_million_faces(self) -> None:
        mesh = self.long_file("faces.obj", b"f 1 2 3\n", 10_000_000, b"v 0 0 0\nv 1 0 0\nv 0 1 0\n")
        self.soon_refused("inspect", mesh, mentions=("faces.obj:4000004", "more than 4000000 triangles"))
        self.soon_refused("crossings", mesh, mentions=("faces.obj:4000004",))
        vertices = self.long_file("vertices.obj", b"v 0 0 0\n", 3_000_000)
        self.soon_refused("inspect", vertices, mentions=("vertices.obj:2000001", "more than 2000000 vertices"))
        fan = self.write("fan.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf " + "1 2 3 \\\n" * 1_500_000)
        self.soon_refused("inspect", fan, mentions=("fan.obj", "more than 4000000 triangles"))

    def test_groups_without_end(self) -> None:
        names = " ".join(f"g{k}" for k in range(40))
        self.soon_refused("inspect", self.write("groups.obj", f"g {names}\n{TRIANGLES}"), mentions=("groups.obj:1", "16 names of groups"))

    def test_lines_without_end(self) -> None:
        for name in ("endless.obj", "endless.csv"):
            self.long_file(name, b"1.0 " * 10, 2_500_000, b"\n")
        self.soon_refused("inspect", str(self.path / "endless.obj"), mentions=("endless.obj:2", "65536 bytes"))
        for kind in (("bending",), ("crossings", "--kind", "edge-edge")):
            self.soon_refused("evaluate", *kind, str(self.path / "endless.csv"), mentions=("endless.csv:2", "65536 bytes"))
        self.soon_refused("inspect", self.long_file("big.obj", b"# " + b"x" * 998 + b"\n", 300_000), mentions=("big.obj", "268435456 bytes"))

    def test_what_is_no_file(self) -> None:
        os.mkfifo(self.path / "pipe.obj")
        for name in ("/dev/zero", str(self.path / "pipe.obj"), str(self.path)):
            self.soon_refused("inspect", name, mentions=(name,))
            self.soon_refused("evaluate", "bending", name, mentions=(name,))
            self.soon_refused("simulate", name, mentions=(name,))
            self.soon_refused("simulate", str(ROOT / "cases/any_mesh.toml"), "--set", f"cloth.mesh={name}", mentions=(name,))

    def test_rows_without_end(self) -> None:
        row = b"1,2,3,4,5,6,7,8,9,1,2,3,1,2,3,1,2,3,1,2,3,1,2,3,1,2,3\n"
        table = self.long_file("rows.csv", row, 1_010_000)
        self.soon_refused("evaluate", "bending", table, mentions=("rows.csv:1000001", "1000000 rows"))


class Names(DurabilityTest):
    """Names lead nowhere but where they seem to, and say nothing but themselves."""

    def test_names_of_cases_are_plain(self) -> None:
        for name in ("two words", "caf\u00e9", ".hidden", "-option", "dots..twice", "new\nline", "tab\there", "<b>", "quo'te", "x" * 101):
            with self.subTest(name=name):
                self.refused(self.simulate(self.write(f"{name}.toml", SMALL_CASE)), "a case is named after its file")
        self.assertFalse((self.path / "out").exists() and list((self.path / "out").iterdir()))
        for name in ("a", "x" * 100, "Case_1.2-b"):
            self.assertEqual(self.simulate(self.write(f"{name}.toml", SMALL_CASE)).returncode, 0, name)

    def test_a_stored_name_leads_nowhere(self) -> None:
        self.assertEqual(self.simulate(self.write("small.toml", SMALL_CASE)).returncode, 0)
        stored = self.path / "out/small.h5"
        for name in ("../../escaped", "/tmp/escaped", "", "..", "a/../../b"):
            with h5py.File(stored, "r+") as file:
                file.attrs["case_name"] = name
            done = run("project", str(stored), "--map", "plain", "--tau", "0.01", "--out", str(self.path / "projected"))
            if done.returncode == 2:
                continue
            self.assertEqual({path.parent for path in self.path.rglob("*_projected.h5")}, {self.path / "projected"})
        self.assertFalse(list(self.path.parent.glob("escaped*")))

    def case_with_mesh(self, mesh: str) -> str:
        text = f'[cloth]\nmesh = "{mesh}"\ndensity = 0.1\n[time]\nend = 0.001\n'
        return self.write("case/own.toml", text)

    def test_meshes_lie_beside_their_case_or_below(self) -> None:
        outside = self.write("outside.obj", TRIANGLES)
        self.write("case/beside.obj", TRIANGLES)
        self.write("case/sub/below.obj", TRIANGLES)
        (self.path / "case/inner.obj").symlink_to("sub/below.obj")
        (self.path / "case/outer.obj").symlink_to(outside)
        (self.path / "case/up").symlink_to("..")
        for mesh in ("beside.obj", "sub/below.obj", "inner.obj", "./beside.obj"):
            self.assertEqual(self.simulate(self.case_with_mesh(mesh)).returncode, 0, mesh)
        for mesh in (outside, "../outside.obj", "sub/../beside.obj", "outer.obj", "up/outside.obj", "/etc/passwd", ".."):
            with self.subTest(mesh=mesh):
                self.refused(self.simulate(self.case_with_mesh(mesh)), "own.toml:2", "case file's folder", "--set")
        self.refused(self.simulate(self.case_with_mesh("none.obj")), "there is no mesh file")
        self.assertEqual(self.simulate(self.case_with_mesh("beside.obj"), "--set", f"cloth.mesh={outside}").returncode, 0)

    def test_animations_too(self) -> None:
        shutil.copy(ROOT / "cases/statue.obj", self.path / "outside.obj")
        for name in ("frames", "case/linked"):
            (self.path / name).mkdir(parents=True)
        (self.path / "case/linked/0.obj").symlink_to(self.path / "outside.obj")
        for frames in ("../frames", str(self.path / "frames"), "linked"):
            text = SMALL_CASE + f'[[object]]\nframes = "{frames}"\n'
            self.refused(self.simulate(self.write("case/own.toml", text)), "case file's folder")

    def test_what_is_printed_and_written_is_valid_whatever_the_names(self) -> None:
        out = os.fsencode(self.path) + b"/out \xff\xfe<&\"'>\x01"
        command = [str(PROGRAM).encode(), b"check", b"bending.forces-sum-to-zero", b"--json", b"--out", out]
        done = subprocess.run(command, capture_output=True, timeout=CLOCK, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        printed = done.stdout.decode("utf-8")  # strictly
        self.assertIn("\ufffd", json.loads(printed)["program"]["command"])
        with open(out + b"/verdicts.json", "rb") as file:
            self.assertEqual(json.loads(file.read().decode("utf-8")), json.loads(printed))
        ElementTree.parse(out + b"/junit.xml")
        case = self.write("small.toml", SMALL_CASE)
        scene = out + b"/scene"
        command = [str(PROGRAM).encode(), b"simulate", os.fsencode(case), b"--json", b"--out", scene]
        done = subprocess.run(command, capture_output=True, timeout=CLOCK, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        json.loads(done.stdout.decode("utf-8"))
        ElementTree.parse(scene + b"/small.xdmf")
        self.page_of(out)
        page = self.page_of(scene)
        self.assertTrue("Small &lt;script&gt;alert(1)&lt;/script&gt; &amp; &#39;one&#39;" in page, "the title is not on the page")
        self.assertTrue("<script>alert" not in page and "<b>\ufffdball" not in page, "a name of the case is code on the page")

    def page_of(self, out: bytes) -> str:
        """The page made of a folder, which holds no control character."""
        done = subprocess.run([str(PROGRAM).encode(), b"report", out], capture_output=True, timeout=CLOCK, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        page = Path(os.fsdecode(out + b"/report.html")).read_bytes().decode("utf-8")
        self.assertIsNone(re.search("[\x00-\x08\x0b\x0c\x0e-\x1f]", page))
        return page


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
