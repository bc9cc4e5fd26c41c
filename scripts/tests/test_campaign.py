#!/usr/bin/python3
"""Tests of campaigns on this machine: the same question is asked once, and nothing that is killed
is lost.

scripts/tests/test_campaign.py [--program FILE] [CampaignTest.test_...]
"""
from __future__ import annotations

import contextlib
import csv
import json
import os
import re
import signal
import subprocess
import sys
import time
import tomllib
import unittest
from collections import Counter
from pathlib import Path

sys.dont_write_bytecode = True

import h5py  # noqa: E402

from campaign_case import CampaignCase, parent_of  # noqa: E402
from program_case import ROOT, run  # noqa: E402

GRID = """case = "hinge"
[set]
"time.end" = 0.05
[grid]
"bending.stiffness" = [1e-3, 2e-3, 3e-3]
"time.integrator" = ["A", "C"]
"""

# Twelve runs of some tenths of a second each, so that a signal meets one that is not done.
LONG = """case = "hinge"
[set]
"time.end" = 2
"time.step" = 5e-6
[grid]
"bending.stiffness" = { from = 1e-3, to = 2e-3, count = 12 }
"""

# runs all elements of --array=0-LAST one after the other; the script comes last
SBATCH = """#!/bin/sh
for word; do case $word in --array=0-*) last=${word#--array=0-} ;; esac; done
for k in $(seq 0 "$last"); do SLURM_ARRAY_TASK_ID=$k sh "$word" >>"$0.log" 2>&1; done
"""


