"""What the tests and trials of campaigns share: their commands, and what the shards say."""
from __future__ import annotations

import json
import os
import shutil
import subprocess
import time
from pathlib import Path

from program_case import PROGRAM, ROOT, ProgramCase

HERE = ROOT / "scripts" / "slurm-here"


def lines_in(out: Path) -> list[dict]:
    """Whole lines of all shards of a store. ValueError for one that is damaged."""
    return [
        json.loads(line)
        for path in (out / "store/batches").glob("*/shards/**/*.jsonl")
        for line in path.read_text().splitlines(keepends=True)
        if line.endswith("\n")  # a kill cuts off the last one
    ]


def parent_of(process: int) -> int:
    """0 if it has just ended."""
    try:
        stat = Path(f"/proc/{process}/stat").read_text()
    except OSError:
        return 0
    return int(stat.rpartition(")")[2].split()[1])


def processes_with(word: str) -> list[int]:
    """Those of `campaign work` whose command line has the word."""
    found = []
    for path in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            words = path.read_bytes()
        except OSError:
            continue
        if b"\0work\0" in words and word.encode() in words:
            found.append(int(path.parent.name))
    return found


def can_start_slurm() -> bool:
    commands = ("slurmctld", "slurmd", "munged", "sbatch")
    return os.geteuid() == 0 and all(map(shutil.which, commands))


class CampaignCase(ProgramCase):
    """Campaigns in a store of this test's own."""

    def setUp(self) -> None:
        super().setUp()
        self.out, self.environment = self.path / "out", dict(os.environ)

    def campaign_file(self, text: str, name: str = "grid") -> str:
        return self.write(f"{name}.campaign.toml", text)

    def command(self, command: str, *words: object) -> list[str]:
        out = [] if "--out" in words or command == "work" else ["--out", self.out]
        return [str(word) for word in [PROGRAM, "campaign", command, *words, *out]]

    def campaign(self, command: str, *words: object) -> subprocess.CompletedProcess[str]:
        return subprocess.run(self.command(command, *words), cwd=ROOT, env=self.environment,
                              capture_output=True, text=True, check=False)

    def start(self, command: str, *words: object) -> subprocess.Popen[str]:
        return subprocess.Popen(self.command(command, *words), cwd=ROOT, env=self.environment,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def status(self, file: str) -> dict:
        return json.loads(self.campaign("status", file, "--json").stdout)

    def lines(self) -> list[dict]:
        return lines_in(self.out)

    def results(self) -> dict[str, dict]:
        """The content of each result, none of them twice."""
        found = [line for line in self.lines() if "result" in line]
        contents = {line["result"]: line["content"] for line in found}
        self.assertEqual(len(found), len(contents), "a job has two results")
        return contents

    def wait_for_results(self, count: int) -> None:
        for _ in range(30000):
            if sum("result" in line for line in self.lines()) >= count:
                return
            time.sleep(0.01)
        self.fail(f"there are no {count} results after five minutes")


class SlurmCluster:
    """Virtual nodes of one core each on this machine; SLURM_CONF is set in the environment."""

    def __init__(self, folder: Path, environment: dict[str, str], nodes: int = 3) -> None:
        self.folder = folder
        environment["SLURM_CONF"] = str(folder / "slurm.conf")
        try:
            self.here("up", str(nodes))
        except subprocess.CalledProcessError:
            self.here("down")
            raise

    def here(self, what: str, *words: str) -> None:
        """`down`, or `node K` and `controller` to start again what was killed."""
        subprocess.run([HERE, what, self.folder, *words], check=True)

    def kill(self, daemon: str, how: int) -> None:
        os.kill(int((self.folder / f"{daemon}.pid").read_text()), how)
