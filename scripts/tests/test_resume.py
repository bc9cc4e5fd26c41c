#!/usr/bin/python3
"""Tests of commands that are interrupted and go on: checks, studies, questions about a case."""
from __future__ import annotations

import json
import shlex
import shutil
import signal
import time
import unittest
from pathlib import Path

import h5py

from program_case import ProgramCase, run, run_until

STUDIES = ("time-order.hinge", "elastic-limit", "strain-sweeps")


def judged(folder: Path) -> list[dict]:
    """The findings of a run without the seconds that they took."""
    told = json.loads((folder / "verdicts.json").read_text(encoding="utf-8"))
    return [{k: v for k, v in row.items() if k != "seconds"} for row in told["findings"]]


def catches_signals(process: int) -> bool:
    """Whether the process has a handler for SIGTERM."""
    status = Path(f"/proc/{process}/status").read_text(encoding="utf-8")
    caught = next(row for row in status.splitlines() if row.startswith("SigCgt:"))
    return bool(int(caught.split()[1], 16) >> (signal.SIGTERM - 1) & 1)


class ResumeTest(ProgramCase):
    def interrupted(self, *options: str) -> Path:
        """The folder of a run that was killed after its first study."""
        out = self.path / "out"
        run_until(lambda _: list(out.glob("unfinished/*.cbor")), "study", *STUDIES, "--threads",
                  "1", "--out", out, *options)
        self.assertTrue(list(out.glob("unfinished/*.cbor")), "it was not killed in time")
        self.assertFalse((out / "run.h5").exists())
        return out

    def test_a_killed_run_goes_on_to_the_same_findings_and_names_its_parts(self) -> None:
        whole = self.path / "whole"
        run("study", *STUDIES, "--out", str(whole))
        self.assertFalse((whole / "unfinished").exists())
        out = self.interrupted()
        time.sleep(1.1)  # parts are told apart by the second in which their runs began
        done = run("study", *STUDIES, "--out", str(out), "--resume")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stderr, r"interrupted run that went on: \d jobs? on .*; \d jobs? on")
        self.assertEqual(judged(out), judged(whole))
        self.assertFalse((out / "unfinished").exists())
        with h5py.File(out / "run.h5") as file, h5py.File(whole / "run.h5") as other:
            self.assertRegex(file.attrs["parts"], r"^\d jobs? on \w+ \(\w+\), begun 20.*Z; \d job")
            self.assertNotIn("parts", other.attrs)
            names: list[str] = []
            other["studies"].visit(names.append)
            for name in names:
                self.assertIn(name, file["studies"])

    def test_the_same_command_deletes_nothing(self) -> None:
        out = self.interrupted()
        kept = sorted(out.glob("unfinished/*"))
        self.assert_refused(run("study", *STUDIES, "--out", str(out)), "--resume", "--restart")
        self.assertEqual(sorted(out.glob("unfinished/*")), kept)
        restarted = run("study", STUDIES[1], "--out", str(out), "--restart")
        self.assertEqual(restarted.returncode, 0, restarted.stderr)
        self.assertNotIn("went on", restarted.stderr)
        self.assertFalse((out / "unfinished").exists())

    def test_what_another_seed_or_tier_left_is_not_taken(self) -> None:
        out = self.interrupted("--seed", "7")
        done = run("study", STUDIES[0], "--out", str(out), "--resume")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("went on", done.stderr)

    def stopped(self, how: int, ready: str, *command: str) -> str:
        """The last line on standard error of a command that the signal reaches when it catches
        signals, and has made a file that fits the pattern."""
        done = run_until(lambda process: catches_signals(process) and list(self.path.glob(ready)),
                         *command, "--threads", "1", how=how)
        self.assertEqual(done.returncode, -how, done.stderr)
        return done.stderr.splitlines()[-1]

    def test_an_interrupted_command_says_what_is_kept_and_how_to_go_on(self) -> None:
        for how, ready, kept, command in (
            (signal.SIGINT, "out/store/shards/*", "store", ("precision", "hinge")),
            (signal.SIGTERM, "out/store/shards/*", "store", ("converge", "hanging_sheet")),
            (signal.SIGINT, "out/store/shards/*", "store", ("ablate", "hanging_sheet")),
            (signal.SIGTERM, "out/verdicts.json", "unfinished", ("verify", "--no-bench")),
            (signal.SIGINT, "out/unfinished/*.cbor", "unfinished", ("study", *STUDIES)),
        ):
            said = self.stopped(how, ready, *command, "--out", self.out)
            self.assertRegex(said, rf"^interrupted; .* in .*/{kept}; go on with: .*{command[0]} ")
            again = shlex.split(said.split("go on with: ")[1])
            self.assertEqual("--resume" in again, kept == "unfinished")
            self.assertIn(self.out, again)
            shutil.rmtree(self.out)
        said = self.stopped(signal.SIGINT, "**", "check")
        self.assertEqual(said, "interrupted; nothing is kept without --out DIR")

    def test_without_a_folder_there_is_nothing_to_resume(self) -> None:
        self.assertIn("need --out", self.assert_rejected("check", "bending", "--resume"))


if __name__ == "__main__":
    unittest.main()
