"""Error against cost of judged solvers: one figure and one table, of the evidence that a law stored
for each. A solver whose motion approaches no limit has no error, and no curve."""
from __future__ import annotations

from dataclasses import dataclass
from math import nan
from pathlib import Path
from typing import Any

import numpy as np
from markupsafe import Markup

from data.studies import Curve, StudyFigure
from data.trials import Trial
from pages.figure_words import figure_keys, figure_notes
from plots.plot_style import Plot, use_style
from plots.study_plots import plot_study_figure

SECONDS, ERROR = "seconds by the clock", "error"
CAPTION = (
    "The same 0.04 s of a moving sheet, a mark for each number of steps. Seconds are by the clock "
    "of one machine, read through a pipe, for solvers in different languages: the least of a few "
    "readings. The error is against the solver's own limit, extrapolated: it is an error of the "
    "time step, not of the model. Where a curve turns up, rounding, measured a few metres from the "
    "origin, hides the changes."
)


@dataclass(frozen=True)
class Costs:
    """The figure of all solvers, and what stands around it."""

    figure: StudyFigure
    plot: Plot
    keys: list[tuple[Markup, str]]
    notes: list[str]


def costs_of(trials: list[Trial], labels: list[str], folder: Path) -> Costs | None:
    """Draws the curves into the folder; None if no solver has one."""
    curves = [
        Curve(label, *_points(table), nan, None, nan, None)
        for trial, label in zip(trials, labels)
        for table in trial.facts["cost"]
        if _has_limit(trial, table)
    ]
    if not curves:
        return None
    figure = StudyFigure(
        name="error_against_cost", title="Error against cost", caption=CAPTION,
        x_label="seconds of the solver, by the clock", x_unit="s",
        y_label="error of the time step, over the motion", y_unit="1", x_scale="log", y_scale="log",
        curves=curves, slope=nan
    )
    use_style()
    plot = plot_study_figure(figure, "error-against-cost", folder)
    return Costs(figure, plot, figure_keys(figure), figure_notes(figure) + _notes(trials, labels))


def cost_rows(trials: list[Trial], labels: list[str]) -> list[dict[str, Any]]:
    """A row for each step of each solver, keyed by the columns of its table."""
    return [
        {"solver": label, "has_limit": _has_limit(trial, table)}
        | {one["name"]: one["values"][row] for one in table["columns"]}
        for trial, label in zip(trials, labels)
        for table in trial.facts["cost"]
        for row in range(min(len(one["values"]) for one in table["columns"]))
    ]


def _has_limit(trial: Trial, table: dict[str, Any]) -> bool:
    """Whether the law holds whose evidence this is."""
    answer = trial.answers.get(table["law"])
    return answer is not None and answer.outcome == "holds"


def _points(table: dict[str, Any]) -> tuple[np.ndarray, np.ndarray]:
    columns = {one["name"]: one["values"] for one in table["columns"]}
    x, y = (
        np.array([nan if value is None else value for value in columns.get(name, [])], float)
        for name in (SECONDS, ERROR)
    )
    return x, y


def _notes(trials: list[Trial], labels: list[str]) -> list[str]:
    """Solvers without a curve, and clocks that cannot be compared."""
    notes = []
    without = [
        label
        for trial, label in zip(trials, labels)
        if not any(_has_limit(trial, table) for table in trial.facts["cost"])
    ]
    if without:
        names = ", ".join(without)
        notes.append(f"No curve, since the law that measures it does not hold: {names}.")
    if len({trial.program["cpu"] for trial in trials}) > 1:
        notes.append("These solvers were judged on different processors: compare no seconds.")
    return notes
