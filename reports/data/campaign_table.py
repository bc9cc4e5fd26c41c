"""The results of a campaign as `foldproof campaign table` stores them in campaign.json."""
from __future__ import annotations

import json
import re
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from data.case_keys import unit_of_key, words_of_key
from data.unreadable import Unreadable, reading

WITH_VALUE = ("holds", "fails")  # outcomes of runs that came to their end
OF_EVERY_RUN = ("steps", "end_time", "cg_iterations", "exit_code", "repulsions", "impulses",
                "zone_particles", "share_of_impulses")
NAMED_WITH_UNIT = re.compile(r"(.*\S)\s*\[([^\]]+)\]")
MOST_FIGURES = 6  # of a campaign that names none


@dataclass(frozen=True)
class CampaignFigure:
    """A quantity over one to three parameters: across, up or a curve each, a panel each."""

    quantity: str
    over: tuple[str, ...]
    title: str
    is_logarithmic: bool


@dataclass(frozen=True)
class CampaignTable:
    """A row a job; values of runs that did not come to their end are NaN."""

    about: dict[str, str]  # name, title, about, run
    figures: list[CampaignFigure]
    findings: list[dict[str, Any]]
    settings: dict[str, list[str]]  # a column a parameter
    values: dict[str, np.ndarray]  # a column a quantity
    units: dict[str, str]
    names: dict[str, str]  # of parameters and quantities, for readers, as "length [m]"
    sensitivities: list[dict[str, Any]]
    outcomes: list[str]
    reasons: list[str]
    seconds: np.ndarray

    def label(self, name: str) -> tuple[str, str]:
        """Words and unit of a parameter or a quantity: the campaign's own, else the key's."""
        is_quantity = name in self.values
        unit = self.units.get(name, "1") if is_quantity else unit_of_key(name)
        said = self.names.get(name)
        if said is None:
            return words_of_key(name.removeprefix("expect.")), unit
        with_unit = NAMED_WITH_UNIT.fullmatch(said)
        return (with_unit[1], with_unit[2]) if with_unit else (said, unit)

    def counts(self) -> dict[str, int]:
        """How many jobs had each outcome, the commonest first."""
        return dict(Counter(self.outcomes).most_common())

    def commonest_reasons(self, most: int) -> list[tuple[str, str, int]]:
        """Outcome, reason and count of what does not hold. What a reason has in brackets, as the
        step at which a run diverged, is left out."""
        said = Counter((o, r.split(" (")[0]) for o, r in zip(self.outcomes, self.reasons)
                       if o != "holds")
        return [(*what, count) for what, count in said.most_common(most)]


def load_campaign(folder: Path) -> CampaignTable:
    """Reads FOLDER/campaign.json; Unreadable if there is none, or it is damaged."""
    path = folder / "campaign.json"
    with reading(path):
        return _table_of(json.loads(path.read_text(encoding="utf-8")))


def _table_of(said: dict[str, Any]) -> CampaignTable:
    outcomes = [str(outcome) for outcome in said["outcomes"]]
    ended = np.array([outcome in WITH_VALUE for outcome in outcomes], dtype=bool)
    numbers = [[np.nan if value is None else value for value in row] for row in said["values"]]
    table = np.array(numbers, dtype=float).reshape(len(outcomes), len(said["quantities"]))
    table[~ended] = np.nan
    return CampaignTable(
        about={key: str(said[key]) for key in ("name", "title", "about", "run")},
        figures=[CampaignFigure(one["quantity"], tuple(one["over"]), one["title"],
                                one["logarithmic"]) for one in said["figures"]],
        findings=said["findings"],
        settings={name: [str(row[k]) for row in said["settings"]]
                  for k, name in enumerate(said["parameters"])},
        values={name: table[:, k] for k, name in enumerate(said["quantities"])},
        units=said["units"],
        names=said.get("names", {}),
        sensitivities=said.get("sensitivities", []),
        outcomes=outcomes,
        reasons=[str(reason) for reason in said["reasons"]],
        seconds=np.array([np.nan if s is None else s for s in said["seconds"]], dtype=float),
    )


def figures_of(table: CampaignTable) -> list[CampaignFigure]:
    """Those that the campaign names; else one for each quantity that differs between runs, over
    the first parameters, at most three."""
    if table.figures:
        return table.figures
    differ = [name for name, values in table.values.items()
              if name not in OF_EVERY_RUN and not name.startswith("expect.")
              and len(np.unique(values[np.isfinite(values)])) > 1]
    over = tuple(table.settings)[:3]
    return [CampaignFigure(name, over, "", False) for name in differ[:MOST_FIGURES] if over]


def require_columns(table: CampaignTable, figure: CampaignFigure) -> None:
    """Unreadable if the campaign does not vary a parameter, or no run has the quantity."""
    for name in figure.over:
        if name not in table.settings:
            raise Unreadable(f"the campaign does not vary '{name}'; it varies "
                             f"{', '.join(table.settings)}")
    if figure.quantity not in table.values and any(o in WITH_VALUE for o in table.outcomes):
        raise Unreadable(f"no run has the quantity '{figure.quantity}'; there are "
                         f"{', '.join(table.values)}")
