#!/usr/bin/python3
"""Tests of `foldproof ablate`: what a scene needs, its own error from finer and
coarser meshes, results that stay.

scripts/tests/test_ablate.py [AblateTest.test_...]
"""

import json
import subprocess
import unittest

from program_case import ROOT, ProgramCase, run, run_until

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


class AblateTest(ProgramCase):
    def ablate(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        return run("ablate", *arguments, "--out", self.out)

    def read_answer(self) -> list[dict]:
        return json.loads((self.path / "out" / "ablation.json").read_text())["cases"]

    def test_it_says_what_a_scene_needs(self) -> None:
        text = (ROOT / "cases" / "incline.toml").read_text()
        undeclared = self.write("undeclared.toml", text.split("[ablation]")[0])
        self.assertEqual(self.ablate(undeclared, "--set", "time.end=0.2").returncode, 1)
        self.assert_holds(self.ablate("incline", "--set", "time.end=0.2"))
        answer, *others = self.read_answer()
        # what is not asked again stays
        self.assertEqual([row["case"] for row in others], ["undeclared"])
        self.assertEqual(answer["overrides"], ["time.end=0.2"])
        need = {part["name"]: part["need"] for part in answer["parts"]}
        self.assertEqual(need["friction of objects"], "needed")
        self.assertEqual(need["object 'slope'"], "needed")
        self.assertEqual(need["self-collision"], "no effect if added")
        stopped = self.ablate("incline", "--set", "time.max_steps=3")
        self.assertEqual(stopped.returncode, 1, stopped.stderr)
        self.assertIn("! the scene itself stops early: the cap on the number of steps",
                      stopped.stdout)

    def test_a_coarser_mesh_says_the_error_that_a_finer_one_says(self) -> None:
        disc = self.write("disc.toml", DISC)
        self.ablate(disc)
        coarser = self.read_answer()[0]["own_error"]
        done = self.ablate(disc, "--set", 'ablation.coarser_mesh=""')
        finer = self.read_answer()[0]["own_error"]
        self.assertEqual((coarser["coarser_mesh"], finer["coarser_mesh"]), (["cloth.rings=4"], []))
        self.assertRegex(done.stdout,
                         r"own error \d.*\n  its steps: \d.*\n  its mesh: \d.*2 meshes")
        self.assertEqual(coarser["time"], finer["time"])
        # both hold an error e: of second order halving shows 3 e / 4 and 2.5 times the size e, of
        # first order e / 2 and e / 3.5
        for one, other in ((coarser, finer), (finer, coarser)):
            self.assertGreater(one["mesh"], other["mesh_without_bar"])

    def test_its_own_error_of_three_meshes_is_that_of_converge(self) -> None:
        disc = self.write("disc.toml", DISC.replace("rings = 10", "rings = 3"))
        finer = ("--set", 'ablation.coarser_mesh=""')
        told = self.told("converge", disc, *finer, "--in", "space", "--levels", "3", "--out",
                         self.out)
        self.ablate(disc, *finer, "--mesh-levels", "3")
        own = self.read_answer()[0]["own_error"]
        self.assertEqual(own["mesh"], told["quantities"][0]["error_as_it_is"])
        self.ablate(disc, *finer)
        two = self.read_answer()[0]["own_error"]
        self.assertEqual((two["mesh_levels"], own["mesh_levels"]), (2, 3))
        self.assertAlmostEqual(two["mesh"], 4 * two["mesh_without_bar"])

    def test_its_own_error_in_time_is_that_of_converge(self) -> None:
        disc = self.write("disc.toml", DISC)
        told = self.told("converge", disc, "--levels", "3", "--out", self.out)
        before = self.read_labels()
        self.assertTrue([label for label in before if "steps divided by 4" in label])
        self.ablate(disc)
        self.assertEqual(self.read_answer()[0]["own_error"]["time"],
                         told["quantities"][0]["error_as_it_is"])
        # its three levels were there
        self.assertEqual([label for label in self.read_labels()[len(before):]
                          if "steps divided" in label], [])

    def read_labels(self) -> list[str]:
        """Of the runs that were begun."""
        shards = sorted((self.path / "out" / "store" / "shards").iterdir())
        rows = [json.loads(line) for file in shards for line in file.read_text().splitlines()]
        return [row["label"] for row in rows if "label" in row]

    def test_a_case_may_ask_of_its_beginning_only(self) -> None:
        disc = self.write("disc.toml", DISC)
        done = self.ablate(disc, "--set", "ablation.until=0.04")
        self.assertTrue(done.stdout.startswith("disc (its first 0.04 s of 0.1): "), done.stdout)
        begun = self.read_answer()[0]
        self.assertEqual((begun["asked_end"], begun["end"]), (0.04, 0.1))
        self.ablate(disc, "--set", "time.end=0.04", "--set", "ablation.until=7")
        short = self.read_answer()[0]
        self.assertEqual((short["asked_end"], short["end"]), (0.04, 0.04))
        self.assertEqual(*([part["position_difference"] for part in one["parts"]]
                           for one in (begun, short)))

    def test_what_cannot_be_is_refused(self) -> None:
        disc = self.write("disc.toml", DISC)
        for setting, said in (
            ('wind="it blows"', "[ablation] names a part 'wind' that cannot be toggled; known: "),
            ('coarser_mesh="cloth.rings=9"', "disc.toml: [ablation] coarser_mesh: 486 triangles of"
                                             " 600; give one with sides at least 1.2 times"),
            ('coarser_mesh="cloth.ring=4"', "unknown key 'ring'"),
            ("coarser_mesh=4", "must be a text"), ("until=0", "must be > 0 s"),
            ('coarser_mesh=["cloth.rings=4", "cloth.radius=0.2"]',
             "give a mesh of the same surface"),
            ('coarser_mesh="cloth.mesh=/etc/passwd"', "is not table.key=number"),
            ('coarser_mesh="cloth.rings"', "is not table.key=number"),
            ('coarser_mesh="cloth.rings="', "is not table.key=number"),
            ('finer mesh="a trial"', "does without a finer mesh, and names a coarser one")
        ):
            self.assert_refused(self.ablate(disc, "--set", f"ablation.{setting}"), said)
        (self.path / "out" / "ablation.json").mkdir(parents=True)
        self.assert_refused(self.ablate(disc), "ablation.json")

    def test_a_run_that_is_killed_leaves_the_cases_that_it_was_through_with(self) -> None:
        soon = self.write("soon.toml", DISC.replace("end = 0.1", "end = 0.02"))
        late = self.write("late.toml", DISC.replace("end = 0.1", "end = 1000"))
        found = self.path / "out" / "ablation.json"
        run_until(lambda _: found.is_file(), "ablate", soon, late, "--threads", "2", "--out",
                  self.out)
        self.assertEqual([row["case"] for row in self.read_answer()], ["soon"])


if __name__ == "__main__":
    unittest.main()
