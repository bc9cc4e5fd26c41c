#!/usr/bin/python3
"""Tests of campaigns on a real Slurm, which scripts/slurm-here starts on this machine; skipped
where it is not installed.

scripts/tests/test_slurm.py [SlurmTest.test_...]
"""
from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from collections.abc import Callable
from pathlib import Path

sys.dont_write_bytecode = True

from campaign_case import (  # noqa: E402
    CampaignCase, SlurmCluster, can_start_slurm, lines_in, parent_of, processes_with)

GRID = """case = "hinge"
[set]
"time.end" = {end}
"time.step" = 1e-4
[grid]
"bending.stiffness" = {{ from = 1e-3, to = 2e-3, count = {count} }}
"""


@unittest.skipUnless(can_start_slurm(), "Slurm is not installed, or this is not root")
class SlurmTest(CampaignCase):
    """What must hold: one result a job, no torn line, the bits of a local run, nothing done twice
    but what was cut off."""

    def setUp(self) -> None:
        super().setUp()
        folder = tempfile.TemporaryDirectory(prefix="foldproof-slurm-")  # Slurm bears no blank
        self.addCleanup(folder.cleanup)
        self.cluster = SlurmCluster(Path(folder.name), self.environment)
        self.addCleanup(self.cluster.here, "down")

    def grid(self, count: int, end: float, name: str = "grid") -> str:
        return self.campaign_file(GRID.format(count=count, end=end), name)

    def start_slices(self, file: str, size: int) -> subprocess.Popen[str]:
        return self.start("run", file, "--on", "slurm", "--slice", size)

    def finish(self, running: subprocess.Popen[str]) -> None:
        said = running.communicate(timeout=900)[1]
        self.assertEqual(running.returncode, 0, said)

    def assert_same_as_local(self, file: str, count: int) -> None:
        found, status = self.results(), self.status(file)
        self.assertEqual(len(found), count)
        self.assertEqual([status[name] for name in ("done", "crashed", "repeated", "conflicts")],
                         [count, 0, 0, 0])
        self.campaign("run", file, "--out", self.path / "local")
        local = lines_in(self.path / "local")
        self.assertEqual(
            {line["result"]: line["content"] for line in local if "result" in line}, found)

    def workers(self) -> list[int]:
        """Processes of this test's batches that run jobs: children of a `campaign work`."""
        found = processes_with(str(self.path))
        return [process for process in found if parent_of(process) in found]

    def assert_costs_nothing(self, disturb: Callable[[], None], count: int, end: float) -> None:
        """Slices of ten runs, and what disturbs them when some are done."""
        file = self.grid(count, end)
        running = self.start_slices(file, 10)
        self.wait_for_results(5)
        disturb()
        self.finish(running)
        self.assert_same_as_local(file, count)

    def test_twenty_runs_give_the_same_table_here_and_on_slurm(self) -> None:
        tables = []
        for engine in ("local", "slurm"):
            out = self.path / engine
            self.campaign("run", "first_grid", "--on", engine, "--out", out)
            self.campaign("table", "first_grid", "--out", out)
            tables.append((out / "campaigns/first_grid/table.csv").read_bytes())
        self.assertEqual(tables[0].count(b"\n"), 21)
        self.assertEqual(*tables)

    def test_a_thousand_jobs(self) -> None:
        file = self.grid(1000, 0.05)
        self.finish(self.start_slices(file, 50))
        self.assert_same_as_local(file, 1000)

    def test_a_killed_slurmd_costs_nothing(self) -> None:
        def disturb() -> None:
            self.cluster.kill("slurmd.n1", signal.SIGKILL)
            time.sleep(2)
            self.cluster.here("node", "1")

        self.assert_costs_nothing(disturb, 60, 1)

    def test_a_restarted_controller_costs_nothing(self) -> None:
        def disturb() -> None:
            self.cluster.kill("slurmctld", signal.SIGTERM)
            time.sleep(3)
            self.cluster.here("controller")

        self.assert_costs_nothing(disturb, 60, 1)

    def processes_of_node(self, name: str) -> list[int]:
        """All that Slurm started on a virtual node: the jobs' processes, and what watches them."""
        found = []
        for path in Path("/proc").glob("[0-9]*/environ"):
            with contextlib.suppress(OSError):
                words = path.read_bytes().split(b"\0")
                conf = f"SLURM_CONF={self.cluster.folder}/slurm.conf".encode()
                if f"SLURMD_NODENAME={name}".encode() in words and conf in words:
                    found.append(int(path.parent.name))
        above = {parent_of(process) for process in found} - {0, 1, *found}
        return [*above, *found]

    def test_a_node_that_dies_whole_and_stays_dead_costs_nothing(self) -> None:
        def disturb() -> None:
            victims = self.processes_of_node("n1")
            self.assertGreaterEqual(len(victims), 2, "n1 runs nothing")
            self.cluster.kill("slurmd.n1", signal.SIGKILL)
            for process in victims:
                os.kill(process, signal.SIGKILL)

        self.assert_costs_nothing(disturb, 60, 1)

    def test_a_job_that_is_killed_as_if_out_of_memory_runs_again(self) -> None:
        self.assert_costs_nothing(lambda: os.kill(self.workers()[0], signal.SIGKILL), 30, 2)

    def test_a_dead_slice_that_slurm_takes_for_alive_is_started_again(self) -> None:
        def disturb() -> None:
            work = parent_of(self.workers()[0])
            watcher = parent_of(work)  # it would report the death
            os.kill(watcher, signal.SIGSTOP)
            self.addCleanup(os.kill, watcher, signal.SIGKILL)
            os.kill(work, signal.SIGKILL)

        self.assert_costs_nothing(disturb, 30, 2)

    def test_a_disk_that_was_full_for_a_while_costs_nothing(self) -> None:
        file = self.grid(60, 1)
        self.out.mkdir()
        mount = ["mount", "-t", "tmpfs", "-o", "size=4m", "tmpfs", str(self.out)]
        if subprocess.run(mount, capture_output=True, check=False).returncode != 0:
            self.skipTest("no small disk can be mounted here")
        self.addCleanup(subprocess.run, ["umount", "--lazy", self.out], check=True)
        running = self.start_slices(file, 10)
        self.wait_for_results(5)
        ballast = self.out / "ballast"
        with contextlib.suppress(OSError), ballast.open("wb", buffering=0) as full:
            while full.write(bytes(256)):
                pass
        said = running.communicate(timeout=900)[1]
        self.assertEqual(running.returncode, 2, said)
        self.assertIn("disk is full", said)
        self.assertLess(len(self.results()), 60)
        ballast.unlink()
        self.finish(self.start_slices(file, 10))
        self.assert_same_as_local(file, 60)

    def test_two_campaigns_at_once_on_one_store(self) -> None:
        one, two = self.grid(30, 1, "one"), self.grid(59, 1, "two")
        for running in [self.start_slices(file, 5) for file in (one, two)]:
            self.finish(running)
        self.assert_same_as_local(two, len(self.results()))

    def test_cancelled_and_interrupted_campaigns_go_on(self) -> None:
        file = self.grid(60, 2)
        running = self.start_slices(file, 10)
        self.wait_for_results(3)
        running.send_signal(signal.SIGINT)
        self.assertIn("its batch goes on in slurm", running.communicate()[1])
        self.campaign("cancel", file)
        time.sleep(3)
        self.assertEqual(self.workers(), [])
        self.finish(self.start_slices(file, 10))
        self.assert_same_as_local(file, 60)


if __name__ == "__main__":
    unittest.main()
