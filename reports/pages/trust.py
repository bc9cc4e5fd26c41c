"""How far to trust the run: margins of all bounds, lines that the run reaches.
Sorts and counts; decides nothing."""
from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from math import isfinite
from pathlib import Path

from data.results import Finding
from data.unreadable import reading

JUDGED = ("holds", "fails", "inconclusive")
TIGHTEST = 10     # findings shown unasked


@dataclass
class Tolerance:
    """A bound and how much of it is used up: (measured + uncertainty) / bound."""
    finding: Finding
    used: float


@dataclass
class Tolerances:
    """Findings by the part of their bound that is used, the tightest first;
    and those whose bound is zero."""
    ranked: list[Tolerance]
    exact: list[Finding]       # bound zero: nothing may differ, so there is no margin
    # below a bound of zero or less: the share of it that is used says nothing
    one_sided: list[Finding]

    def tightest(self) -> list[Tolerance]:
        """Those that stand nearest to their bound, fulfilled or not."""
        return self.ranked[:TIGHTEST]

    def below(self, part: float) -> int:
        """How many use less than this part of their bound."""
        return sum(entry.used < part for entry in self.ranked)


@dataclass
class CoveredFile:
    """One source file of the method: lines and branches, and which lines never ran."""
    name: str
    lines: int
    lines_reached: int
    branches: int
    branches_taken: int
    missed: str


@dataclass
class Coverage:
    """Results of scripts/coverage."""
    commit: str
    ran: str
    least: float               # percent of lines
    total: CoveredFile
    files: list[CoveredFile]   # the least covered first


@dataclass
class VariantRun:
    """One correct variant of the program, and how many of its findings did not hold."""
    variant: str               # "clang", "fma", "seeds", ...
    asked: str                 # what was asked of it
    findings: int
    alarms: list[str]          # names of those that did not hold


@dataclass
class Variants:
    """Results of scripts/variants."""
    commit: str
    runs: list[VariantRun]

    def findings(self) -> int:
        return sum(run.findings for run in self.runs)

    def alarms(self) -> int:
        return sum(len(run.alarms) for run in self.runs)


@dataclass
class Apart:
    """A case whose last state has other bits on another machine; of the cloth's size [1]."""
    case: str
    seconds: float             # when [s]
    distance: float
    bound: float | None        # what a rounding a step explains; None: not judged

    def is_explained(self) -> bool:
        return self.bound is None or self.distance <= self.bound


@dataclass
class Machine:
    name: str
    cases: int
    apart: list[Apart]


@dataclass
class Machines:
    """Results of scripts/machines."""
    commit: str
    seconds: float             # of each case that were simulated
    machines: list[Machine]

    def cases(self) -> int:
        return sum(machine.cases for machine in self.machines)

    def unexplained(self) -> int:
        every = [case for machine in self.machines for case in machine.apart]
        return sum(not case.is_explained() for case in every)


@dataclass
class Kinds:
    """How many of the judged findings bear each label that the program gave."""
    scopes: list[tuple[str, int]]
    certainties: list[tuple[str, int]]
    empirical: list[Finding]   # bounds that were measured
    judged: int

    def empirical_percent(self) -> float:
        return 100 * len(self.empirical) / self.judged if self.judged else 0.0


def kinds_of(findings: Iterable[Finding]) -> Kinds:
    """Labels of all findings that were judged against a bound; those of old files have none."""
    judged = [finding for finding in findings if finding.outcome in JUDGED]
    return Kinds(
        _counts(finding.scope for finding in judged),
        _counts(finding.certainty for finding in judged),
        [finding for finding in judged if finding.basis == "empirical"], len(judged)
    )


def _counts(labels: Iterable[str]) -> list[tuple[str, int]]:
    return [(label, count) for label, count in Counter(labels).most_common() if label]


def tolerances_of(findings: Iterable[Finding]) -> Tolerances:
    """All findings that were judged against a bound."""
    judged = [finding for finding in findings if finding.outcome in JUDGED]
    ranked = [
        Tolerance(finding, used) for finding in judged if isfinite(used := used_share(finding))
    ]
    ranked.sort(key=lambda entry: -entry.used)
    others = [finding for finding in judged if finding.bound <= 0]
    return Tolerances(
        ranked, [finding for finding in others if finding.bound == 0 and not finding.measured < 0],
        [finding for finding in others if finding.bound < 0 or finding.measured < 0]
    )


def used_share(finding: Finding) -> float:
    """The part of the bound that is used; NaN where that says nothing."""
    if not finding.bound > 0:
        return float("nan")
    return (finding.measured + finding.uncertainty) / finding.bound


def load_coverage(file: Path) -> Coverage | None:
    """The counts of `scripts/coverage --out DIR/coverage.json`; None if there are none. Throws
    Unreadable for another file."""
    if not file.is_file():
        return None
    with reading(file):
        content = json.loads(file.read_text(encoding="utf-8"))
        files = [
            _coverage_of(row["file"], row, _ranges(row["lines_missed"]))
            for row in content["files"]
            if row["lines"]
        ]
        files.sort(key=lambda row: row.lines_reached / max(row.lines, 1))
        return Coverage(
            content["commit"], content["ran"], content["least"],
            _coverage_of("all", content["total"], ""), files
        )


def load_variants(file: Path) -> Variants | None:
    """The outcomes of `scripts/variants --out DIR/variants.json`; None if there are none. Throws
    Unreadable for another file."""
    if not file.is_file():
        return None
    with reading(file):
        content = json.loads(file.read_text(encoding="utf-8"))
        runs = [
            VariantRun(
                row["variant"], " ".join(row["options"]), row["findings"],
                [alarm["name"] for alarm in row["false_alarms"]]
            )
            for row in content["runs"]
        ]
        return Variants(content.get("commit", "not recorded"), runs)


def load_machines(file: Path) -> Machines | None:
    """The outcomes of `scripts/machines --out DIR/machines.json`; None if there are none. Throws
    Unreadable for another file."""
    if not file.is_file():
        return None
    with reading(file):
        content = json.loads(file.read_text(encoding="utf-8"))
        machines = [
            Machine(
                row["machine"], row["cases"],
                [
                    Apart(case["case"], case["seconds"], case["apart"], case["bound"])
                    for case in row["apart"]
                ]
            )
            for row in content["machines"]
        ]
        return Machines(content["commit"], content["seconds"], machines)


def note_on_unfinished_run(file: Path) -> str:
    """A warning if the last run into this folder did not finish; "" if it did, or if there is no
    file. Throws Unreadable for another file."""
    if not file.is_file():
        return ""
    with reading(file):
        content = json.loads(file.read_text(encoding="utf-8"))
        waiting, begun = (
            sum(finding["outcome"] == "did not run" for finding in content["findings"]),
            content["program"]["date"],
        )
    if not waiting:
        return ""
    return (
        f"The last run into this folder, begun {begun}, did not finish: {waiting} checks,"
        " studies and cases of it have no result. What is shown here is older."
    )


def _coverage_of(name: str, row: dict, missed: str) -> CoveredFile:
    return CoveredFile(
        name, row["lines"], row["lines_reached"], row["branches"], row["branches_taken"], missed
    )


def _ranges(numbers: list[int]) -> str:
    """1, 2, 3, 7 as "1–3, 7"."""
    runs: list[list[int]] = []
    for number in numbers:
        if runs and number == runs[-1][1] + 1:
            runs[-1][1] = number
        else:
            runs.append([number, number])
    return ", ".join(str(first) if first == last else f"{first}–{last}" for first, last in runs)
