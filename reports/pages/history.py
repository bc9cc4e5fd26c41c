"""The history of runs as text, JSON and a page. Arranges what was stored; judges nothing."""
from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from math import isfinite
from typing import Any

from data.history import Change, MarginChange, RunRow, changes, margin_changes
from pages.counts import OUTCOMES
from pages.render import new_environment

MOST = 30                  # lines of a list in the text
SLOWER = 1.5               # costs that grew by this factor between first and last run are listed
LEAST_SECONDS = 0.5        # of costs; shorter ones are noise


@dataclass(frozen=True)
class Slower:
    """A study, a case or the run, that takes longer now [s]."""
    what: str
    first: float
    last: float


@dataclass(frozen=True)
class History:
    """All that is shown."""
    rows: list[RunRow]
    changes: list[Change]
    margins: list[MarginChange]
    slower: list[Slower]

    @property
    def newest_regressions(self) -> list[Change]:
        """Changes for the worse in the last run."""
        return [
            change
            for change in self.changes
            if change.run is self.rows[-1] and change.is_regression
        ]

    def changes_of(self, row: RunRow) -> list[Change]:
        """Those that this run is the first to have."""
        return [change for change in self.changes if change.run is row]


def history_of(rows: list[RunRow]) -> History:
    """Of runs in the order of their dates."""
    return History(rows, changes(rows), margin_changes(rows), _slower(rows))


def _slower(rows: list[RunRow]) -> list[Slower]:
    """Costs of the last run against the first run of the same tier, processor and subject."""
    alike = [row for row in rows if row.costs
             and all(row.about[key] == rows[-1].about[key] for key in ("tier", "cpu", "subject"))]
    if len(alike) < 2 or alike[-1] is not rows[-1]:
        return []
    first, last = alike[0].costs, alike[-1].costs
    found = [Slower(what, first[what], seconds) for what, seconds in last.items()
             if seconds >= LEAST_SECONDS and what in first and seconds >= SLOWER * first[what]]
    return sorted(found, key=lambda one: one.first - one.last)


def as_text(history: History) -> str:
    """A table of runs, then the changes, run by run."""
    heads = ["run", "version", "tier", *OUTCOMES, "claims", "changes"]
    rows = [
        [
            row.label, row.about["version"], row.about["tier"],
            *(str(row.counts.get(name, 0)) for name in OUTCOMES), str(len(row.rulings)),
            changes_text(history.changes_of(row))
        ]
        for row in history.rows
    ]
    parts = [
        _table(heads, rows),
        _list(
            "changed, by the first run that has it:",
            (_change_line(one) for one in history.changes), "No verdict and no ruling changed."
        ),
        _list(
            "closer to their bound (measured/bound):",
            (
                f"{one.run.label}  {one.name}: {one.before:.3g} -> {one.after:.3g}"
                for one in history.margins
            )
        ),
        _list(
            "slower than in the first run on this processor (the clock; repeat before you believe"
            " it):",
            (f"{one.what}: {one.first:.3g} s -> {one.last:.3g} s" for one in history.slower)
        ),
    ]
    return "\n\n".join(part for part in parts if part)


def changes_text(found: list[Change]) -> str:
    """"2 worse, 1 other" """
    worse = sum(change.is_regression for change in found)
    words = [f"{worse} worse"] if worse else []
    words += [f"{len(found) - worse} other"] if len(found) > worse else []
    return ", ".join(words) or "-"


def _change_line(change: Change) -> str:
    mark = "WORSE " if change.is_regression else "      "
    return (
        f"{mark}{change.run.label}  {change.name}: {change.before or 'not there'} ->"
        f" {change.after or 'not there'}"
    )


def _table(heads: list[str], rows: list[list[str]]) -> str:
    widths = [max(len(row[k]) for row in [heads, *rows]) for k in range(len(heads))]
    return "\n".join(
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip()
        for row in [heads, *rows]
    )


def _list(head: str, lines: Iterable[str], nothing: str = "") -> str:
    found = list(lines)
    if not found:
        return nothing
    more = [f"  ... and {len(found) - MOST} more"] if len(found) > MOST else []
    return "\n".join([head, *(f"  {line}" for line in found[:MOST]), *more])


def as_json(history: History) -> str:
    """The same for programs."""
    def change(one: Change | MarginChange) -> dict[str, Any]:
        about = {key: one.run.about[name] for key, name in (("run", "date"), ("commit", "commit"))}
        return about | {"name": one.name, "before": one.before, "after": one.after}
    runs = [
        row.about
        | {"counts": row.counts, "rulings": dict(Counter(row.rulings.values())), "costs": row.costs}
        for row in history.rows
    ]
    said = {
        "runs": runs,
        "changes": [change(one) | {"worse": one.is_regression} for one in history.changes],
        "margins": [change(one) for one in history.margins if isfinite(one.after)],
        "slower": [asdict(one) for one in history.slower],
    }
    return json.dumps(said, indent=1)


def render_history(history: History) -> str:
    """The page as one HTML text."""
    environment = new_environment()
    environment.globals.update(changes_text=changes_text, outcomes=OUTCOMES)
    return environment.get_template("history.html.j2").render(said=history)
