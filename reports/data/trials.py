"""Trials of other solvers: folders that `foldproof judge --out` wrote. Outcomes are the words that
the program stored; nothing is judged here."""
from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from data.records import record
from data.results import Run
from data.unreadable import Unreadable, reading

FACTS = "solver.json"
ABOUT = ("date", "version", "commit", "tree", "cpu", "command")


@dataclass(frozen=True)
class Law:
    """A law of the portable suite."""

    name: str
    claim: str
    source: str


@dataclass(frozen=True)
class Answer:
    """What one solver made of one law."""

    outcome: str
    measured: float  # [unit]; NaN: no number
    bound: float  # [unit]
    unit: str
    why_bound: str
    note: str
    headline: str = ""  # what was measured where the judged number is another


@dataclass(frozen=True)
class Trial:
    """One judged solver."""

    folder: str  # as it was named
    subject: str  # its name in the report
    facts: dict[str, Any]  # solver.json: declaration, command, settings, mapping
    program: dict[str, Any]  # which foldproof judged, when, by which command
    laws: list[Law]
    answers: dict[str, Answer]  # by the law's name


def is_trial(folder: Path) -> bool:
    """Whether the folder holds a judged solver."""
    return (folder / FACTS).is_file()


def read_trial(folder: Path) -> Trial:
    """Throws Unreadable naming the file."""
    path = folder / "verdicts.json"
    facts, verdicts = facts_of_file(folder / FACTS), _object(path)
    with reading(path):
        rows, program = verdicts["findings"], verdicts["program"]
        return Trial(
            folder=str(folder),
            subject=str(program["subject"]),
            facts=facts,
            program={key: str(program[key]) for key in ABOUT},
            laws=[record(Law, row) for row in rows],
            answers={row["name"]: record(Answer, row) for row in rows},
        )


def trial_of_run(folder: Path, run: Run) -> Trial | None:
    """The trial that wrote this run into the folder; None if a later command did. Throws as
    read_trial does."""
    if not is_trial(folder):
        return None
    trial = read_trial(folder)
    same = all(trial.program[key] == str(run.provenance.get(key)) for key in ("date", "command"))
    return trial if same else None


def _object(path: Path) -> dict[str, Any]:
    with reading(path):
        value = json.loads(path.read_text(encoding="utf-8"))
    if not isinstance(value, dict):
        raise Unreadable(f"{path}: is no JSON object")
    return value


def facts_of_file(path: Path) -> dict[str, Any]:
    """What a judged solver says of itself, and how it was asked: solver.json."""
    facts = _object(path)
    texts = ("version", "level", "precision", "scheme", "command")
    with reading(path):
        return {
            **{key: str(facts[key]) for key in texts},
            **{key: dict(facts[key]) for key in ("settings", "mapping")},
            "capabilities": [str(one) for one in facts["capabilities"]],
            "options": [str(one) for one in facts.get("options", [])],
            "order": int(facts["order"]),
            "solve_tolerance": float(facts["solve_tolerance"]),
            **{
                key: [_evidence(one) for one in facts.get(key, [])]
                for key in ("calibration", "cost")
            },
            "portrait": _portrait(facts.get("portrait")),
        }


def _portrait(said: dict[str, Any] | None) -> dict[str, Any] | None:
    """One scene's shape at the end, or why there is none; None if it was not asked."""
    if said is None or "x" not in said:
        return said and {"why_none": str(said["why_none"])}
    return {
        "about": str(said["about"]), "radius": float(said["radius"]),
        "x": [[float(one) for one in row] for row in said["x"]],
        "centre": [float(one) for one in said["centre"]],
        "triangles": [[int(one) for one in row] for row in said["triangles"]],
    }


def _evidence(table: dict[str, Any]) -> dict[str, Any]:
    """What a law measured: columns with units; null: no number."""
    columns = [
        {
            "name": str(one["name"]),
            "unit": str(one["unit"]),
            "values": [
                value if value is None or isinstance(value, str) else float(value)
                for value in one["values"]
            ],
        }
        for one in table["columns"]
    ]
    return {"law": str(table["law"]), "columns": columns}
