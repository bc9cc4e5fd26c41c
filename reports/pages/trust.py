"""How far to trust the run: margins of all bounds, and what scripts beside the run found: lines
that are reached, correct variants, other machines, random slips. Sorts and counts; decides
nothing."""
from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from typing import Any

from data.mutation_scores import MutationPage, Score, load_mutation_page, load_planted_sets
from data.records import record
from data.results import Finding
from data.unreadable import read_json
from pages.section import Section, Source

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
class Covered:
    """Lines and branches of one source file of the method, or of all."""
    lines: int
    lines_reached: int
    branches: int
    branches_taken: int
    file: str = ""
    lines_missed: list[int] | tuple[()] = ()

    @property
    def missed(self) -> str:
        """Lines that never ran: "1–3, 7"."""
        runs: list[list[int]] = []
        for number in self.lines_missed:
            if runs and number == runs[-1][1] + 1:
                runs[-1][1] = number
            else:
                runs.append([number, number])
        return ", ".join(str(first) if first == last else f"{first}–{last}" for first, last in runs)


@dataclass
class Coverage:
    """Results of scripts/coverage."""
    commit: str
    ran: str
    least: float               # percent of lines
    total: Covered
    files: list[Covered]       # the least covered first


@dataclass
class VariantRun:
    """One correct variant of the program, and how many of its findings did not hold."""
    variant: str               # "clang", "fma", "seeds", ...
    options: list[str]         # what was asked of it
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
    """A case whose last state has other bits on another machine."""
    case: str
    seconds: float             # when [s]
    apart: float               # of the cloth's size [1]
    bound: float | None        # what a rounding a step explains, likewise; None: not judged


@dataclass
class Machine:
    machine: str               # its name
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
        return sum(case.bound is not None and not case.apart <= case.bound for case in every)


@dataclass
class Mutation:
    """Results of scripts/mutate: a row for each file, and the mutants that no finding caught."""
    seed: int
    rows: list[dict[str, Any]]
    survivors: list[dict[str, Any]]


@dataclass
class Kinds:
    """How many of the judged findings bear each label that the program gave."""
    scopes: list[tuple[str, int]]
    certainties: list[tuple[str, int]]
    empirical: list[Finding]   # bounds that were measured
    judged: int

    def empirical_percent(self) -> float:
        return 100 * len(self.empirical) / self.judged if self.judged else 0.0


@dataclass
class Trust:
    """What the section shows beside the faults and bounds of the run; None: it is not there."""
    coverage: Coverage | None
    variants: Variants | None
    machines: Machines | None
    mutation: Mutation | None
    mutants: MutationPage | None  # random slips, from the shipped scores
    planted: list[Score]  # slips in solvers, from the shipped scores
    kinds: Kinds


def kinds_of(findings: Iterable[Finding]) -> Kinds:
    """Labels of all findings that were judged against a bound."""
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


def read_trust(source: Source) -> Trust:
    """Throws Unreadable for a file that is not what its name says."""
    def beside(name: str, make: Any) -> Any:
        return read_json(source.folder / f"{name}.json", make)
    return Trust(
        beside("coverage", _coverage), beside("variants", _variants), beside("machines", _machines),
        beside("mutation", _mutation), load_mutation_page() if source.shipped else None,
        load_planted_sets() if source.shipped else [], kinds_of(source.run.findings)
    )


def _coverage(said: dict[str, Any]) -> Coverage:
    files = [record(Covered, row, lines_missed=row["lines_missed"]) for row in said["files"]]
    files = sorted(
        (row for row in files if row.lines), key=lambda row: row.lines_reached / row.lines
    )
    return record(Coverage, said, total=record(Covered, said["total"]), files=files)


def _variants(said: dict[str, Any]) -> Variants:
    return Variants(
        said.get("commit", "not recorded"),
        [
            record(VariantRun, row, alarms=[alarm["name"] for alarm in row["false_alarms"]])
            for row in said["runs"]
        ],
    )


def _machines(said: dict[str, Any]) -> Machines:
    return record(
        Machines, said,
        machines=[
            record(Machine, row, apart=[record(Apart, case) for case in row["apart"]])
            for row in said["machines"]
        ],
    )


def _mutation(said: dict[str, Any]) -> Mutation:
    survivors = [row for row in said["mutants"] if row["outcome"] == "SURVIVED"]
    return Mutation(said["seed"], said["files"], survivors)


def note_on_unfinished_run(file: Path) -> str:
    """A warning if the last run into this folder did not finish; "" if it did, or if there is no
    file. Throws Unreadable for another file."""
    def note(said: dict[str, Any]) -> str:
        waiting = sum(finding["outcome"] == "did not run" for finding in said["findings"])
        begun = said["program"]["date"]
        if not waiting:
            return ""
        return (
            f"The last run into this folder, begun {begun}, did not finish: {waiting} checks,"
            " studies and cases of it have no result. What is shown here is older."
        )
    return read_json(file, note) or ""


def _is_shown(page: Any) -> bool:
    trust = page.parts["faults"]
    found = (trust.mutants, trust.mutation, trust.variants, trust.machines, trust.coverage)
    return not page.trial and bool(page.faults or page.tolerances.ranked or any(found))


SECTION = Section("faults", "Faults, bounds, coverage", _is_shown, "Faults", read_trust)
