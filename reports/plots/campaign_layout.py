"""Where each job of a campaign stands in a figure: the values along its axes, and its panels."""
from __future__ import annotations

import re
from collections import defaultdict
from dataclasses import dataclass

import numpy as np

from data.campaign_table import CampaignFigure, CampaignTable
from data.quantities import unit_text
from plots.plot_style import level_text

NO_VALUE = "not set"  # of a parameter that only some parts of a campaign vary
MOST_PANELS = 12
NUMBER = re.compile(r"(?<![\w.])([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)(?![\w.])")


@dataclass(frozen=True)
class Levels:
    """The values of a parameter in the order of a figure."""

    texts: list[str]
    numbers: np.ndarray | None  # None if one is not a number
    scale: str = "linear"

    def named(self) -> list[str]:
        """As ticks."""
        if self.numbers is not None:
            return [level_text(v) for v in self.numbers]
        return [text or NO_VALUE for text in self.texts]


@dataclass(frozen=True)
class Panel:
    """The jobs of one small picture, by their places along the first two parameters."""

    title: str
    jobs: dict[tuple[int, int], list[int]]


@dataclass(frozen=True)
class Layout:
    """What all panels of a figure share."""

    figure: CampaignFigure
    labels: list[tuple[str, str]]  # words and unit of each parameter
    value: tuple[str, str]  # of the quantity
    x: Levels
    y: Levels  # a single level for one parameter
    panels: list[Panel]
    panels_left_out: int


def levels_of(texts: list[str]) -> Levels:
    """Ascending numbers, or texts in the order of their first job. Texts that differ in a single
    number, as { angle = 30, axis = [0, 0, 1] }, are that number."""
    different = list(dict.fromkeys(texts))
    numbers = _numbers_in(different)
    if numbers is None:
        return Levels(different, None)
    order = np.argsort(numbers, kind="stable")
    numbers = numbers[order]
    return Levels([different[k] for k in order], numbers, _scale_of(numbers))


def _numbers_in(texts: list[str]) -> np.ndarray | None:
    """The number in which each text differs from the others; None if that is not all."""
    parts = [NUMBER.split(text) for text in texts]
    if len({tuple(part[::2]) for part in parts}) > 1:
        return None
    columns = [column for column in zip(*(part[1::2] for part in parts)) if len(set(column)) > 1]
    if len(texts) == 1:
        columns = list(zip(*(part[1::2] for part in parts)))
    if len(columns) != 1:
        return None
    numbers = np.array([float(text) for text in columns[0]])
    return numbers if len(set(numbers)) == len(texts) else None


def _scale_of(numbers: np.ndarray) -> str:
    """Logarithmic where factors are more even than differences."""
    if len(numbers) < 3 or not numbers[0] > 0 or numbers[-1] / numbers[0] < 8:
        return "linear"
    differences, factors = np.diff(numbers), np.diff(np.log(numbers))
    uneven = [steps.std() / steps.mean() for steps in (differences, factors)]
    return "log" if uneven[1] < uneven[0] else "linear"


def layout_of(table: CampaignTable, figure: CampaignFigure) -> Layout:
    """Sorts jobs into panels and places."""
    columns = [table.settings[name] for name in figure.over]
    everywhere = [""] * len(table.outcomes)
    x, y, z = (levels_of(column) for column in (columns + [everywhere] * 2)[:3])
    place = [{text: k for k, text in enumerate(levels.texts)} for levels in (x, y, z)]
    jobs: list[dict[tuple[int, int], list[int]]] = [defaultdict(list) for _ in z.texts]
    for job, (a, b, c) in enumerate(zip(*(columns + [everywhere] * 2)[:3])):
        jobs[place[2][c]][place[0][a], place[1][b]].append(job)
    labels = [table.label(name) for name in figure.over]
    titles = [panel_title(labels[2], text) if len(labels) > 2 else "" for text in z.named()]
    panels = [Panel(title, dict(cells)) for title, cells in zip(titles, jobs)]
    value = table.label(figure.quantity)
    return Layout(figure, labels, value, x, y, panels[:MOST_PANELS], len(panels[MOST_PANELS:]))


def panel_title(label: tuple[str, str], text: str) -> str:
    """A value of the third parameter."""
    words, unit = label
    is_bare = unit in ("", "1") or not text or text == NO_VALUE
    return f"{words}: {text or NO_VALUE}" + ("" if is_bare else f" {unit_text(unit)}")
