"""Two runs side by side: what differs in provenance, verdicts, rulings, margins and costs.
Subtracts, divides and sorts; verdicts and rulings are the words that the two runs stored."""
from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from math import inf, isfinite, log, nan
from pathlib import Path
from typing import Any

from data.quantities import ratio_of
from data.results import CaseEntry, Claim, Finding, Run, load_case, load_run
from data.studies import Study
from data.unreadable import Unreadable

# columns of studies that count work
COUNTED = ("operator applications", "evaluations", "elastic evaluations")
PROVENANCE = (
    ("subject", "subject"), ("subject version", "subject_version"), ("program", "program"),
    ("version", "version"), ("commit", "commit"), ("tree", "tree"), ("compiler", "compiler"),
    ("flags", "flags"), ("build", "build_type"), ("processor", "cpu"), ("cores", "cores"),
    ("date", "date"), ("tier", "tier"), ("seed", "seed"), ("command", "command")
)


@dataclass
class Side:
    """One of the two runs."""
    letter: str        # "A" or "B"
    given: str         # the folder or file as it was named
    run: Run
    bench: Run | None

    def findings(self) -> list[Finding]:
        """All but rates of work."""
        return [finding for finding in self.run.findings if finding.kind != "bench"]

    def rates(self) -> list[Finding]:
        """Rates of work, of bench.h5 and of the run itself."""
        return [
            finding
            for part in (self.run, self.bench)
            if part
            for finding in part.findings
            if finding.kind == "bench"
        ]


@dataclass
class Change:
    """A finding of both runs, and how many times as large its measured/bound is in B; inf where A's
    is zero, NaN where one of the two says nothing."""
    a: Finding
    b: Finding
    factor: float


@dataclass
class Cost:
    """Cost of one item in both runs."""
    what: str
    unit: str
    a: float           # [unit]
    b: float           # [unit]
    factor: float      # b/a


@dataclass
class Comparison:
    """All that the page of two runs shows."""
    a: Side
    b: Side
    provenance: list[tuple[str, Any, Any]]
    rulings: list[tuple[Claim, Claim]]      # that differ
    verdicts: list[Change]                  # whose outcome differs
    margins: list[Change]                   # whose measured/bound differs, the largest factor first
    unscaled: list[Change]                  # measured otherwise, where a ratio says nothing
    bounds: list[Change]                    # whose bound differs
    # findings of both runs that measured the same against the same bound
    unchanged: int
    seconds: list[Cost]
    work: list[Cost]
    rates: list[Cost]
    only_a: list[Finding]
    only_b: list[Finding]


def compare(a: Side, b: Side) -> Comparison:
    """Compares findings, claims, studies and cases by name."""
    both, only_a, only_b = _match(a.findings(), b.findings())
    changes = [Change(one, other, _factor_of(one, other)) for one, other in both]
    measured = [change for change in changes if not _same(change.a.measured, change.b.measured)
                or not _same(change.a.bound, change.b.bound)]
    rates, _, _ = _match(a.rates(), b.rates())
    claims, _, _ = _match(a.run.claims, b.run.claims)
    return Comparison(
        a,
        b,
        provenance=[
            (label, a.run.provenance.get(key, ""), b.run.provenance.get(key, ""))
            for label, key in PROVENANCE
            if key in a.run.provenance or key in b.run.provenance
        ],
        rulings=[(one, other) for one, other in claims if one.ruling != other.ruling],
        verdicts=[change for change in changes if change.a.outcome != change.b.outcome],
        margins=sorted(
            (
                change
                for change in measured
                if change.factor == change.factor and change.factor != 1.0
            ),
            key=lambda change: -_size(change.factor),
        ),
        unscaled=[
            change
            for change in measured
            if change.factor != change.factor and not _same(change.a.measured, change.b.measured)
        ],
        bounds=[
            change
            for change in measured
            if not _same(change.a.bound, change.b.bound) or change.a.unit != change.b.unit
        ],
        unchanged=len(changes) - len(measured),
        seconds=_by_factor(_seconds(a, b)),
        work=_by_factor(_work(a, b)),
        rates=_by_factor(
            Cost(
                one.claim, one.unit, one.measured, other.measured,
                ratio_of(other.measured, one.measured)
            )
            for one, other in rates
            if one.unit == other.unit
        ),
        only_a=only_a,
        only_b=only_b,
    )


