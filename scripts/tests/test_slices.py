#!/usr/bin/python3
"""Tests of how campaigns are cut into slices, on a Slurm that is made up: its commands are scripts
that say what a cluster offers, and run each slice at once.

scripts/tests/test_slices.py [--program FILE] [SlicesTest.test_...]

--program: another than build/foldproof
"""
from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(sys.argv.pop(2)) if sys.argv[1:2] == ["--program"] else ROOT / "build" / "foldproof"

CAMPAIGN = """case = "hinge"
[set]
"time.end" = 0.002
"time.step" = 1e-3
[grid]
"bending.stiffness" = {{ from = 1e-3, to = 2e-3, count = {count} }}
"""

# runs all elements of --array=0-LAST one after the other; the script and the offset come last
SBATCH = """#!/bin/sh
printf '%s\\n' "$*" >>"$FAKE/said"
for word; do
  case $word in --array=0-*) last=${word#--array=0-} ;; esac
  script=$offset offset=$word
done
k=0
while [ "$k" -le "$last" ]; do
  SLURM_ARRAY_TASK_ID=$k sh "$script" "$offset" >>"$FAKE/log" 2>&1
  k=$((k + 1))
done
echo 17
"""


class SlicesTest(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory(prefix="foldproof test ")
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name)
        self.environment = os.environ | {
            "PATH": f"{self.path}:{os.environ['PATH']}",
            "FAKE": str(self.path),
        }
        self.command("sbatch", SBATCH)
        self.command("squeue", "#!/bin/sh\n")
        self.command("scancel", "#!/bin/sh\n")
        self.cluster(nodes="2 4", array=1001, jobs=10000)

    def command(self, name: str, text: str) -> None:
        path = self.path / name
        path.write_text(text)
        path.chmod(0o755)

    def cluster(self, nodes: str, array: int, jobs: int) -> None:
        """What sinfo and scontrol say: nodes as "COUNT CORES" lines."""
        self.command("sinfo", f"#!/bin/sh\necho '{nodes}'\n")
        self.command(
            "scontrol",
            f"#!/bin/sh\necho head; echo 'MaxArraySize            = {array}'\n"
            f"echo 'MaxJobCount             = {jobs}'\n",
        )

    def slices_of(self, count: int, *words: str) -> list[int]:
        """Jobs in each slice of a fresh store."""
        out = self.path / f"out-{count}-{len(list(self.path.iterdir()))}"
        file = self.path / "grid.campaign.toml"
        file.write_text(CAMPAIGN.format(count=count))
        done = subprocess.run(
            [PROGRAM, "campaign", "run", file, "--out", out, "--on", "slurm", *words],
            cwd=ROOT,
            env=self.environment,
            capture_output=True,
            text=True,
            check=False,
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        self.shards = sorted(
            str(path.relative_to(path.parents[1]))[:11]
            for path in out.glob("store/**/*.jsonl")
            if "shards" in path.parts
        )
        return [
            len(path.read_text(encoding="utf-8").splitlines())
            for path in sorted(out.glob("store/batches/*/slices/*.jsonl"))
        ]

    def test_all_cores_of_the_cluster_get_a_share(self) -> None:
        self.assertEqual(self.slices_of(40), [5] * 8)
        self.assertEqual(self.slices_of(40, "--options", "--cpus-per-task=2"), [10] * 4)
        self.assertEqual(self.slices_of(40, "--options", "-c4"), [20] * 2)
        self.assertEqual(self.slices_of(40, "--options", "--exclusive --time=5"), [20] * 2)
        self.cluster(nodes="1 2\n1 3", array=1001, jobs=10000)
        self.assertEqual(self.slices_of(40, "--options", "--exclusive"), [16, 16, 8])
        self.assertEqual(self.slices_of(40, "--slice", "30"), [30, 10])

    def test_no_more_slices_than_the_controller_keeps(self) -> None:
        self.cluster(nodes="50 1", array=1001, jobs=20)
        self.assertEqual(self.slices_of(40), [4] * 10)

    def test_arrays_are_as_long_as_they_may_be(self) -> None:
        self.cluster(nodes="1 40", array=3, jobs=10000)
        self.assertEqual(self.slices_of(8), [1] * 8)
        said = (self.path / "said").read_text(encoding="utf-8").splitlines()
        self.assertEqual([line.rsplit(" ", 1)[1] for line in said], ["0", "3", "6"])

    def test_a_folder_has_the_shards_of_a_hundred_slices(self) -> None:
        self.assertEqual(self.slices_of(103, "--slice", "1"), [1] * 103)
        self.assertEqual(
            self.shards,
            [f"{k // 100:04}/{k:06}" for k in range(103)],
        )


if __name__ == "__main__":
    if sys.argv[1:2] == ["--program"]:
        del sys.argv[1]  # its file is taken out above
    unittest.main()
