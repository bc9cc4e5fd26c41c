"""Findings of cases, case by case, the usual ones apart from those of cases/hard."""
from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from data.results import CaseEntry, Finding

HARD = Path(__file__).resolve().parents[2] / "cases" / "hard"
# what else is measured where the method is at its edge
STUDIES = ("hard-limits", "buckling", "biphasic")
PREFIX = "case."


@dataclass
class CaseFindings:
    """Expectations of one case."""
    name: str
    title: str
    file: str          # "cases/hard/twist.toml"
    anchor: str        # of its pictures on the page; "" if it has none
    findings: list[Finding]


def is_of_case(finding: Finding) -> bool:
    """Whether a finding is named case.<case>.<what>."""
    return finding.name.startswith(PREFIX)


def findings_by_case(
    findings: Iterable[Finding], cases: Iterable[CaseEntry], anchors: Iterable[str],
    hard: Path = HARD
) -> tuple[list[CaseFindings], list[CaseFindings]]:
    """The usual cases and the hard ones, each in the order of their first finding; the two lists
    that say which cases have pictures are equally long."""
    shown = {case.name: (case.title, anchor) for case, anchor in zip(cases, anchors)}
    hard_names = {path.stem for path in hard.glob("*.toml")}
    found: dict[str, CaseFindings] = {}
    for finding in findings:
        if is_of_case(finding):
            name = finding.name.split(".")[1]
            title, anchor = shown.get(name, (finding.source or name, ""))
            folder = "cases/hard" if name in hard_names else "cases"
            found.setdefault(
                name, CaseFindings(name, title, f"{folder}/{name}.toml", anchor, [])
            ).findings.append(finding)
    return ([case for case in found.values() if case.name not in hard_names],
            [case for case in found.values() if case.name in hard_names])