def read_side(letter: str, given: Path) -> Side:
    """A run from its folder or its file. Throws Unreadable if it is none."""
    file = given / "run.h5" if given.is_dir() else given
    bench = file.parent / "bench.h5"
    run = load_run(file)
    if not (run.findings or run.studies or run.claims):
        raise Unreadable(
            f"{file}: no run of foldproof: it holds no findings, no studies and no claims"
        )
    beside = load_run(bench) if bench.is_file() and bench != file else None
    return Side(letter, str(given), run, beside)


def _match(
    a: Iterable[Any], b: Iterable[Any]
) -> tuple[list[tuple[Any, Any]], list[Any], list[Any]]:
    """Items in both, by name, in B's order; items only in A; items only in B."""
    of_a, of_b = ({item.name: item for item in items} for items in (a, b))
    return ([(of_a[name], item) for name, item in of_b.items() if name in of_a],
            [item for name, item in of_a.items() if name not in of_b],
            [item for name, item in of_b.items() if name not in of_a])


def _same(one: float, other: float) -> bool:
    return one == other or (one != one and other != other)


def _factor_of(a: Finding, b: Finding) -> float:
    before, after = ratio_of(a.measured, a.bound), ratio_of(b.measured, b.bound)
    if before != before or after != after:
        return nan
    return 1.0 if before == after else inf if before == 0 else after / before


def _size(factor: float) -> float:
    """How far a factor is from one, up or down alike; NaN last."""
    if factor != factor:
        return -1.0
    return abs(log(factor)) if isfinite(factor) and factor > 0 else inf


def _by_factor(costs: Iterable[Cost]) -> list[Cost]:
    return sorted(costs, key=lambda cost: -_size(cost.factor))


def _pair(what: str, unit: str, a: float, b: float) -> Cost:
    return Cost(what, unit, a, b, 1.0 if a == b else ratio_of(b, a))


def _seconds(a: Side, b: Side) -> Iterable[Cost]:
    """Time of the whole run, of each study, of each case."""
    whole = [float(side.run.provenance.get("seconds", nan)) for side in (a, b)]
    yield _pair("the whole run", "s", *whole)
    for kind, items in (
        ("study", lambda side: side.run.studies),
        ("case", lambda side: side.run.cases),
    ):
        for one, other in _match(items(a), items(b))[0]:
            if one.seconds == one.seconds and other.seconds == other.seconds:
                yield _pair(f"{kind} {one.name}", "s", one.seconds, other.seconds)


def _work(a: Side, b: Side) -> Iterable[Cost]:
    """Counted work: columns of studies that count it, added up; steps and iterations of cases."""
    for one, other in _match(a.run.studies, b.run.studies)[0]:
        yield from _pairs(one.name, _work_of_study, one, other)
    for one, other in _match(a.run.cases, b.run.cases)[0]:
        yield from _pairs(f"case {one.name}", _work_of_case, one, other)


def _pairs(
    name: str, count: Callable[[Any], dict[str, float]], one: Any, other: Any
) -> Iterable[Cost]:
    before, after = count(one), count(other)
    for what in before:
        if what in after:
            yield _pair(f"{name}: {what}", "1", before[what], after[what])


def _work_of_study(study: Study) -> dict[str, float]:
    """Sums of all numbers of a table's column; what was not measured is left out."""
    found: dict[str, float] = {}
    for table in study.tables:
        for column in table.columns:
            if column.name.replace("_", " ") in COUNTED and column.values.dtype.kind == "f":
                numbers = column.values[column.values == column.values]
                found[f"{column.name.replace('_', ' ')}, {table.title}"] = float(numbers.sum())
    return found


def _work_of_case(entry: CaseEntry) -> dict[str, float]:
    """Steps and iterations of conjugate gradients; none where its file is not there."""
    try:
        rows = load_case(entry.path).diagnostics
    except Unreadable:
        return {}
    found = {"steps": float(len(rows["time"].values))} if "time" in rows else {}
    return found | ({"iterations of conjugate gradients": float(rows["cg_iterations"].values.sum())}
                    if "cg_iterations" in rows else {})
