#!/usr/bin/python3
"""Tests of the program as a user meets it: words, exit codes, messages, checks, claims.

scripts/tests/test_program.py [--program FILE] [ProgramTest.test_...]
--program: instead of build/foldproof
"""

import json
import re
import subprocess
import unittest

import h5py

from program_case import PROGRAM, ROOT, ProgramCase, run, run_until

SECONDS = ("solver.cached-terms-save-time",)  # checks that measure time, and so never the same


class ProgramTest(ProgramCase):
    def test_what_is_listed_can_be_asked_for_by_name(self) -> None:
        shown = json.loads(run("list", "--json").stdout)
        self.assertEqual([row["name"] for row in shown["integrators"]][:3], ["A", "B", "C"])
        name = "case.sharp_fold.folds-back-to"  # an expectation of a shipped case
        self.assertIn(name, shown["case_findings"])
        done = run("check", name)
        self.assert_holds(done)
        self.assertRegex(done.stdout, rf"holds +{re.escape(name)}")

    def test_claims_are_ruled_by_the_findings_that_a_run_has(self) -> None:
        out = ("--out", self.out)
        self.assertEqual(run("claims", *out).returncode, 2)
        self.assert_holds(run("check", "dynamics.solves-are-counted",
                              "bending.mode-is-minus-gradient-of-theta", *out))
        shown = run("claims", *out)
        self.assertEqual([line.split()[:2] for line in shown.stdout.splitlines()],
                         [["T19", "confirmed"], ["B10", "refuted"]])
        one = run("claims", "B10", *out)
        self.assertRegex(
            one.stdout, r"contradicts +holds +bending\.mode-is-minus-gradient-of-theta +\S+ <= 32")
        self.assertNotIn("{", one.stdout)
        self.assertEqual(self.told("claims", "T19", *out)[0]["ruling"], "confirmed")
        self.assertIn("no claim 'T99'", run("claims", "T99", *out).stderr)
        with h5py.File(self.path / "out/run.h5") as file:
            self.assertEqual(file["claims/B10"].attrs["ruling"], "refuted")
            self.assertEqual(list(file["claims/B10"].attrs["roles"].astype(str)), ["contradicts"])

    def test_checks_measure_the_same_on_any_number_of_threads_and_in_any_order(self) -> None:
        def measure(*how: str) -> dict[str, tuple[float, float, float]]:
            return {row["name"]: (row["measured"], row["uncertainty"], row["bound"])
                    for row in self.told("check", *how)["findings"]
                    if row["kind"] == "check" and row["name"] not in SECONDS}

        alone = measure("--threads", "1")
        self.assertGreater(len(alone), 300)
        self.assertEqual(alone, measure("--threads", "2", "--order", "1"))

    def test_a_shift_of_seeds_gives_other_samples_and_results_are_written(self) -> None:
        name = "bending.forces-sum-to-zero"
        told = [self.told("check", name, "--seed", seed, "--out", self.out) for seed in "07"]
        self.assertEqual([one["program"]["seed"] for one in told], [0, 7])
        self.assertNotEqual(*(one["findings"][0]["measured"] for one in told))
        self.assertEqual(told[1]["findings"][0]["outcome"], "holds")
        self.assertTrue(told[1]["findings"][0]["faults"])
        with h5py.File(self.path / "out/run.h5") as file:
            self.assertEqual(file.attrs["seed"], 7)
            self.assertEqual(file[f"findings/{name}"].attrs["outcome"], "holds")
        self.assertIn("testcase", (self.path / "out/junit.xml").read_text())

    def test_study_runs_studies_only(self) -> None:
        self.assertIn("names checks or cases, and no study; type `foldproof check bending.torques",
                      self.assert_rejected("study", "bending.torques-sum-to-zero"))

    def test_the_shell_completes_commands_names_options_and_files(self) -> None:
        def complete(*words: str) -> list[str]:
            lines = [
                "source scripts/completion.bash",
                f"COMP_WORDS=({' '.join(map(repr, (str(PROGRAM), *words)))})",
                f"COMP_CWORD={len(words)}", "_foldproof", 'printf "%s\\n" "${COMPREPLY[@]}"'
            ]
            return subprocess.run(["bash", "-c", "\n".join(lines)], cwd=ROOT, capture_output=True,
                                  text=True, check=True).stdout.split()

        for words, completed in {
            "abl": ["ablate"], "check bending.torq": ["bending.torques-sum-to-zero"],
            "check case.tw": ["case.twist"], "simulate --res": ["--restart", "--resume"],
            "simulate cases/garm": ["cases/garment.toml"], "simulate garm": ["garment"],
            "ablate hard/tw": ["hard/twist"], "inspect cas": ["cases/"], "golden fri": ["friction"],
            "campaign sta": ["status"], "judge --sol": ["--solver"],
            "judge --solver cmd tunn": ["tunnelling", "tunnelling.thin-box-stops-a-slow-sheet"]
        }.items():
            self.assertEqual(complete(*words.split()), completed)
        self.assertIn("time-order", complete("study", "time"))
        self.assertNotIn("bending", complete("study", "bend"))

    def test_an_unknown_check_is_refused_with_neighbours(self) -> None:
        for typed, meant in (
            ("bending.forces-sum-to-zer", "bending.forces-sum-to-zero"), ("bendnig", "bending"),
            ("case.twsit", "case.twist"), ("robes", "case.robe"), ("monotonicty", "monotonicity")
        ):
            self.assertIn(meant, self.assert_rejected("check", typed))

    def test_a_mistyped_word_is_named_with_what_may_be_meant(self) -> None:
        sheet = "and no shipped case of that name; did you mean hanging_sheet?"
        for typed, said in {
            "simualte cases/hinge.toml": "unknown command 'simualte'; did you mean simulate?",
            "frobnicate": "known: ablate, bench,",
            "evaluate bendig": "did you mean bending?",
            "evaluate": "a command is missing, one of bending, crossings",
            "": "a command is missing, one of ablate,",
            "simulate hinge.toml --resum": "unknown option '--resum'; did you mean --resume?",
            "export run.h5 --fromat obj --out f": "did you mean --format?",
            "list checks now": "unexpected word 'now'; usage: foldproof list",
            "golden sprigns": "did you mean springs?",
            "simulate hangin_sheet": sheet,
            "ablate cases/hanging_shet.toml": sheet,
            "converge hnige": "did you mean hinge?",
            "simulate twist": "did you mean hard/twist?",
            "simulate nowhere/at_all_like.toml": "list cases` shows the shipped ones",
            "simulate nofile.toml": "no shipped case of that name; `",
            "campaign run first_gird": "no shipped campaign of that name; did you mean first_grid?",
            "campaign run nothing_like_it": "; shipped: bending_atlas, faults, first_grid,",
            "history none": "none: there is no such folder or file",
            "report none": "none: there is no such folder",
            "inspect nowhere/at_all_like.obj": "there is no such file; check the path",
        }.items():
            self.assertIn(said, self.assert_rejected(*typed.split()), typed)
        self.write("flag.csv", "1,2")
        self.assertIn("did you mean flag.csv?",
                      self.assert_rejected("evaluate", "bending", "flg.csv"))

    def test_a_box_that_holds_one_particle_is_warned_of(self) -> None:
        case = (ROOT / "cases/hanging_sheet.toml").read_text(encoding="utf-8")
        for far, said in ((0.01, "box.toml:25: [[hold]] holds one particle only"), (0.5, "")):
            box = f"[[-9, -9, -{far}], [{far}, 9, 9]]"
            file = self.write("box.toml", case.replace("particles = [0, 24]", f"box = {box}"))
            done = self.simulate(file, "--set", "time.end=1e-4")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual("warning: " in done.stderr, bool(said))
            self.assertIn(said, done.stderr)

    def test_wrong_input_is_refused_in_a_line_and_leaves_nothing(self) -> None:
        for name in ("empty.toml", "empty.obj", "empty.h5", "empty.csv"):
            self.write(name, "")
        self.write("notes.txt", "hello")
        self.write("hinge.toml", (ROOT / "cases/hinge.toml").read_text())
        for typed, said in {
            "simulate": "CASE is missing; usage: foldproof simulate CASE",
            "simulate empty.toml": "empty.toml: is empty; give a case file",
            "simulate empty.h5": "is a stored run by its name; give a case file",
            "simulate .": "is a folder; give a case file",
            "simulate hinge.toml --set": "--set needs a value: --set TABLE.KEY=VALUE",
            "simulate hinge.toml --set time.end=abc": "'end' in [time] must be a finite number",
            "simulate hinge.toml --set time.edn=1": "known here: end,",
            "simulate hinge.toml --out --json": "--out: a value is missing",
            "simulate hinge.toml --out notes.txt": "notes.txt: cannot make this folder: Not a",
            "simulate hinge.toml --out new/a/b --set bending.stiffness=x": "must be a finite",
            "simulate hinge.toml --json=3": "--json takes no value",
            "simulate hinge.toml --cache": "--cache needs a value: --cache DIR",
            "converge hinge --levels 2": "'2' is not a whole number from 3 to 12",
            "converge hinge --until -1": "'-1' is not a number above 0",
            "precision hinge --method A,D": "unknown integrator 'D'; known: A, B,",
            "precision hinge --methods A": "unknown option '--methods'; did you mean --method?",
            "precision hinge --errors 0": "'0' is not a number above 0",
            "precision hinge --effort x": "'x' is not a number above 0",
            "converge hinge --out notes.txt": "notes.txt: cannot make this folder",
            "check bending --seed x": "'x' is not a whole number from 0 to 1000000000",
            "check bending --tier fast": "'fast' is not one of quick, full",
            "check bending --out notes.txt": "notes.txt: cannot make this folder",
            "bench --out notes.txt": "notes.txt: cannot make this folder",
            "report": "DIR is missing; usage: foldproof report DIR... [OPTIONS]",
            "film empty.h5": "is empty; give a stored run",
            "film notes.txt --size axb": "'axb' is not WIDTHxHEIGHT",
            "film notes.txt --fps many": "'many' is not a whole number from 1 to 120",
            "export notes.txt --format obj --out new": "notes.txt",
            "export notes.txt --format --out new": "--format: a value is missing; give one of obj",
            "inspect empty.obj": "is empty; give a mesh",
            "inspect empty.obj --cells 1": "'1' is not a whole number from 4 to 1000",
            "crossings empty.obj empty.h5": "is empty",
            "golden springs --count 1.5": "'1.5' is not a whole number",
            "evaluate bending empty.csv": "is empty; give a table of numbers",
            "evaluate crossings empty.csv --keep x": "'x' is not a finite number",
            "project empty.h5 --map blend": "--tau is missing; usage: foldproof project RUN.h5",
            "project empty.h5 --map blend --tau nan": "'nan' is not a finite number",
        }.items():
            self.assertIn(said, self.assert_rejected(*typed.split()), typed)

    def test_a_command_shows_its_own_help(self) -> None:
        def commands_in(*words: str) -> list[list[str]]:
            text = run(*words, "--help").stdout.partition("\nCommands:\n")[2].partition("\n\n")[0]
            return [[*words, name] for name in re.findall(r"^  ([a-z]+) ", text, re.M)]

        self.assertIn("Examples:", run("--help").stdout)
        commands = commands_in() + commands_in("evaluate") + commands_in("campaign")
        self.assertGreater(len(commands), 30)
        for command in commands:
            text = run(*command, "--help").stdout
            self.assertNotRegex(text, r"\b(TEXT|U?INT|FLOAT|REQUIRED)\b|\(\dx\)", command)
            self.assertLessEqual(max(map(len, text.splitlines())), 100, command)
            self.assertIn("\nExit codes:\n  0 ", text)
            examples = re.findall(r"^  foldproof (.*)", text.partition("\nExamples:\n")[2], re.M)
            self.assertIn(len(examples), (1, 2), command)
            for words in (example.split("   ")[0].split() for example in examples):
                if command != ["serve"]:  # that one is started by another command
                    self.assertEqual(words[:len(command)], command)
                for word in words:
                    self.assertTrue(not word.startswith("cases/") or (ROOT / word).is_file(), word)
                    self.assertTrue(not word.startswith("--") or f"{word} " in text, word)
        self.assertEqual(run("check", "--seed", "x", "--help").returncode, 0)

    def test_a_run_that_is_killed_leaves_no_verdict(self) -> None:
        out = self.path / "out"
        run_until(lambda _: (out / "junit.xml").is_file(), "verify", "--no-report", "--no-bench",
                  "--out", out)
        findings = json.loads((out / "verdicts.json").read_text())["findings"]
        self.assertEqual({finding["outcome"] for finding in findings}, {"did not run"})
        self.assertRegex((out / "junit.xml").read_text(), r'errors="[1-9][0-9]*"')


if __name__ == "__main__":
    unittest.main()
