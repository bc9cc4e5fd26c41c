#!/usr/bin/python3
"""Tests of `foldproof subject --check` as an adapter's author meets it, and of the protocol's page:
the schema must describe its transcript and every header that the program sends.

scripts/tests/test_protocol.py [--program FILE] [Protocol.test_...]
--program: instead of build/foldproof
"""
from __future__ import annotations

import json
import math
import os
import re
import subprocess
import sys
import unittest
from pathlib import Path
from typing import Any
from unittest import mock

from jsonschema import Draft202012Validator

from judge_case import SUBJECTS, TOY, JudgeCase, bad
from program_case import ROOT, run

SCHEMA = json.loads((SUBJECTS / "protocol.schema.json").read_text(encoding="utf-8"))
BYTES = {"f8": 8, "f4": 4, "i4": 4}


def validator(kind: str) -> Draft202012Validator:
    """Of one of the schema's $defs: request, declaration or answer."""
    return Draft202012Validator({**SCHEMA, "$ref": f"#/$defs/{kind}"})


def transcript() -> list[tuple[str, dict[str, Any]]]:
    """The worked example of PROTOCOL.md: '>' or '<', and the header."""
    page = (SUBJECTS / "PROTOCOL.md").read_text(encoding="utf-8")
    return [(line[0], json.loads(line[2:])) for line in re.findall(r"^[<>] \{.*$", page, re.M)]


def bytes_due(header: dict[str, Any]) -> int:
    return sum(BYTES[entry["type"]] * math.prod(entry["shape"])
               for entry in header.get("arrays", []))


class Protocol(JudgeCase):
    def test_check_accepts_the_toys_and_names_the_first_breach(self) -> None:
        for toy in (TOY, f"'{ROOT}/build/toy_solver'"):
            done = run("subject", "--check", toy)
            self.assert_holds(done)
            self.assertEqual(done.stdout.splitlines()[-1], "the adapter keeps to the protocol")
        done = run("subject", "--check", bad("broken", "wrong_shape"))
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stdout,
                         r"\nBROKEN +advance returns .*shape \[52,2\] instead of \[52,3\].*"
                         r"\nthe adapter does not keep to the protocol\n$")

    def rows_of(self, log: Path) -> list[tuple[str, dict[str, Any]]]:
        """What was sent and answered, each valid."""
        rows = [json.loads(line) for line in log.read_text(encoding="utf-8").splitlines()]
        for side, header in rows:
            validator("request" if side == ">" else "answer").validate(header)
        return rows

    def test_all_that_is_sent_is_what_the_schema_describes(self) -> None:
        command, log = self.logging_solver()
        for words in (["judge", "--solver"], ["subject", "--check"]):
            self.assert_holds(run(*words, command))
        operations = {header["op"] for side, header in self.rows_of(log) if side == ">"}
        self.assertLessEqual({"start", "run", "prepare", "advance", "get_state", "step", "forces",
                              "damping", "energy", "stop"}, operations)

    def test_obstacles_are_sent_as_the_schema_describes(self) -> None:
        kinds = {"planes", "boxes", "spheres", "capsules"}
        command, log = self.logging_solver(*sorted(kinds))
        self.assert_holds(run("subject", "--check", command))
        rows = self.rows_of(log)
        validator("declaration").validate(rows[1][1])
        sent = [header for side, header in rows if side == ">"]
        self.assertLessEqual(kinds, {key for header in sent for key in header.get("scene", ())})
        (ball,) = [header for header in sent if "spheres" in header.get("scene", ())]
        ball["scene"]["spheres"][0]["radius"] = 0
        self.assertFalse(validator("request").is_valid(ball))

    def test_progress_is_told_at_most_once_a_second(self) -> None:
        told = []

        class Sink:
            def write(self, data: bytes) -> None:
                told.append(json.loads(data.splitlines()[0]))

            def flush(self) -> None:
                pass

        sys.path.insert(0, str(SUBJECTS / "adapters"))
        import foldproof_solver as helper
        pipe = helper.Pipe(None, Sink())
        with mock.patch.object(helper.time, "monotonic", side_effect=lambda: self.clock):
            for tenths in range(35):
                self.clock = pipe.told + 1 if tenths in (10, 20, 30) else pipe.told + 0.9
                pipe.send_progress(7, tenths / 35)
        self.assertEqual([one["progress"] for one in told], [10 / 35, 20 / 35, 30 / 35])
        for header in told:
            self.assertEqual(header["id"], 7)
            validator("answer").validate(header)

    def test_the_transcript_is_what_the_schema_describes(self) -> None:
        rows = transcript()
        self.assertEqual([side for side, _ in rows], [">", "<"] * (len(rows) // 2))
        for side, header in rows:
            validator("request" if side == ">" else "answer").validate(header)
        validator("declaration").validate(rows[1][1])

    def test_the_schema_rejects_other_headers(self) -> None:
        request, declaration = transcript()[4][1], transcript()[1][1]
        spoiled = [
            ("request", {**request, "op": "prepare"}), ("request", {**request, "dt": 0}),
            ("request", {**request, "id": "3"}), ("request", {**request, "speed": 1}),
            ("answer", {"declined": "no id"}),
            ("answer", {"id": 3, "arrays": [{"name": "x", "type": "f2", "shape": [3]}]}),
            ("declaration", {**declaration, "level": "L4"}),
            ("declaration", {**declaration, "solve_tolerance": 1})
        ]
        for kind, header in spoiled:
            self.assertFalse(validator(kind).is_valid(header), header)

    def test_the_toy_answers_as_in_the_transcript(self) -> None:
        (read_requests, write_requests), (read_answers, write_answers) = os.pipe(), os.pipe()
        ends = {"FOLDPROOF_IN": str(read_requests), "FOLDPROOF_OUT": str(write_answers)}
        toy = subprocess.Popen(
            ["/usr/bin/python3", "-W", "ignore", SUBJECTS / "adapters/toy_solver.py"],
            env={**os.environ, **ends}, pass_fds=(read_requests, write_answers))
        os.close(read_requests), os.close(write_answers)
        with os.fdopen(write_requests, "wb") as requests, os.fdopen(read_answers, "rb") as answers:
            for side, header in transcript():
                # arrays of zeros: the headers of the answers are those of any numbers
                if side == ">":
                    requests.write(json.dumps(header).encode() + b"\n" + bytes(bytes_due(header)))
                    requests.flush()
                    continue
                answer = json.loads(answers.readline())
                answers.read(bytes_due(answer))
                self.assertEqual(answer, header)
        self.assertEqual(toy.wait(), 0)


if __name__ == "__main__":
    unittest.main()