class CampaignTest(CampaignCase):
    def table(self, file: str) -> list[dict[str, str]]:
        self.table_code = self.campaign("table", file).returncode
        table = self.out / "campaigns/grid/table.csv"
        with table.open(newline="", encoding="utf-8") as text:
            return list(csv.DictReader(text))

    def test_a_grid_becomes_a_table(self) -> None:
        file = self.campaign_file(GRID)
        said = self.campaign("plan", file).stdout
        self.assertIn("6 jobs, 6 missing", said)
        sampled = [float(s) for s in re.findall(r"holds, ([-\de.]+) s\n", said)]
        forecast = re.search(r"forecast: (\S+) s of one core, .*, (\S+) s on 100 nodes", said)
        self.assertIsNotNone(forecast, said)
        one_core, many = (float(seconds) for seconds in forecast.groups())
        self.assertAlmostEqual(one_core, 6 * sum(sampled) / len(sampled), delta=0.05 * one_core)
        self.assertAlmostEqual(many, max(sampled), delta=0.05 * many)
        self.assertEqual(self.campaign("run", file).returncode, 0)
        rows = self.table(file)
        self.assertEqual(self.table_code, 0)
        self.assertEqual([(row["bending.stiffness"], row["time.integrator"]) for row in rows],
                         [(k, method) for method in "AC" for k in ("0.001", "0.002", "0.003")])
        self.assertEqual({row["outcome"] for row in rows}, {"holds"})
        with h5py.File(self.out / "campaigns/grid/table.h5") as table:
            self.assertEqual(list(table["quantity/height"]),
                             [float(row["height [m]"]) for row in rows])

    def test_a_row_is_what_simulate_says(self) -> None:
        file = self.campaign_file(GRID)
        self.campaign("run", file)
        [row] = [row for row in self.table(file)
                 if (row["bending.stiffness"], row["time.integrator"]) == ("0.002", "A")]
        alone = run("simulate", "hinge", "--set", "time.end=0.05", "--set",
                    "bending.stiffness=2e-3", "--set", "time.integrator=A", "--json", "--out",
                    str(self.path / "alone"), folder=ROOT)
        said = {row["name"]: row for row in json.loads(alone.stdout)["quantities"]}
        self.assertIn("height", said)
        for name, quantity in said.items():
            self.assertEqual(float(row[f"{name} [{quantity['unit']}]"]), quantity["value"], name)

    def test_no_question_is_asked_twice_in_whichever_campaign(self) -> None:
        file = self.campaign_file(GRID)
        self.campaign("run", file)
        self.campaign("run", file)
        wider = self.campaign_file(GRID.replace("3e-3]", "3e-3, 4e-3]"), "wider")
        self.assertIn("8 jobs, 6 holds, 2 missing", self.campaign("plan", wider).stdout)
        self.campaign("run", wider)
        self.assertEqual(len(self.results()), 8)

    def test_failures_are_results_with_their_reasons(self) -> None:
        text = GRID.replace('["A", "C"]', '["A", "Z"]').replace("2e-3", "-1")
        file = self.campaign_file(text)
        self.assertEqual(self.campaign("run", file).returncode, 1)
        reasons = {(row["bending.stiffness"], row["time.integrator"]): row["reason"]
                   for row in self.table(file)}
        self.assertIn("Z", reasons["0.001", "Z"])
        self.assertIn("stiffness", reasons["-1", "A"])
        self.assertEqual(reasons["0.003", "A"], "")
        self.campaign("run", file)
        self.assertEqual(len(self.results()), 6)
        self.table(self.campaign_file(text + '[expect.height]\nat_most = 1e9\nwhy = "test"\n'))
        self.assertEqual(self.table_code, 1)

    def test_a_job_beyond_its_limit_is_a_result_and_the_others_run(self) -> None:
        file = self.campaign_file(
            'case = "hinge"\n[limits]\nseconds = 0.5\n[set]\n"time.step" = 1e-6\n'
            '[grid]\n"time.end" = [0.001, 100, 0.002]\n')
        self.assertEqual(self.campaign("run", file).returncode, 1)
        self.assertEqual({row["time.end"]: row["outcome"] for row in self.table(file)},
                         {"0.001": "holds", "100": "timed out", "0.002": "holds"})

    def test_bounds_over_all_runs_are_judged(self) -> None:
        file = self.campaign_file(GRID)
        self.campaign("run", file)
        heights = sorted(float(row["height [m]"]) for row in self.table(file))
        asked = [(1, 1e9, 0), (1, -1e9, 1), (0.01, 1e9, 0)]
        for share, k in ((0.5, 2), (0.95, 5)):
            if heights[k] != heights[k - 1]:
                asked += [(share, heights[k], 0), (share, heights[k] - 1e-12, 1)]
        for share, bound, code in asked:
            self.table(self.campaign_file(
                GRID + f'[expect.height]\nat_most = {bound!r}\nshare = {share}\nwhy = "test"\n'))
            self.assertEqual(self.table_code, code, (share, bound))

    def test_runs_that_are_kept_have_folders_of_their_own(self) -> None:
        text = GRID.replace("3e-3]", "-1]")  # two jobs are refused, and have no frames
        for keep in ("", 'keep = "all"\n', 'keep = "all"\n'):
            self.assertEqual(self.campaign("run", self.campaign_file(keep + text)).returncode, 1)
        kept = {line["result"]: line["kept"] for line in self.lines() if line.get("kept")}
        self.assertEqual(len(set(kept.values())), 4)
        for key, folder in kept.items():
            self.assertIn(key, folder)
            self.assertTrue((self.out / "store" / folder / "hinge.h5").is_file())
        # once without frames, once with them
        self.assertEqual(sum("result" in line for line in self.lines()), 10)

    def test_shipped_campaigns_have_the_jobs_that_their_page_says(self) -> None:
        shipped = ROOT / "cases/campaigns"
        page = (shipped / "SHIPPED.md").read_text(encoding="utf-8")
        row = r"^\| \[`(\w+)`\]\(\1\.campaign\.toml\) \| ([\d,]+|all) \|"
        rows = dict(re.findall(row, page, re.M))
        files = sorted(shipped.glob("*.campaign.toml"))
        self.assertEqual(sorted(rows), [path.name.split(".")[0] for path in files])
        faults = sum(len(tomllib.loads(path.read_text(encoding="utf-8")).get("fault", {}))
                     for path in (ROOT / "verification/faults").glob("*.toml"))
        for name, said in rows.items():
            jobs = faults if said == "all" else int(said.replace(",", ""))
            self.assertEqual(self.status(name)["jobs"], jobs, name)
        mutants = tomllib.loads((shipped / "mutants.campaign.toml").read_text(encoding="utf-8"))
        rooms = [path for path in (ROOT / "reference").iterdir() if list(path.glob("*.h"))]
        self.assertEqual(mutants["grid"]["name"],
                         [str(path.relative_to(ROOT)) for path in sorted(rooms)])

    def test_other_commands_are_jobs(self) -> None:
        file = self.campaign_file(
            'run = "check"\n[grid]\nname = ["bending.forces-sum-to-zero", '
            '"bending.torques-sum-to-zero"]\nseed = [0, 5]\n')
        self.assertEqual(self.campaign("run", file).returncode, 0)
        self.assertEqual(len(self.table(file)), 4)

    def test_a_job_that_fails_names_what_failed(self) -> None:
        wrong = "python3 verification/subjects/bad/wrong.py gravity_scaled"
        law = "gravity.speed-grows-by-g-t"
        file = self.campaign_file(
            f'run = "judge"\n[set]\nsolver = "{wrong}"\n[grid]\nname = ["{law}"]\n')
        self.assertEqual(self.campaign("run", file).returncode, 1)
        self.assertEqual([row["reason"] for row in self.table(file)], [law])

    def test_emitted_commands_do_the_work_once(self) -> None:
        file = self.campaign_file(GRID)
        lines = self.campaign("emit", file, "--slice", "4").stdout.splitlines()
        self.assertEqual(len(lines), 2)
        for k, line in enumerate([*reversed(lines), *lines]):
            scratch = " --scratch " + str(self.path / "scratch").replace(" ", "\\ ")
            subprocess.run(line + scratch * (k % 2), shell=True, check=True, capture_output=True)
        self.assertEqual(self.status(file)["done"], 6)
        self.assertEqual(len(self.results()), 6)
        self.assertFalse(list((self.path / "scratch").iterdir()))

    def test_a_slice_that_is_started_twice_at_once_is_worked_on_once(self) -> None:
        [line] = self.campaign("emit", self.campaign_file(LONG), "--slice",
                               "12").stdout.splitlines()
        absent = subprocess.run(line.replace("--slice 0", "--slice 1"), shell=True, check=False,
                                capture_output=True, text=True)
        self.assertEqual(absent.returncode, 2)
        self.assertIn("the batch has no such slice", absent.stderr)
        running = []
        for _ in range(2):
            running.append(subprocess.Popen(line, shell=True, stderr=subprocess.DEVNULL))
            self.wait_for_results(1)
        self.assertEqual([process.wait() for process in running], [0, 0])
        self.assertEqual(len(self.results()), 12)

    def test_a_campaign_that_is_killed_goes_on(self) -> None:
        file = self.campaign_file(LONG)
        for how in (signal.SIGINT, signal.SIGKILL, signal.SIGTERM):
            running = self.start("run", file, "--threads", "2")
            self.wait_for_results(len(self.results()) + 1)
            running.send_signal(how)
            said = running.communicate()[1]
            self.assertEqual(running.returncode, -how)
            if how != signal.SIGKILL:
                self.assertIn("interrupted; go on with: ", said)
        self.assertEqual(self.campaign("run", file).returncode, 0)
        self.assertEqual(len(self.results()), 12)
        said = self.status(file)
        self.assertEqual((said["done"], said["repeated"], said["conflicts"]), (12, 0, 0))

    def test_cancelled_jobs_are_missing(self) -> None:
        file = self.campaign_file(LONG)
        running = self.start("run", file, "--threads", "1")
        self.wait_for_results(1)
        self.assertIn("1 batches cancelled", self.campaign("cancel", file).stdout)
        running.communicate()
        self.assertEqual(running.returncode, -signal.SIGTERM)
        said = self.status(file)
        self.assertEqual((said["running"], said["done"] + said["missing"]), (0, 12))

    def test_a_job_whose_process_dies_three_times_has_crashed_and_the_others_run(self) -> None:
        file = self.campaign_file(LONG.replace("= 2\n", "= 1e4\n").replace("= 12", "= 3"))
        running = self.start("run", file, "--threads", "1")
        killed: set[int] = set()
        while running.poll() is None:  # every process is killed while it works
            for child in map(int, (p.name for p in Path("/proc").glob("[0-9]*"))):
                starts = sum("start" in line for line in self.lines())
                if parent_of(child) == running.pid and child not in killed and (
                    starts > len(killed)):
                    killed.add(child)
                    with contextlib.suppress(ProcessLookupError):
                        os.kill(child, signal.SIGKILL)
            time.sleep(0.01)
        self.assertIn("crashed after 3 starts", running.communicate()[1])
        self.assertEqual(running.returncode, 1)
        self.assertEqual(self.status(file)["crashed"], 3)
        starts = Counter(line["start"] for line in self.lines() if "start" in line)
        self.assertEqual(sorted(starts.values()), [3, 3, 3])
        # in the batch itself: a later round would start them again, too
        self.assertEqual(len(list(self.out.glob("store/batches/*/batch.json"))), 1)

    def test_watching_shows_a_line_and_a_page_until_nothing_runs(self) -> None:
        file = self.campaign_file('title = "<b>"\n' + LONG)
        page = self.out / "campaigns/grid/watch.html"
        for how, code in ((signal.SIGTERM, 1), (None, 0)):
            running = self.start("run", file, "--threads", "1")
            self.wait_for_results(len(self.results()) + 1)
            watching = self.start("watch", file)
            while not page.exists() or 'http-equiv="refresh"' not in page.read_text():
                self.assertIsNone(watching.poll())
                time.sleep(0.01)
            self.assertRegex(page.read_text(), r"&lt;b&gt;: \d+ of 12|\d+ of 12: &lt;b&gt;")
            if how:
                running.send_signal(how)
            said, line = watching.communicate()
            running.communicate()
            self.assertEqual(watching.returncode, code, said)
            self.assertRegex(line, r"^grid: \d+ of 12 done, \d+ running")
            self.assertNotIn("refresh", page.read_text())
        self.assertIn("12 of 12 done", page.read_text())
        self.assertIn("12 jobs, 12 holds", said)

    def test_two_campaigns_at_once_share_their_work(self) -> None:
        files = [self.campaign_file(LONG, "one"),
                 self.campaign_file(LONG.replace("2e-3, count = 12", "2e-3, count = 23"), "two")]
        running = [self.start("run", file, "--threads", "1") for file in files]
        for process in running:
            process.communicate()
        self.assertEqual([process.returncode for process in running], [0, 0])
        self.assertEqual(len(self.results()), 23)

    def test_wrong_input_is_refused_in_a_line(self) -> None:
        for text, said in {
            'case = "hinge"\n[grid]\na = 1\n': "grid.campaign.toml:3: 'a' needs a list",
            'case = "hinges"\n': "did you mean",
            'run = "dance"\n': "is no command of a campaign",
            '[grid]\n"time.end" = [1]\n': "needs the key 'case'",
        }.items():
            done = self.campaign("run", self.campaign_file(text))
            self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), text)
            self.assertIn(said, done.stderr)
        self.assertIn("--on pigeon: no such engine",
                      self.campaign("run", self.campaign_file(GRID), "--on", "pigeon").stderr)
        self.assertEqual(self.campaign("work", str(self.path), "--slice", "0").returncode, 2)


