#!/usr/bin/python3
"""Tests of `foldproof converge`: what it answers, what it keeps, what
it runs again, what it refuses.

scripts/tests/test_converge.py [ConvergeTest.test_...]
"""

import json
import math
import subprocess
import unittest
from typing import Any

from program_case import SHEET, ProgramCase, run, run_until

DROOP = """
[cloth]
shape = "sheet"
width = 0.2
height = 0.2
columns = 4
rows = 4
density = 0.2
turn = { axis = [1, 0, 0], angle = -60 }
[gravity]
[stretch]
stiffness = 20.0
damping = 0.2
[bending]
stiffness = 2e-3
[[hold]]
box = [[-1, 0.0999, -1], [1, 1, 1]]
[solver]
tolerance = 1e-10
[time]
end = 0.3
frames_per_second = 50
"""


class ConvergeTest(ProgramCase):
    def converge(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        return run("converge", *arguments, "--out", self.out)

    def answer(self, *arguments: str) -> dict[str, Any]:
        """The answer in time."""
        said = self.told("converge", *arguments, "--out", self.out)
        del said["program"]  # with the date
        return said

    def lines(self, kind: str) -> list[dict[str, Any]]:
        """Lines of the store of this kind, "start" or "result", of the ladder's levels."""
        found = []
        for shard in sorted((self.path / "out" / "store" / "shards").glob("*.jsonl")):
            for line in shard.read_text().splitlines():
                try:
                    found.append(json.loads(line))
                except json.JSONDecodeError:  # torn
                    continue
        levels = {line["start"] for line in found if "steps divided" in line.get("label", "")}
        return [line for line in found if line.get(kind) in levels]

    def test_a_smooth_case_has_the_order_of_its_method(self) -> None:
        answer = self.answer(self.write("sheet.toml", SHEET))
        self.assertEqual(len(answer["mean_step"]), 4)
        for quantity in answer["quantities"]:
            self.assertEqual(quantity["reading"], "asymptotic", quantity)
            self.assertAlmostEqual(quantity["order"], 2, delta=0.2)
            self.assertGreater(quantity["error_as_it_is"], quantity["error_bar"])
        self.assertEqual([quantity["name"] for quantity in answer["quantities"]],
                         ["positions", "lowest", "swing"])

    def test_a_bar_holds_what_two_finer_levels_say(self) -> None:
        sheet = self.write("sheet.toml", SHEET)
        coarse, fine = self.answer(sheet, "--levels", "4"), self.answer(sheet, "--levels", "6")
        for before, after in list(zip(coarse["quantities"], fine["quantities"]))[1:]:
            self.assertEqual(before["values"], after["values"][:4])
            self.assertLess(abs(before["values"][-1] - after["limit"]), before["error_bar"])
            self.assertLess(after["error_bar"], before["error_bar"] / 8)

    def test_a_second_call_runs_only_what_is_missing(self) -> None:
        sheet = self.write("sheet.toml", SHEET)
        first = self.answer(sheet, "--levels", "3")
        self.assertEqual((len(self.lines("start")), len(self.lines("result"))), (3, 3))
        self.assertEqual(self.answer(sheet, "--levels", "3"), first)
        self.assertEqual(len(self.lines("start")), 3)
        for words, starts in ((("--levels", "4"), 4),
                              (("--set", "gravity.acceleration=[0,-9.8,0]", "--levels", "3"), 7),
                              (("--method", "BDF2", "--levels", "3"), 10)):
            self.answer(sheet, *words)
            self.assertEqual(len(self.lines("start")), starts)
        for arrays in (self.path / "out" / "store" / "arrays").rglob("*.h5"):
            arrays.write_bytes(b"damaged")
        self.assertEqual(self.answer(sheet, "--levels", "3")["quantities"], first["quantities"])
        self.assertEqual(len(self.lines("start")), 13)

    def test_a_killed_call_goes_on_with_the_runs_that_it_had_ended(self) -> None:
        sheet = self.write("sheet.toml", SHEET.replace("columns = 6", "columns = 24")
                           .replace("rows = 4", "rows = 16"))
        run_until(lambda _: len(self.lines("result")) >= 2, "converge", sheet, "--levels", "7",
                  "--threads", "1", "--out", self.out)
        ended = {line["result"] for line in self.lines("result")}
        self.assertGreaterEqual(len(ended), 2)
        self.assertLess(len(ended), 7)
        self.answer(sheet, "--levels", "4")
        started = [line["start"] for line in self.lines("start")]
        for key in ended:
            self.assertEqual(started.count(key), 1)
        self.assertGreaterEqual(len({line["result"] for line in self.lines("result")}), 4)

    def test_levels_that_take_too_long_are_refused_with_the_numbers(self) -> None:
        sheet = self.write("sheet.toml", SHEET)
        done = self.converge(sheet, "--hours", "1e-9")
        self.assert_refused(done, "an error bar needs three levels, and level 3 of 4 would take ",
                            "--hours allows 3.6e-06 s")
        larger = self.write("larger.toml", SHEET.replace("columns = 6", "columns = 12")
                            .replace("rows = 4", "rows = 8"))
        second = self.answer(larger, "--levels", "3")["seconds"][1]
        # twelve levels are 2047 times the second; this is enough for nine
        done = self.converge(larger, "--levels", "12", "--threads", "1", "--hours",
                             f"{500 * second / 3600:.6g}", "--json")
        self.assertIn(done.returncode, (0, 1), done.stderr)
        self.assertRegex(done.stderr, r"level \d+ of 12 would take [^;]*; --hours allows ")
        values = json.loads(done.stdout)["quantities"][1]["values"]
        self.assertTrue(3 <= len(values) < 12, values)

    def test_what_a_map_foresees_of_a_finer_mesh_comes_true(self) -> None:
        droop = self.write("droop.toml", DROOP)
        coarse, fine = (self.answer(droop, "--in", "both", "--levels", levels)["ladders"][1]
                        for levels in "34")
        law, after = coarse["map"], fine["map"]
        self.assertEqual((law["because"], after["because"]), ("", ""))
        h, edge = fine["mean_step_of_finest"] / law["step"], fine["mean_edge"][-1] / law["edge"]
        work = law["work"] * h ** -law["work_by_step"] * edge ** -law["work_by_edge"]
        measured = fine["work"][-1] * fine["particles"][-1]
        # a cost that grows as between coarser meshes is right to a factor of two
        self.assertLess(abs(math.log2(work / measured)), 1)
        particles = law["particles"] * edge ** -law["particles_by_edge"]
        self.assertAlmostEqual(particles / fine["particles"][-1], 1, delta=0.1)
        foreseen = law["mesh_error"]["as_it_is"] * edge ** law["mesh_error"]["order"]
        found = after["mesh_error"]["as_it_is"] * edge ** after["mesh_error"]["order"]
        # orders apart by 0.1 over three halvings: a factor of 1.23
        self.assertAlmostEqual(foreseen / found, 1, delta=0.3)
        for pair in law["cheapest"]:
            longest = (pair["edge"] / law["edge"]) ** law["longest_step_by_edge"]
            self.assertLessEqual(pair["step"], law["step"] * longest * (1 + 1e-9))
        self.assertEqual([pair["error"] for pair in law["cheapest"]], [1e-2, 1e-3])

    def test_wrong_input_is_one_line(self) -> None:
        sheet = self.write("sheet.toml", SHEET)
        for words, said in (
            ("--levels 2", "'2' is not a whole number from 3 to 12"),
            ("--hours 0", "'0' is not a number above 0"),
            ("--set quantity.0.what=heigth", "unknown quantity 'heigth'"),
            ("--set quantity.1.name=lowest", "two quantities are called 'lowest'"),
            ("--set time.max_steps=3", "comes to no end"), ("--method Z", "unknown integrator 'Z'")
        ):
            self.assert_refused(self.converge(sheet, *words.split()), said)
        self.assert_refused(
            run("converge", sheet, "--out", self.write("new/store", "").removesuffix("/store")),
            "store: results are kept in a folder, and this is none")


class OrdersTest(ProgramCase):
    """Shipped cases without contact have the formal order of each method, by their last three of
    five levels."""

    FORMAL = {"A": 2, "B": 2, "C": 2, "BDF2": 2, "backward-euler": 1}
    # s: all runs take half a minute
    ENDS = {"hinge": "0.3", "rest_fold": "0.05", "hanging_sheet": "0.05"}

    def test_positions_of_three_cases_have_the_order_of_each_method(self) -> None:
        for case, end in self.ENDS.items():
            # solves end a long way below the finest differences
            ladders = self.told("converge", case, "--levels", "5", "--method",
                                ",".join(self.FORMAL), "--until", end, "--set",
                                "solver.tolerance=1e-12", "--out", self.out, codes=(0,))["ladders"]
            self.assertEqual([ladder["method"] for ladder in ladders], list(self.FORMAL))
            for ladder in ladders:
                with self.subTest(case=case, method=ladder["method"]):
                    positions = ladder["quantities"][0]
                    self.assertEqual((positions["name"], positions["reading"]),
                                     ("positions", "asymptotic"))
                    self.assertAlmostEqual(positions["order"], self.FORMAL[ladder["method"]],
                                           delta=0.1)


if __name__ == "__main__":
    unittest.main()
