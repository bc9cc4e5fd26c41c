"""Tests of what other programs get: a run in numpy, the schema of
verdicts.json. Run by test_reports.py."""
from __future__ import annotations

import copy
import doctest
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
from collections.abc import Callable
from io import StringIO
from pathlib import Path

import h5py
import jsonschema
import numpy as np

from data.results import Column, load_case, load_run
from data.unreadable import Unreadable
from foldproof_results import (
    columns_of_study, evidence_of, findings_table, load_results, load_trajectory
)
from tests.made_up_run import NAMES, made_up_verdicts, put_run
from tests.report_test import REPORTS, FolderTest


class ResultsInNumpy(FolderTest):
    """The interface of foldproof_results.py for other programs."""

    def setUp(self) -> None:
        super().setUp()
        (self.root / "results").mkdir()
        put_run(self.root / "results")

    def test_the_readme_says_what_happens(self) -> None:
        text = (REPORTS / "DATA.md").read_text(encoding="utf-8")
        example = doctest.DocTestParser().get_doctest(text, {}, "DATA.md", None, None)
        self.assertGreater(len(example.examples), 10)
        before, told = os.getcwd(), StringIO()
        os.chdir(self.root)
        try:
            failed = doctest.DocTestRunner().run(example, out=told.write).failed
        finally:
            os.chdir(before)
        self.assertEqual(failed, 0, told.getvalue())

    def test_findings_and_studies_are_those_that_the_report_reads(self) -> None:
        run, read = load_results(self.root / "results"), load_run(self.root / "results" / "run.h5")
        self.assertEqual(list(run.findings), [finding.name for finding in read.findings])
        self.assertEqual(list(evidence_of(run.findings[NAMES[0]])), ["angle", "mesh"])
        columns = columns_of_study(run.studies["time-order"])["x"]
        curve = read.studies[0].figures[0].curves[1]
        self.assertEqual(
            [name.rpartition(": ")[2] for name in columns],
            ["x", "y", "order", "x", "y", "order", "mark"],
        )
        np.testing.assert_array_equal(columns[f"{curve.label}: y"].values, curve.y)
        self.assertEqual(
            {column.unit for name, column in columns.items() if name.endswith(": y")}, {"m"}
        )

    def test_two_columns_of_one_name_are_both_there(self) -> None:
        finding = load_results(self.root / "results").findings[NAMES[0]]
        finding.evidence = [Column("step", "s", np.zeros(1)), Column("step", "s", np.ones(1))]
        self.assertEqual([column.values[0] for column in evidence_of(finding).values()], [0.0, 1.0])

    def test_a_trajectory_is_that_of_its_frames(self) -> None:
        path = self.root / "results" / "fold.h5"
        sheet, case = load_trajectory(path), load_case(path)
        for frame in range(4):
            np.testing.assert_array_equal(sheet.positions[frame], case.positions(frame))
        self.assertIsNone(sheet.velocities)
        with h5py.File(path, "r+") as file:
            file["frames/velocities"] = 2 * file["frames/positions"][:]
            file["frames/object_distance"] = np.ones((4, 4))
            file["mesh/mass"] = np.arange(4.0)
        full = load_trajectory(path)
        np.testing.assert_array_equal(full.velocities, 2 * sheet.positions)
        np.testing.assert_array_equal(full.distances, np.ones((4, 4)))
        np.testing.assert_array_equal(full.masses, np.arange(4.0))
        self.assertEqual(list(full.objects), [one.name for one in case.objects])

    def test_findings_are_columns_of_one_length(self) -> None:
        findings = load_results(self.root / "results").findings
        table = findings_table(findings)
        self.assertEqual({len(column) for column in table.values()}, {len(findings)})
        self.assertEqual(list(table["name"]), [finding.name for finding in findings.values()])
        self.assertEqual(table["bound"].dtype, float)

    def assert_rejected(self, load: Callable[[Path], object], name: str, why: str) -> None:
        """The file must be refused, in words that name it and say why."""
        with self.assertRaises(Unreadable) as raised:
            load(self.root / "results" / name)
        self.assertIn(name, str(raised.exception))
        self.assertIn(why, str(raised.exception))

    def test_a_file_that_is_not_there_or_not_ours_is_refused_by_name(self) -> None:
        root = self.root / "results"
        (root / "text.h5").write_text("no HDF5")
        with h5py.File(root / "other.h5", "w") as file:
            file["frames/time"] = [0.0]
        for load, own, others in (
            (load_results, "run", ("other.h5", "fold.h5")),
            (load_trajectory, "simulation", ("other.h5", "run.h5")),
        ):
            self.assert_rejected(load, "nowhere.h5", "there is no such file")
            self.assert_rejected(load, "text.h5", "no HDF5 file")
            for other in others:
                self.assert_rejected(load, other, f"no {own} of foldproof")
        with self.assertRaisesRegex(KeyError, "no case 'cape' in this run; it has: fold, gone"):
            load_results(root).trajectory("cape")

    def test_numbers_that_do_not_fit_together_are_refused(self) -> None:
        with h5py.File(self.root / "results" / "fold.h5", "r+") as file:
            file["mesh/triangles"][0] = [0, 1, 4]
        self.assert_rejected(load_trajectory, "fold.h5", "names a particle")
        with h5py.File(self.root / "results" / "fold.h5", "r+") as file:
            del file["frames/time"]
            file["frames/time"] = np.arange(5.0)
        self.assert_rejected(load_trajectory, "fold.h5", "5 frames of 4 particles")


