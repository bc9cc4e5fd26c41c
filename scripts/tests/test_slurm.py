#!/usr/bin/python3
"""Tests of campaigns on a real Slurm, which scripts/slurm-here starts on this machine; skipped
where it is not installed.

scripts/tests/test_slurm.py [SlurmTest.test_...]
"""

import contextlib
import json
import os
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "build" / "foldproof"
HERE = ROOT / "scripts" / "slurm-here"

GRID = """case = "hinge"
[set]
"time.end" = {end}
"time.step" = 1e-4
[grid]
"bending.stiffness" = {{ from = 1e-3, to = 2e-3, count = {count} }}
"""


def is_installed() -> bool:
    return os.geteuid() == 0 and all(map(shutil.which, ("slurmctld", "slurmd", "munged", "sbatch")))


@unittest.skipUnless(is_installed(), "Slurm is not installed, or this is not root")
class SlurmTest(unittest.TestCase):
    """What must hold: one result a job, no torn file, the bits of a local run, nothing done twice
    but what was cut off."""

    def setUp(self) -> None:
        self.path = Path(tempfile.mkdtemp(prefix="foldproof-slurm-"))
        self.slurm = self.path / "slurm"
        self.environment = {**os.environ, "SLURM_CONF": str(self.slurm / "slurm.conf")}
        subprocess.run([HERE, "up", self.slurm, "3"], check=True)

    def tearDown(self) -> None:
        subprocess.run([HERE, "down", self.slurm], check=True)
        shutil.rmtree(self.path, ignore_errors=True)

    def write(self, count: int, end: float, name: str = "grid") -> str:
        path = self.path / f"{name}.campaign.toml"
        path.write_text(GRID.format(count=count, end=end))
        return str(path)

    def start(self, file: str, *arguments: str) -> subprocess.Popen:
        return subprocess.Popen(
            [
                PROGRAM,
                "campaign",
                "run",
                file,
                "--out",
                self.path / "out",
                "--on",
                "slurm",
                *arguments,
            ],
            cwd=ROOT,
            env=self.environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
        )

    def finish(self, running: subprocess.Popen) -> None:
        said = running.communicate(timeout=900)[1]
        self.assertEqual(running.returncode, 0, said)

    def lines(self) -> list[dict]:
        whole = []
        for path in (self.path / "out/store/batches").glob("*/shards/**/*.jsonl"):
            text = path.read_text()
            self.assertTrue(not text or text.endswith("\n") or "n" in path.name, path)
            whole += [
                json.loads(line) for line in text.splitlines(keepends=True) if line.endswith("\n")
            ]
        return whole

    def results(self) -> dict[str, dict]:
        lines = [line for line in self.lines() if "result" in line]
        contents = {line["result"]: line["content"] for line in lines}
        self.assertEqual(len(lines), len(contents), "a job has two results")
        return contents

    def wait_for_results(self, count: int) -> None:
        for _ in range(6000):
            if sum("result" in line for line in self.lines()) >= count:
                return
            time.sleep(0.05)
        self.fail(f"there are no {count} results after five minutes")

    def assert_same_as_local(self, file: str, count: int) -> None:
        found = self.results()
        self.assertEqual(len(found), count)
        status = json.loads(
            subprocess.run(
                [PROGRAM, "campaign", "status", file, "--out", self.path / "out", "--json"],
                cwd=ROOT,
                env=self.environment,
                capture_output=True,
                text=True,
                check=True,
            ).stdout
        )
        self.assertEqual(
            (status["done"], status["crashed"], status["repeated"], status["conflicts"]),
            (count, 0, 0, 0),
        )
        subprocess.run(
            [PROGRAM, "campaign", "run", file, "--out", self.path / "local"],
            cwd=ROOT,
            check=True,
            capture_output=True,
        )
        local = [
            json.loads(line)
            for path in (self.path / "local").glob("store/batches/*/shards/**/*.jsonl")
            for line in path.read_text().splitlines()
        ]
        self.assertEqual(
            {line["result"]: line["content"] for line in local if "result" in line}, found
        )

    def pid(self, name: str) -> int:
        return int((self.slurm / f"{name}.pid").read_text())

    def test_twenty_runs_give_the_same_table_here_and_on_slurm(self) -> None:
        for out, engine in (("here", "local"), ("there", "slurm")):
            for command in (["run", "first_grid", "--on", engine], ["table", "first_grid"]):
                subprocess.run(
                    [PROGRAM, "campaign", *command, "--out", self.path / out],
                    cwd=ROOT,
                    env=self.environment,
                    check=True,
                    capture_output=True,
                )
        tables = [
            (self.path / out / "campaigns/first_grid/table.csv").read_bytes()
            for out in ("here", "there")
        ]
        self.assertEqual(tables[0].count(b"\n"), 21)
        self.assertEqual(*tables)

    def test_a_thousand_jobs(self) -> None:
        file = self.write(1000, 0.05)
        self.finish(self.start(file, "--slice", "50"))
        self.assert_same_as_local(file, 1000)

    def test_a_killed_slurmd_costs_nothing(self) -> None:
        file = self.write(60, 1)
        running = self.start(file, "--slice", "10")
        self.wait_for_results(5)
        os.kill(self.pid("slurmd.n1"), signal.SIGKILL)
        time.sleep(2)
        subprocess.run([HERE, "node", self.slurm, "1"], check=True)
        self.finish(running)
        self.assert_same_as_local(file, 60)

    def processes_of_node(self, name: str) -> list[int]:
        """All that Slurm started on a virtual node: the jobs' processes, and what watches them."""
        found, above = [], set()
        for path in Path("/proc").glob("[0-9]*/environ"):
            try:
                words = path.read_bytes().split(b"\0")
                parent = int((path.parent / "stat").read_text().rpartition(")")[2].split()[1])
            except OSError:
                continue
            conf = f"SLURM_CONF={self.slurm}/slurm.conf".encode()
            if f"SLURMD_NODENAME={name}".encode() in words and conf in words:
                found.append(int(path.parent.name))
                above.add(parent)
        return [pid for pid in above if pid > 1 and pid not in found] + found

    def test_a_node_that_dies_whole_and_stays_dead_costs_nothing(self) -> None:
        file = self.write(60, 1)
        running = self.start(file, "--slice", "10")
        self.wait_for_results(5)
        victims = self.processes_of_node("n1")
        self.assertGreaterEqual(len(victims), 2, "n1 runs nothing")
        for pid in [self.pid("slurmd.n1"), *victims]:
            os.kill(pid, signal.SIGKILL)
        self.finish(running)
        self.assert_same_as_local(file, 60)

    def test_a_restarted_controller_costs_nothing(self) -> None:
        file = self.write(60, 1)
        running = self.start(file, "--slice", "10")
        self.wait_for_results(5)
        os.kill(self.pid("slurmctld"), signal.SIGTERM)
        time.sleep(3)
        subprocess.run([HERE, "controller", self.slurm], check=True)
        self.finish(running)
        self.assert_same_as_local(file, 60)

    def workers(self) -> list[int]:
        """Processes of this test's batches that run jobs: children of a `campaign work`."""
        found = []
        for path in Path("/proc").glob("[0-9]*/cmdline"):
            try:
                words = path.read_bytes().split(b"\0")
                parent = int((path.parent / "stat").read_text().rpartition(")")[2].split()[1])
                above = Path(f"/proc/{parent}/cmdline").read_bytes().split(b"\0")
            except (OSError, IndexError):
                continue
            if b"work" in words and words == above and str(self.path).encode() in b" ".join(words):
                found.append(int(path.parent.name))
        return found

    def test_a_job_that_is_killed_as_if_out_of_memory_runs_again(self) -> None:
        file = self.write(30, 2)
        running = self.start(file, "--slice", "10")
        self.wait_for_results(2)
        victims = self.workers()
        self.assertTrue(victims)
        os.kill(victims[0], signal.SIGKILL)
        self.finish(running)
        self.assert_same_as_local(file, 30)

    def test_a_slice_that_stands_still_is_started_again(self) -> None:
        file = self.write(24, 2)
        running = self.start(file, "--slice", "8")
        self.wait_for_results(2)
        worker = self.workers()[0]
        above = int(Path(f"/proc/{worker}/stat").read_text().rpartition(")")[2].split()[1])
        os.kill(above, signal.SIGSTOP)  # Slurm still says that it runs
        self.finish(running)
        self.assert_same_as_local(file, 24)

    def test_a_disk_that_was_full_for_a_while_costs_nothing(self) -> None:
        file, out = self.write(60, 1), self.path / "out"
        out.mkdir()
        mount = ["mount", "-t", "tmpfs", "-o", "size=4m", "tmpfs", str(out)]
        if subprocess.run(mount, capture_output=True, check=False).returncode != 0:
            self.skipTest("no small disk can be mounted here")
        self.addCleanup(subprocess.run, ["umount", "--lazy", out], check=True)
        running = self.start(file, "--slice", "10")
        self.wait_for_results(5)
        ballast = out / "ballast"
        with contextlib.suppress(OSError), ballast.open("wb", buffering=0) as full:
            while full.write(bytes(256)):
                pass
        said = running.communicate(timeout=900)[1]
        self.assertEqual(running.returncode, 2, said)
        self.assertIn("disk is full", said)
        self.assertLess(len(self.results()), 60)
        ballast.unlink()
        self.finish(self.start(file, "--slice", "10"))
        self.assert_same_as_local(file, 60)

    def test_two_campaigns_at_once_on_one_store(self) -> None:
        one, two = self.write(30, 1, "one"), self.write(59, 1, "two")
        running = [self.start(file, "--slice", "5") for file in (one, two)]
        for process in running:
            self.finish(process)
        self.assert_same_as_local(two, len(self.results()))

    def test_cancelled_and_interrupted_campaigns_go_on(self) -> None:
        file = self.write(60, 2)
        running = self.start(file, "--slice", "10")
        self.wait_for_results(3)
        running.send_signal(signal.SIGINT)
        self.assertIn("its batch goes on in slurm", running.communicate()[1])
        subprocess.run(
            [PROGRAM, "campaign", "cancel", file, "--out", self.path / "out"],
            cwd=ROOT,
            env=self.environment,
            check=True,
            capture_output=True,
        )
        time.sleep(3)
        self.assertEqual(self.workers(), [])
        self.finish(self.start(file, "--slice", "10"))
        self.assert_same_as_local(file, 60)


if __name__ == "__main__":
    unittest.main()
