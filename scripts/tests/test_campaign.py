#!/usr/bin/python3
"""Tests of campaigns on this machine: the same question is asked once, and nothing that is killed
is lost.

scripts/tests/test_campaign.py [--program FILE] [CampaignTest.test_...]

--program: another than build/foldproof
"""

import contextlib
import csv
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
import tomllib
import unittest
from collections import Counter
from pathlib import Path

import h5py

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(sys.argv.pop(2)) if sys.argv[1:2] == ["--program"] else ROOT / "build" / "foldproof"

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


def children_of(process: int) -> list[str]:
    try:
        return Path(f"/proc/{process}/task/{process}/children").read_text().split()
    except OSError:  # it has just ended
        return []


class CampaignTest(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = tempfile.TemporaryDirectory(prefix="foldproof test ")
        self.path = Path(self.folder.name)
        self.out = self.path / "out"

    def tearDown(self) -> None:
        self.folder.cleanup()

    def write(self, text: str, name: str = "grid") -> str:
        path = self.path / f"{name}.campaign.toml"
        path.write_text(text)
        return str(path)

    def campaign(self, command: str, *arguments: str) -> subprocess.CompletedProcess[str]:
        out = [] if "--out" in arguments or command == "work" else ["--out", str(self.out)]
        return subprocess.run(
            [str(PROGRAM), "campaign", command, *arguments, *out],
            cwd=ROOT,
            capture_output=True,
            text=True,
            check=False,
        )

    def status(self, file: str) -> dict:
        return json.loads(self.campaign("status", file, "--json").stdout)

    def rows(self, name: str = "grid") -> list[dict[str, str]]:
        with open(
            self.out / "campaigns" / name / "table.csv", newline="", encoding="utf-8"
        ) as file:
            return list(csv.DictReader(file))

    def lines(self) -> list[dict]:
        return [
            json.loads(line)
            for path in self.out.glob("store/batches/*/shards/**/*.jsonl")
            for line in path.read_text().splitlines(keepends=True)
            if line.endswith("\n")
        ]

    def result_lines(self) -> list[dict]:
        return [line for line in self.lines() if "result" in line]

    def test_a_grid_becomes_a_table(self) -> None:
        file = self.write(GRID)
        said = self.campaign("plan", file).stdout
        self.assertIn("6 jobs, 6 missing", said)
        sampled = [float(s) for s in re.findall(r"holds, ([-\de.]+) s\n", said)]
        forecast = re.search(r"forecast: (\S+) s of one core, .*, (\S+) s on 100 nodes", said)
        self.assertIsNotNone(forecast, said)
        one_core, many = (float(seconds) for seconds in forecast.groups())
        self.assertAlmostEqual(one_core, 6 * sum(sampled) / len(sampled), delta=0.05 * one_core)
        self.assertAlmostEqual(many, max(sampled), delta=0.05 * many)
        self.assertEqual(self.campaign("run", file).returncode, 0)
        self.assertEqual(self.campaign("table", file).returncode, 0)
        rows = self.rows()
        self.assertEqual(
            [(row["bending.stiffness"], row["time.integrator"]) for row in rows],
            [(k, method) for method in "AC" for k in ("0.001", "0.002", "0.003")],
        )
        self.assertEqual({row["outcome"] for row in rows}, {"holds"})
        with h5py.File(self.out / "campaigns/grid/table.h5") as table:
            self.assertEqual(
                list(table["quantity/height"]), [float(row["height [m]"]) for row in rows]
            )

    def test_a_report_has_its_figures(self) -> None:
        figure = '[[figure]]\nquantity = "height"\nover = ["bending.stiffness"]\n'
        file = self.write(GRID + figure)
        self.campaign("run", file)
        done = self.campaign("report", file)
        self.assertEqual(done.returncode, 0, done.stderr)
        page = Path(done.stdout.strip()).read_text(encoding="utf-8")
        self.assertEqual(page.count("<figure"), 1)
        self.assertIn("height [m]", page)

    def test_a_row_is_what_simulate_says(self) -> None:
        file = self.write(GRID)
        self.campaign("run", file)
        self.campaign("table", file)
        alone = subprocess.run(
            [
                PROGRAM,
                "simulate",
                "hinge",
                "--set",
                "time.end=0.05",
                "--set",
                "bending.stiffness=2e-3",
                "--set",
                "time.integrator=A",
                "--json",
                "--out",
                self.path / "alone",
            ],
            capture_output=True,
            text=True,
            check=True,
            cwd=ROOT,
        )
        said = {row["name"]: row for row in json.loads(alone.stdout)["quantities"]}
        row = next(
            row
            for row in self.rows()
            if (row["bending.stiffness"], row["time.integrator"]) == ("0.002", "A")
        )
        self.assertIn("height", said)
        for name, quantity in said.items():
            self.assertEqual(float(row[f"{name} [{quantity['unit']}]"]), quantity["value"], name)

    def test_no_question_is_asked_twice_in_whichever_campaign(self) -> None:
        file = self.write(GRID)
        self.campaign("run", file)
        self.campaign("run", file)
        wider = self.write(GRID.replace("3e-3]", "3e-3, 4e-3]"), "wider")
        self.assertIn("8 jobs, 6 holds, 2 missing", self.campaign("plan", wider).stdout)
        self.campaign("run", wider)
        keys = [line["result"] for line in self.result_lines()]
        self.assertEqual((len(keys), len(set(keys))), (8, 8))

    def test_failures_are_results_with_their_reasons(self) -> None:
        file = self.write(GRID.replace('["A", "C"]', '["A", "Z"]').replace("2e-3", "-1"))
        self.assertEqual(self.campaign("run", file).returncode, 1)
        self.campaign("table", file)
        reasons = {
            (row["bending.stiffness"], row["time.integrator"]): row["reason"] for row in self.rows()
        }
        self.assertIn("Z", reasons["0.001", "Z"])
        self.assertIn("stiffness", reasons["-1", "A"])
        self.assertEqual(reasons["0.003", "A"], "")
        before = len(self.result_lines())
        self.campaign("run", file)
        self.assertEqual(len(self.result_lines()), before)
        expected = '[expect.height]\nat_most = 1e9\nwhy = "test"\n'
        file = self.write(Path(file).read_text(encoding="utf-8") + expected)
        self.assertEqual(self.campaign("table", file).returncode, 1)

    def test_a_job_beyond_its_limit_is_a_result_and_the_others_run(self) -> None:
        file = self.write(
            'case = "hinge"\n[limits]\nseconds = 0.5\n[set]\n"time.step" = 1e-6\n'
            '[grid]\n"time.end" = [0.001, 100, 0.002]\n'
        )
        self.assertEqual(self.campaign("run", file).returncode, 1)
        self.campaign("table", file)
        self.assertEqual(
            {row["time.end"]: row["outcome"] for row in self.rows()},
            {"0.001": "holds", "100": "timed out", "0.002": "holds"},
        )

    def test_bounds_over_all_runs_are_judged(self) -> None:
        self.campaign("run", self.write(GRID))
        for share, bound, code in ((1, 1e9, 0), (1, -1e9, 1), (0.01, 1e9, 0)):
            file = self.write(
                GRID + f'[expect.height]\nat_most = {bound}\nshare = {share}\nwhy = "test"\n'
            )
            self.assertEqual(self.campaign("table", file).returncode, code, (share, bound))
        heights = sorted(float(row["height [m]"]) for row in self.rows())
        for share, k in ((0.5, 2), (0.95, 5)):
            for bound, code in ((heights[k], 0), (heights[k] - 1e-12, 1)):
                if heights[k] == heights[k - 1]:
                    continue
                file = self.write(
                    GRID + f'[expect.height]\nat_most = {bound!r}\nshare = {share}\nwhy = "test"\n'
                )
                self.assertEqual(self.campaign("table", file).returncode, code, (share, bound))

    def test_runs_that_are_kept_have_folders_of_their_own(self) -> None:
        file = self.write('keep = "all"\n' + GRID)
        self.campaign("run", file)
        kept = {line["result"]: line["kept"] for line in self.result_lines()}
        self.assertEqual(len(set(kept.values())), 6)
        for key, folder in kept.items():
            self.assertIn(key, folder)
            self.assertTrue((self.out / "store" / folder / "hinge.h5").is_file())

    def test_shipped_campaigns_have_the_jobs_that_their_page_says(self) -> None:
        shipped = ROOT / "cases/campaigns"
        page = (shipped / "SHIPPED.md").read_text(encoding="utf-8")
        row = r"^\| \[`(\w+)`\]\(\1\.campaign\.toml\) \| ([\d,]+|all) \|"
        rows = dict(re.findall(row, page, re.M))
        files = sorted(shipped.glob("*.campaign.toml"))
        self.assertEqual(sorted(rows), [path.name.split(".")[0] for path in files])
        faults = sum(
            len(tomllib.loads(path.read_text(encoding="utf-8")).get("fault", []))
            for path in (ROOT / "verification/faults").glob("*.toml")
        )
        for name, said in rows.items():
            jobs = faults if said == "all" else int(said.replace(",", ""))
            self.assertEqual(self.status(name)["jobs"], jobs, name)
        mutants = tomllib.loads((shipped / "mutants.campaign.toml").read_text(encoding="utf-8"))
        rooms = [path for path in (ROOT / "reference").iterdir() if list(path.glob("*.h"))]
        names = [str(path.relative_to(ROOT)) for path in sorted(rooms)]
        self.assertEqual(mutants["grid"]["name"], names)

    def test_other_commands_are_jobs(self) -> None:
        file = self.write(
            'run = "check"\n[grid]\nname = ["bending.forces-sum-to-zero", '
            '"bending.torques-sum-to-zero"]\n'
            'seed = [0, 5]\n'
        )
        self.assertEqual(self.campaign("run", file).returncode, 0)
        self.campaign("table", file)
        self.assertEqual(len(self.rows()), 4)

    def test_a_job_that_fails_names_what_failed(self) -> None:
        wrong = "python3 verification/subjects/bad/wrong.py gravity_scaled"
        law = "gravity.speed-grows-by-g-t"
        file = self.write(f'run = "judge"\n[set]\nsolver = "{wrong}"\n[grid]\nname = ["{law}"]\n')
        self.assertEqual(self.campaign("run", file).returncode, 1)
        self.campaign("table", file)
        self.assertEqual([row["reason"] for row in self.rows()], [law])

    def test_emitted_commands_do_the_work_once(self) -> None:
        file = self.write(GRID)
        lines = self.campaign("emit", file, "--slice", "4").stdout.splitlines()
        self.assertEqual(len(lines), 2)
        for line in [*reversed(lines), *lines]:
            subprocess.run(line, shell=True, check=True, capture_output=True)
        self.assertEqual(self.status(file)["done"], 6)
        self.assertEqual(len(self.result_lines()), 6)

    def test_a_slice_that_is_started_twice_at_once_is_worked_on_once(self) -> None:
        [line] = self.campaign("emit", self.write(LONG), "--slice", "12").stdout.splitlines()
        running = [subprocess.Popen(line, shell=True, stderr=subprocess.DEVNULL)]
        while not self.result_lines():
            time.sleep(0.01)
        running.append(subprocess.Popen(line, shell=True, stderr=subprocess.DEVNULL))
        self.assertEqual([process.wait() for process in running], [0, 0])
        keys = [line["result"] for line in self.result_lines()]
        self.assertEqual((len(keys), len(set(keys))), (12, 12))

    def test_a_campaign_that_is_killed_goes_on(self) -> None:
        file = self.write(LONG)
        for how in (signal.SIGINT, signal.SIGKILL, signal.SIGTERM):
            running = subprocess.Popen(
                [PROGRAM, "campaign", "run", file, "--out", self.out, "--threads", "2"],
                cwd=ROOT,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE,
                text=True,
            )
            done = len(self.result_lines())
            while running.poll() is None and len(self.result_lines()) == done:
                time.sleep(0.01)
            running.send_signal(how)
            said = running.communicate()[1]
            self.assertEqual(running.returncode, -how)
            if how != signal.SIGKILL:
                self.assertIn("interrupted; go on with: ", said)
            time.sleep(0.5)
        self.assertEqual(self.campaign("run", file).returncode, 0)
        keys = [line["result"] for line in self.result_lines()]
        self.assertEqual((len(keys), len(set(keys))), (12, 12))
        said = self.status(file)
        self.assertEqual((said["done"], said["repeated"], said["conflicts"]), (12, 0, 0))

    def test_a_job_whose_process_dies_three_times_has_crashed_and_the_others_run(self) -> None:
        fewer = LONG.replace("count = 12", "count = 3")
        endless = fewer.replace('"time.end" = 2', '"time.end" = 1e4')
        file = self.write(endless)
        running = subprocess.Popen(
            [PROGRAM, "campaign", "run", file, "--out", self.out, "--threads", "1"],
            cwd=ROOT,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        killed: set[int] = set()
        while running.poll() is None:  # every process of the crew is killed while it works
            for child in children_of(running.pid):
                starts = sum("start" in line for line in self.lines())
                if int(child) in killed or starts <= len(killed):
                    continue
                killed.add(int(child))
                with contextlib.suppress(ProcessLookupError):
                    os.kill(int(child), signal.SIGKILL)
            time.sleep(0.01)
        self.assertEqual(running.wait(), 1)
        self.assertIn("crashed after 3 starts", running.communicate()[1])
        self.assertEqual(self.status(file)["crashed"], 3)
        starts = Counter(line["start"] for line in self.lines() if "start" in line)
        self.assertEqual(sorted(starts.values()), [3, 3, 3])
        # in the batch itself: a later round would start them again, too
        self.assertEqual(len(list(self.out.glob("store/batches/*/batch.json"))), 1)

    def test_watching_shows_a_line_and_a_page_until_nothing_runs(self) -> None:
        file = self.write('title = "<b>"\n' + LONG)
        page = self.out / "campaigns/grid/watch.html"
        for how, code in ((signal.SIGTERM, 1), (None, 0)):
            running = subprocess.Popen(
                [PROGRAM, "campaign", "run", file, "--out", self.out, "--threads", "1"],
                cwd=ROOT,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
            done = len(self.result_lines())
            while len(self.result_lines()) == done:
                time.sleep(0.01)
            watching = subprocess.Popen(
                [PROGRAM, "campaign", "watch", file, "--out", self.out],
                cwd=ROOT,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
            )
            while not page.exists() or 'http-equiv="refresh"' not in page.read_text():
                self.assertIsNone(watching.poll())
                time.sleep(0.01)
            self.assertRegex(page.read_text(), r"&lt;b&gt;: \d+ of 12|\d+ of 12: &lt;b&gt;")
            if how:
                running.send_signal(how)
            said, line = watching.communicate()
            running.wait()
            self.assertEqual(watching.returncode, code, said)
            self.assertRegex(line, r"^grid: \d+ of 12 done, \d+ running")
            self.assertNotIn("refresh", page.read_text())
        self.assertIn("12 of 12 done", page.read_text())
        self.assertIn("12 jobs, 12 holds", said)

    def test_two_campaigns_at_once_share_their_work(self) -> None:
        files = [
            self.write(LONG, "one"),
            self.write(LONG.replace("2e-3, count = 12", "2e-3, count = 23"), "two"),
        ]
        running = [
            subprocess.Popen(
                [PROGRAM, "campaign", "run", file, "--out", self.out, "--threads", "1"],
                cwd=ROOT,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
            for file in files
        ]
        self.assertEqual([process.wait() for process in running], [0, 0])
        keys = [line["result"] for line in self.result_lines()]
        self.assertEqual(len(keys), len(set(keys)))

    def test_wrong_input_is_refused_in_a_line(self) -> None:
        for text, said in {
            'case = "hinge"\n[grid]\na = 1\n': "grid.campaign.toml:3: 'a' needs a list",
            'case = "hinges"\n': "did you mean",
            'run = "dance"\n': "is no command of a campaign",
            '[grid]\n"time.end" = [1]\n': "needs the key 'case'",
        }.items():
            done = self.campaign("run", self.write(text))
            self.assertEqual(done.returncode, 2, text)
            self.assertIn(said, done.stderr)
            self.assertEqual(done.stderr.count("\n"), 1)
        self.assertIn(
            "--on pigeon: no such engine",
            self.campaign("run", self.write(GRID), "--on", "pigeon").stderr,
        )
        self.assertEqual(self.campaign("work", str(self.path), "--slice", "0").returncode, 2)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--program"]:
        del sys.argv[1]  # its file is taken out above
    unittest.main()
