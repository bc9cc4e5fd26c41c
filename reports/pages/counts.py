"""Groups and counts of what the page lists: items by a key, findings by outcome, faults by fate."""
from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Hashable, Iterable
from math import isnan
from typing import Any, TypeVar

from data.quantities import ratio_of
from data.results import Fault, Finding

OUTCOMES = ("holds", "fails", "inconclusive", "not applicable")
BAR_END = 1.25  # measured / bound at the end of the margin bar

Item, Key = TypeVar("Item"), TypeVar("Key", bound=Hashable)


def grouped(items: Iterable[Item], key: Callable[[Item], Key]) -> dict[Key, list[Item]]:
    """Items by a key, groups in the order of their first item."""
    groups: dict[Key, list[Item]] = {}
    for item in items:
        groups.setdefault(key(item), []).append(item)
    return groups


def counted(words: Iterable[str], usual: tuple[str, ...]) -> list[tuple[str, int]]:
    """How often each word occurs: the usual ones always, in their order, then all others."""
    counts = Counter(words)
    return [(word, counts[word]) for word in (*usual, *sorted(set(counts) - set(usual)))]


def count_outcomes(findings: Iterable[Any]) -> list[tuple[str, int]]:
    """How many findings (or answers of a solver) have each outcome; the four usual ones always."""
    return counted((finding.outcome for finding in findings), OUTCOMES)


def outcome_class(outcome: str) -> str:
    """The CSS class of an outcome."""
    return re.sub(r"[^a-z]+", "-", outcome.lower()).strip("-") or "unknown"


def all_hold(findings: Iterable[Finding]) -> bool:
    """Whether nothing asks to be looked at: every finding holds or does not apply."""
    return all(finding.outcome in ("holds", "not applicable") for finding in findings)


def group_by_prefix(findings: Iterable[Finding]) -> dict[str, list[Finding]]:
    """Findings by the part of their name before the first dot."""
    return grouped(findings, lambda finding: finding.name.split(".")[0])


def margin_percent(finding: Finding) -> float | None:
    """Length of the margin bar in percent: measured / bound, on a scale from zero to BAR_END; None
    where that says nothing."""
    ratio = ratio_of(finding.measured, finding.bound)
    return None if isnan(ratio) else 100.0 * min(ratio / BAR_END, 1.0)


class CaughtCount:
    """How many of a finding's seeded faults were caught; None where
    the run's folder has no outcomes."""

    def __init__(self, faults: list[Fault]) -> None:
        self._caught = {fault.name for fault in faults if fault.outcome == "caught"}
        self.known = any(fault.outcome in ("caught", "SURVIVED") for fault in faults)

    def of(self, finding: Finding) -> int:
        """How many of the faults that name this finding were caught."""
        return sum(name in self._caught for name in finding.faults)


def faults_by_file(faults: Iterable[Fault]) -> dict[str, list[Fault]]:
    """Faults by the file that they edit."""
    return grouped(faults, lambda fault: fault.file)


def fault_outcomes(faults: list[Fault]) -> list[tuple[str, int]]:
    """How many faults have each outcome; all together where none is known."""
    if not CaughtCount(faults).known:
        return [("faults" if len(faults) != 1 else "fault", len(faults))]
    return list(Counter(fault.outcome or "not run" for fault in faults).items())
