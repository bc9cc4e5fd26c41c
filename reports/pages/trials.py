"""The page of several judged solvers: a table of laws by solvers. It arranges what was stored and
judges nothing."""
from __future__ import annotations

import json
from collections import Counter
from dataclasses import asdict, dataclass
from math import isfinite
from pathlib import Path
from typing import Any

from data.trials import Answer, Law, Trial
from pages.counts import count_outcomes
from pages.render import new_environment
from pages.solver_words import APART, DECLINED, is_of_frames
from pages.portraits import portraits_of
from pages.trial_costs import cost_rows, costs_of


@dataclass(frozen=True)
class Row:
    """A law, and the answers in the order of the solvers; None: not run."""

    law: Law
    answers: list[Answer | None]

    @property
    def differs(self) -> bool:
        """Whether a solver does not meet it."""
        return any(is_difference(answer) for answer in self.answers)


@dataclass(frozen=True)
class Reason:
    """Why laws were not judged; the solvers and, of each, the laws."""

    number: int  # from 1, as on the page
    why: str
    laws: dict[str, list[str]]


@dataclass(frozen=True)
class Trials:
    """All that the page shows."""

    trials: list[Trial]
    labels: list[str]
    rows: list[Row]

    @property
    def groups(self) -> list[tuple[str, list[Row]]]:
        """Headings, and the laws below each: those that a solver does not meet first."""
        some = [row for row in self.rows if row.differs]
        rest = [row for row in self.rows if not row.differs]
        titles = ("At least one solver differs", "Holds wherever it was judged")
        return [(title, rows) for title, rows in zip(titles, (some, rest)) if rows]

    @property
    def differences(self) -> list[tuple[Law, str, Answer]]:
        """Laws that a solver does not meet, with its label."""
        return [
            (row.law, label, answer)
            for row in self.rows
            for label, answer in zip(self.labels, row.answers)
            if is_difference(answer)
        ]

    @property
    def reasons(self) -> dict[str, Reason]:
        """What was not judged, by the words of the reason."""
        found: dict[str, Reason] = {}
        for row in self.rows:
            for label, answer in zip(self.labels, row.answers):
                if answer and answer.outcome in APART:
                    why = reason(answer)
                    same = found.setdefault(why, Reason(len(found) + 1, why, {}))
                    same.laws.setdefault(label, []).append(row.law.name)
        return found


def is_difference(answer: Answer | None) -> bool:
    """Whether a law was judged and does not hold."""
    return answer is not None and answer.outcome not in ("holds", *APART)


def trials_of(trials: list[Trial]) -> Trials:
    """Laws in the order of the first solver that was asked them."""
    laws = {law.name: law for trial in trials for law in trial.laws}
    rows = [Row(law, [trial.answers.get(name) for trial in trials]) for name, law in laws.items()]
    return Trials(trials, _labels(trials), rows)


def _labels(trials: list[Trial]) -> list[str]:
    """Names of the solvers; the folder tells those apart that share one."""
    counted = Counter(trial.subject for trial in trials)
    return [
        trial.subject if counted[trial.subject] == 1 else f"{trial.subject} ({trial.folder})"
        for trial in trials
    ]


def reason(answer: Answer) -> str:
    """Why a law was not judged."""
    if not answer.note.startswith(DECLINED):
        return answer.note
    return "does not offer " + answer.note.removeprefix(DECLINED)


@dataclass(frozen=True)
class Measured:
    """What one law measured, solver by solver."""

    name: str
    columns: list[dict[str, Any]]
    rows: list[tuple[str, list[Any]]]  # label of the solver, cells


def measured_tables(said: Trials, what: str) -> list[Measured]:
    """Tables of the solvers, "calibration" or "cost", under one heading for each law; those with
    other columns are left out of it."""
    found: dict[str, Measured] = {}
    for trial, label in zip(said.trials, said.labels):
        for table in trial.facts[what]:
            columns = table["columns"]
            known = found.setdefault(table["law"], Measured(table["law"], columns, []))
            if [one["name"] for one in columns] == [one["name"] for one in known.columns]:
                cells = zip(*(one["values"] for one in columns))
                known.rows.extend((label, list(row)) for row in cells)
    return list(found.values())


def trials_json(said: Trials) -> str:
    """The page for other programs; null: no number, or not run."""
    return (
        json.dumps(
            {
                "schema": 1,
                "solvers": [
                    {
                        "name": label, "folder": trial.folder, **trial.facts,
                        "judged_by": trial.program,
                        "counts": dict(count_outcomes(trial.answers.values()))
                    }
                    for trial, label in zip(said.trials, said.labels)
                ],
                "laws": [
                    {**asdict(row.law), "answers": [_answer_json(answer) for answer in row.answers]}
                    for row in said.rows
                ],
                "error_against_cost": cost_rows(said.trials, said.labels),
            },
            indent=1,
            allow_nan=False,
        )
        + "\n"
    )


def _answer_json(answer: Answer | None) -> dict[str, Any] | None:
    if answer is None:
        return None
    return {
        key: None if isinstance(value, float) and not isfinite(value) else value
        for key, value in asdict(answer).items()
    }


def render_trials(said: Trials, figures: Path) -> str:
    """The page as one HTML text; its figure is also a file in the folder."""
    environment = new_environment()
    all_frames = all(is_of_frames(trial) for trial in said.trials)
    environment.globals.update(
        reason=reason, measured_tables=measured_tables, all_frames=all_frames
    )
    costs = costs_of(said.trials, said.labels, figures)
    portraits = portraits_of(said.trials, said.labels)
    template = environment.get_template("trials.html.j2")
    return template.render(said=said, costs=costs, portraits=portraits)
