#!/usr/bin/python3
"""Tests of `foldproof ablate`: what a scene needs, its own error from finer and
coarser meshes, results that stay.

scripts/tests/test_ablate.py [AblateTest.test_...]
"""

import json
import subprocess
import sys
import time
import unittest

sys.dont_write_bytecode = True

from file_tests import CLOCK, PROGRAM, ROOT, FileTest, run  # noqa: E402

DISC = """
[cloth]
shape = "disc"
radius = 0.3
rings = 10
density = 0.2
[gravity]
acceleration = [0, 0, -9]
[stretch]
stiffness = 60.0
[bending]
stiffness = 5e-3
[[hold]]
box = [[-0.001, -0.001, -1], [0.001, 0.001, 1]]
[time]
end = 0.1
frames_per_second = 30
[solver]
tolerance = 1e-8
[ablation]
coarser_mesh = "cloth.rings=4"
"""


class AblateTest(FileTest):
    def ablate(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        return run("ablate", *arguments, "--out", str(self.path / "out"))

    def read_answer(self) -> list[dict]:
        return json.loads((self.path / "out" / "ablation.json").read_text())["cases"]

    def test_it_says_what_a_scene_needs(self) -> None:
        case = ROOT / "cases" / "incline.toml"
        undeclared = self.write("undeclared.toml", case.read_text().split("[ablation]")[0])
        self.assertEqual(self.ablate(undeclared, "--set", "time.end=0.2").returncode, 1)
        done = self.ablate(str(case), "--set", "time.end=0.2")
        self.assertEqual(done.returncode, 0, done.stderr)
        read_answer, *others = self.read_answer()
        # what is not asked again stays
        self.assertEqual([row["case"] for row in others], ["undeclared"])
        self.assertEqual(read_answer["overrides"], ["time.end=0.2"])
        need = {part["name"]: part["need"] for part in read_answer["parts"]}
        self.assertEqual(need["friction of objects"], "needed")
        self.assertEqual(need["object 'slope'"], "needed")
        self.assertEqual(need["self-collision"], "no effect if added")
        stopped = self.ablate(str(case), "--set", "time.max_steps=3")
        self.assertEqual(stopped.returncode, 1, stopped.stderr)
        self.assertIn(
            "! the scene itself stops early: the cap on the number of steps",
            stopped.stdout,
        )

    def test_a_coarser_mesh_says_the_error_that_a_finer_one_says(self) -> None:
        disc = self.write("disc.toml", DISC)
        self.ablate(disc)
        coarser = self.read_answer()[0]["own_error"]
        done = self.ablate(disc, "--set", 'ablation.coarser_mesh=""')
        finer = self.read_answer()[0]["own_error"]
        self.assertEqual((coarser["coarser_mesh"], finer["coarser_mesh"]), (["cloth.rings=4"], []))
        self.assertRegex(
            done.stdout, r"own error \d.*\n  its steps: \d.*\n  its mesh: \d.*2 meshes"
        )
        self.assertEqual(coarser["time"], finer["time"])
        # both hold an error e: of second order halving shows 3 e / 4 and 2.5 times the size e, of
        # first order e / 2 and e / 3.5
        for one, other in ((coarser, finer), (finer, coarser)):
            self.assertGreater(one["mesh"], other["mesh_without_bar"])

    def test_its_own_error_of_three_meshes_is_that_of_converge(self) -> None:
        disc = self.write("disc.toml", DISC.replace("rings = 10", "rings = 3"))
        finer = ("--set", 'ablation.coarser_mesh=""')
        told = json.loads(
            run(
                "converge", disc, *finer, "--in", "space", "--levels", "3", "--json",
                "--out", str(self.path / "out")
            ).stdout
        )
        self.ablate(disc, *finer, "--mesh-levels", "3")
        own = self.read_answer()[0]["own_error"]
        self.assertEqual(own["mesh"], told["quantities"][0]["error_as_it_is"])
        self.ablate(disc, *finer)
        two = self.read_answer()[0]["own_error"]
        self.assertEqual((two["mesh_levels"], own["mesh_levels"]), (2, 3))
        self.assertAlmostEqual(two["mesh"], 4 * two["mesh_without_bar"])

    def test_its_own_error_in_time_is_that_of_converge(self) -> None:
        disc = self.write("disc.toml", DISC)
        out = str(self.path / "out")
        told = json.loads(
            run("converge", disc, "--levels", "3", "--json", "--out", out).stdout
        )
        before = self.read_labels()
        self.ablate(disc)
        self.assertEqual(
            self.read_answer()[0]["own_error"]["time"], told["quantities"][0]["error_as_it_is"]
        )
        # its three levels were there
        self.assertEqual(
            [label for label in self.read_labels()[len(before):] if "steps divided" in label], []
        )
        self.assertTrue([label for label in before if "steps divided by 4" in label])

    def read_labels(self) -> list[str]:
        """Of the runs that were begun."""
        return [
            row["label"]
            for file in sorted((self.path / "out" / "store" / "shards").iterdir())
            for row in map(json.loads, file.read_text().splitlines())
            if "label" in row
        ]

    def test_a_case_may_ask_of_its_beginning_only(self) -> None:
        disc = self.write("disc.toml", DISC)
        done = self.ablate(disc, "--set", "ablation.until=0.04")
        self.assertTrue(done.stdout.startswith("disc (its first 0.04 s of 0.1): "), done.stdout)
        begun = self.read_answer()[0]
        self.assertEqual((begun["asked_end"], begun["end"]), (0.04, 0.1))
        self.ablate(disc, "--set", "time.end=0.04", "--set", "ablation.until=7")
        short = self.read_answer()[0]
        self.assertEqual((short["asked_end"], short["end"]), (0.04, 0.04))
        self.assertEqual(
            [part["position_difference"] for part in begun["parts"]],
            [part["position_difference"] for part in short["parts"]],
        )

    def test_what_cannot_be_is_refused(self) -> None:
        disc = self.write("disc.toml", DISC)
        self.assert_rejected(
            self.ablate(disc, "--set", 'ablation.wind="it blows"'),
            "[ablation] names a part 'wind' that cannot be toggled; known: finer mesh, gravity",
        )
        self.assert_rejected(
            self.ablate(disc, "--set", 'ablation.coarser_mesh="cloth.rings=9"'),
            (
                "disc.toml: [ablation] coarser_mesh: 486 triangles of 600; give one with sides at"
                " least 1.2 times as long"
            ),
        )
        self.assert_rejected(
            self.ablate(disc, "--set", 'ablation.coarser_mesh="cloth.ring=4"'), "unknown key 'ring'"
        )
        self.assert_rejected(
            self.ablate(disc, "--set", "ablation.coarser_mesh=4"), "must be a text"
        )
        self.assert_rejected(self.ablate(disc, "--set", "ablation.until=0"), "must be > 0 s")
        self.assert_rejected(
            self.ablate(
                disc, "--set", 'ablation.coarser_mesh=["cloth.rings=4", "cloth.radius=0.2"]'
            ),
            "give a mesh of the same surface",
        )
        for reaching in ("cloth.mesh=/etc/passwd", "cloth.rings", "cloth.rings="):
            self.assert_rejected(
                self.ablate(disc, "--set", f'ablation.coarser_mesh="{reaching}"'),
                "is not table.key=number",
            )
        (self.path / "out" / "ablation.json").mkdir(parents=True)
        self.assert_rejected(self.ablate(disc), "ablation.json")
        self.assert_rejected(
            self.ablate(disc, "--set", 'ablation.finer mesh="a trial"'),
            "does without a finer mesh, and names a coarser one",
        )

    def test_a_run_that_is_killed_leaves_the_cases_that_it_was_through_with(self) -> None:
        soon = self.write("soon.toml", DISC.replace("end = 0.1", "end = 0.02"))
        late = self.write("late.toml", DISC.replace("end = 0.1", "end = 1000"))
        found = self.path / "out" / "ablation.json"
        running = subprocess.Popen(
            [str(PROGRAM), "ablate", soon, late, "--threads", "2", "--out", str(found.parent)],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        end = time.monotonic() + CLOCK
        try:
            while not found.is_file() and running.poll() is None and time.monotonic() < end:
                time.sleep(0.05)
        finally:
            running.kill()
            running.wait()
        self.assertEqual([row["case"] for row in self.read_answer()], ["soon"])


if __name__ == "__main__":
    unittest.main()