class SlicesTest(CampaignCase):
    """How campaigns are cut into slices, on a Slurm that is made up: its commands are scripts that
    say what a cluster offers, and run each slice at once."""

    def setUp(self) -> None:
        super().setUp()
        self.environment["PATH"] = f"{self.path}:{self.environment['PATH']}"
        for name, text in (("sbatch", SBATCH), ("squeue", "#!/bin/sh\n"), ("scancel", "")):
            self.script(name, text)

    def script(self, name: str, text: str) -> None:
        Path(self.write(name, text)).chmod(0o755)

    def slices_of(self, count: int, *words: str, nodes: str = "2 4", array: int = 1001,
                  jobs: int = 10000) -> list[int]:
        """Jobs in each slice of a fresh store; sinfo says nodes as "COUNT CORES" lines."""
        self.script("sinfo", f"#!/bin/sh\necho '{nodes}'\n")
        self.script("scontrol", f"#!/bin/sh\necho head; echo 'MaxArraySize            = {array}'\n"
                    f"echo 'MaxJobCount             = {jobs}'\n")
        self.out = self.path / f"out-{len(list(self.path.iterdir()))}"
        file = self.campaign_file(
            'case = "hinge"\n[set]\n"time.end" = 0.002\n"time.step" = 1e-3\n[grid]\n'
            f'"bending.stiffness" = {{ from = 1e-3, to = 2e-3, count = {count} }}\n')
        done = self.campaign("run", file, "--on", "slurm", *words)
        self.assertEqual(done.returncode, 0, done.stderr)
        return [len(path.read_text(encoding="utf-8").splitlines())
                for path in sorted(self.out.glob("store/batches/*/slices/*.jsonl"))]

    def test_all_cores_of_the_cluster_get_a_share(self) -> None:
        self.assertEqual(self.slices_of(40), [5] * 8)
        self.assertEqual(self.slices_of(40, "--options", "--cpus-per-task=2"), [10] * 4)
        self.assertEqual(self.slices_of(40, "--options", "-c4"), [20] * 2)
        self.assertEqual(self.slices_of(40, "--options", "--exclusive --time=5"), [20] * 2)
        self.assertEqual(self.slices_of(40, "--options", "--exclusive", nodes="1 2\n1 3"),
                         [16, 16, 8])
        self.assertEqual(self.slices_of(40, "--slice", "30"), [30, 10])

    def test_no_more_slices_than_the_controller_keeps(self) -> None:
        self.assertEqual(self.slices_of(40, nodes="50 1", jobs=20), [4] * 10)
        self.assertEqual(self.slices_of(8, nodes="1 40", array=3), [3, 3, 2])
        self.assertEqual(self.slices_of(8, "--slice", "1", array=3), [1] * 8)  # in three batches

    def test_a_folder_has_the_shards_of_a_hundred_slices(self) -> None:
        self.assertEqual(self.slices_of(103, "--slice", "1"), [1] * 103)
        shards = sorted(str(path.relative_to(path.parents[1]))[:11]
                        for path in self.out.glob("store/batches/*/shards/*/*.jsonl"))
        self.assertEqual(shards, [f"{k // 100:04}/{k:06}" for k in range(103)])


if __name__ == "__main__":
    unittest.main()