class VerdictsSchema(unittest.TestCase):
    """verdicts.schema.json against files, and against the code that writes them."""

    def setUp(self) -> None:
        self.schema = json.loads((REPORTS / "verdicts.schema.json").read_text(encoding="utf-8"))
        jsonschema.Draft202012Validator.check_schema(self.schema)
        self.validator = jsonschema.Draft202012Validator(self.schema)
        self.verdicts = made_up_verdicts()

    def test_a_file_with_every_outcome_is_valid(self) -> None:
        self.assertEqual([error.message for error in self.validator.iter_errors(self.verdicts)], [])

    def test_the_example_of_the_readme_validates_and_tells(self) -> None:
        blocks = re.findall(
            r"```python\n(.*?)```", (REPORTS / "DATA.md").read_text(encoding="utf-8"), re.S
        )
        example = next(block for block in blocks if "jsonschema" in block)
        with tempfile.TemporaryDirectory() as folder:
            os.symlink(REPORTS, Path(folder) / "reports")
            (Path(folder) / "results").mkdir()
            (Path(folder) / "results" / "verdicts.json").write_text(json.dumps(self.verdicts))
            told = subprocess.run(
                [sys.executable, "-c", example], cwd=folder, capture_output=True, text=True,
                check=True
            )
        self.assertEqual(told.stdout, "['b', 'c', 'd', 'e', 'f', 'claim.T2']\n")

    def test_a_broken_file_is_not(self) -> None:
        a, b, claim = 0, 1, 6  # of made_up_verdicts
        broken = [
            ("findings", a, "outcome", "hold"), ("findings", a, "measured", None),
            ("findings", a, "unit", 1), ("findings", a, "measured", "3.2e-15"),
            ("findings", b, "seconds", -1), ("findings", a, "faults", "x"),
            ("findings", a, "kind", "claim"), ("findings", claim, "kind", "check"),
            ("findings", a, "stray", ""), ("findings", claim, "ruling", "true"),
            ("findings", claim, "decided_by", []), ("schema", 2), ("program", "seed", -1),
            ("program", "name", "other"), ("program", "date", "yesterday"), ("findings", {})
        ]
        for *places, key, value in broken:
            with self.subTest(places=places, key=key, value=value):
                verdicts = copy.deepcopy(self.verdicts)
                inner = verdicts
                for place in places:
                    inner = inner[place]
                inner[key] = value
                self.assertFalse(self.validator.is_valid(verdicts))

    def test_nothing_that_is_required_may_be_missing(self) -> None:
        for k in (0, 6):  # a finding, a claim
            for key in self.verdicts["findings"][k]:
                verdicts = copy.deepcopy(self.verdicts)
                del verdicts["findings"][k][key]
                self.assertFalse(self.validator.is_valid(verdicts), key)

    def test_every_property_is_described(self) -> None:
        places = [self.schema]
        while places:
            place = places.pop()
            for key, inner in place.get("properties", {}).items():
                self.assertIn("description", inner, key)
            places += [
                value
                for key, value in place.items()
                if isinstance(value, dict) and key not in ("if", "then")
            ]

    def test_the_program_writes_what_the_schema_describes(self) -> None:
        text = (REPORTS.parent / "verification" / "files" / "verdicts_file.cpp").read_text(
            encoding="utf-8"
        )
        written = set(re.findall(r'(?:\{|json\["program"\]\[|row\[|json\[)"(\w+)"[,\]]', text))
        parts = self.schema["$defs"]
        decider = parts["claim"]["properties"]["decided_by"]["items"]
        described = set(self.schema["properties"]).union(
            *(part["properties"] for part in (*parts.values(), decider))
        )
        self.assertEqual(written, described)
