"""One page of verdict: a run as a manager, a reviewer or a pull request needs it. Counts, sorts and
looks up; decides nothing."""
from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

from data.fault_record import commits_of
from data.history import Change, RunRow, changes, in_order, margin_changes
from data.results import Fault, Finding
from data.trials import Trial
from pages.conclusions import Results, conclusions_of
from pages.counts import all_hold
from pages.hard_cases import is_of_case
from pages.sentences import Conclusion, Number, Piece, Quoted, count_of, in_words
from pages.solver_words import declined_by, details_of, facts_of, is_of_frames, verdict_on
from pages.trust import Tolerance, Tolerances

MARGINS = 5  # bounds shown
# used of a bound; from here on bounds are sharp or count exactly, so that no margin is expected
ATTAINED = 0.999
MOST_NAMED = 3  # findings or changes that are named
REFERENCE = "foldproof reference"
TESTED = {
    "subject": "subject", "commit": "commit", "tier": "tier", "date": "date", "machine": "cpu"
}


@dataclass(frozen=True)
class Margin:
    """A finding and how much of its bound is left."""

    finding: Finding
    left: Number


@dataclass(frozen=True)
class Summary:
    """All that the page of verdict says."""

    tested: list[tuple[str, str]]
    verdict: list[Piece]
    holds: bool  # every finding holds or does not apply
    asked: list[Piece]
    scope: list[Piece]
    conclusions: list[Conclusion]
    limits: list[list[Piece]]
    margins: list[Margin]
    attained: list[Piece]  # about bounds that are not among the margins
    faults: list[Piece]
    since: list[Piece]  # what changed since the last run
    details: list[tuple[str, str]] = field(default_factory=list)  # mapping, settings of a solver
    limits_title: str = "Known limits"


@dataclass(frozen=True)
class Judged:
    """What the summary is made from."""

    provenance: dict[str, Any]
    findings: list[Finding]  # all but rates of work
    faults: list[Fault]
    tolerances: Tolerances
    results: Results
    since: list[Piece]
    alone: bool  # simulations that no run of the verification made
    is_brief: bool = False  # claims are named, not told
    trial: Trial | None = None  # of another solver, or of frames


def summary_of(judged: Judged) -> Summary:
    """The summary of one run."""
    holding = [entry for entry in judged.tolerances.ranked if entry.finding.outcome == "holds"]
    ranked = [entry for entry in holding if entry.used < ATTAINED]
    summary = Summary(
        tested=_tested(judged.provenance),
        verdict=_verdict(judged),
        holds=all_hold(judged.findings),
        asked=_asked(judged),
        scope=_scope(judged),
        conclusions=conclusions_of(judged.results, judged.is_brief),
        limits=_limits(judged),
        margins=[_margin(entry) for entry in ranked[:MARGINS]],
        attained=_attained(len(holding) - len(ranked)),
        faults=_faults(judged.faults),
        since=judged.since,
    )
    return _of_solver(judged, judged.trial, summary) if judged.trial else summary


def _of_solver(judged: Judged, trial: Trial, summary: Summary) -> Summary:
    """The same of another solver: what it says of itself instead of what a verification has."""
    quoted = {one.name: judged.results.quoted(one) for one in judged.findings}
    return replace(
        summary,
        tested=facts_of(trial),
        details=[] if judged.is_brief else details_of(trial),
        verdict=verdict_on(trial, judged.findings, quoted),
        asked=[],
        limits=declined_by(judged.findings, quoted),
        limits_title="Not judged, and why",
        faults=[],
    )


def _margin(entry: Tolerance) -> Margin:
    left = Number(100 * (1 - entry.used), "%", f"finding {entry.finding.name}")
    return Margin(entry.finding, left)


def _tested(said: dict[str, Any]) -> list[tuple[str, str]]:
    """Labels and words of what was tested, those that the run stored."""
    known = {key: str(said[key]) for key in TESTED.values() if said.get(key) not in (None, "")}
    if "subject" in known:
        known["subject"] += f" {said.get('subject_version', '')}".rstrip()
    elif said.get("program"):
        known["subject"] = f"{said['program']} {said.get('version', '')}".rstrip()
    if "commit" in known:
        known["commit"] = f"{known['commit'][:10]} {said.get('tree', '')}".rstrip()
    if "cpu" in known and said.get("cores") not in (None, ""):
        known["cpu"] += f", {said['cores']} cores"
    return [(label, known[key]) for label, key in TESTED.items() if key in known]


def _verdict(judged: Judged) -> list[Piece]:
    """How many findings hold, and which do not."""
    counted = Counter(finding.outcome for finding in judged.findings)
    said: list[Piece] = [
        count_of(counted["holds"], "findings that hold"), " of ",
        count_of(len(judged.findings), "findings"), " findings hold"
    ]
    generic = sum(one.scope == "generic" and one.outcome == "holds" for one in judged.findings)
    if generic:
        said += [", ", count_of(generic, "generic findings that hold"),
                 " of them made by every case"]
    others = [
        [
            count_of(count, f"findings: {outcome}"), " ",
            "fail" if outcome == "fails" and count > 1 else Quoted(outcome, "outcomes")
        ]
        for outcome, count in counted.items()
        if outcome != "holds"
    ]
    said += ["; ", *in_words(others)] if others else []
    broken = [one for one in judged.findings if one.outcome not in ("holds", "not applicable")]
    if not broken:
        return [*said, "."]
    names = in_words([[judged.results.quoted(one)] for one in broken[:MOST_NAMED]])
    return [*said, ". Look first at ", *names, "."]


def _asked(judged: Judged) -> list[Piece]:
    """How much was asked."""
    cases = {one.name.split(".")[1] for one in judged.findings if is_of_case(one)}
    checks = [one for one in judged.findings if one.kind == "check" and not is_of_case(one)]
    counted = [
        (len(checks), "check", "checks"), (len(judged.results.studies), "study", "studies"),
        (len(cases), "case", "cases"), (len(judged.results.claims), "claim", "claims"),
    ]
    return in_words(
        [
            [count_of(count, many), f" {one if count == 1 else many}"]
            for count, one, many in counted
            if count
        ]
    )


def _scope(judged: Judged) -> list[Piece]:
    """What the run is about, and what it does not say."""
    if judged.alone:
        return [
            "These are single simulations and what was expected of them; no check of the method was"
            " run."
        ]
    if judged.provenance.get("subject") == REFERENCE:
        return [
            "This tells whether the program does what the paper describes, and where the method"
            " errs. It tells neither whether real cloth moves like this nor whether your own solver"
            " is right: for that, run ",
            Quoted("foldproof judge", "command", is_name=True),
            ".",
        ]
    if judged.trial and is_of_frames(judged.trial):
        return [
            "This tells whether the frames can be a run of this case. It tells neither whether"
            " another case would show more nor whether real cloth moves like this."
        ]
    return [
        "This tells whether the solver meets laws of cloth, where its adapter"
        " offers what they need, not whether real cloth moves like this."
    ]


def _limits(judged: Judged) -> list[list[Piece]]:
    """What restricts the conclusions."""
    limits: list[list[Piece]] = []
    apart = sum(one.outcome == "not applicable" for one in judged.findings)
    if apart:
        limits.append([
            count_of(apart, "findings that do not apply"),
            " finding does" if apart == 1 else " findings do",
            " not apply to this subject or mesh."
        ])
    ends = judged.results.rows("work-precision", "end", "particles")
    if ends:
        source = "study work-precision"
        last, particles = (max(float(row[key]) for row in ends) for key in ("end", "particles"))
        limits.append([
            "Integrators were priced on runs of at most ", Number(last, "s", source), " and ",
            Number(particles, "1", source), " particles; other runs may rank them differently."
        ])
    if judged.provenance.get("subject") == REFERENCE:
        if judged.provenance.get("tier") == "quick":
            full = Quoted("verify --tier full", "command", is_name=True)
            limits.append(["The longest cases and finest meshes need ", full, "."])
        limits.append(["Not modelled: air's added mass."])
    return limits


def _attained(count: int) -> list[Piece]:
    if not count:
        return []
    return [
        count_of(count, "bounds that are attained"),
        " more have less than " if count > 1 else " more has less than ",
        Number(100 * (1 - ATTAINED), "%", "this page"),
        " left, as is usual for sharp bounds and exact counts.",
    ]


def _faults(faults: list[Fault]) -> list[Piece]:
    """Seeded faults: caught, survived, or not run."""
    if not faults:
        return ["These results list no seeded faults."]
    counted = Counter(fault.outcome for fault in faults)
    recorded = commits_of(faults)
    run = sum(counted[outcome] for outcome in ("caught", "SURVIVED", "equivalent", "ERROR"))
    total = count_of(len(faults), "faults")
    if not run:
        return [
            total, " are" if len(faults) != 1 else " is",
            " listed; none was run with these results. Run ",
            Quoted("scripts/faults --out DIR/faults.json", "command", is_name=True), "."
        ]
    said: list[Piece] = [
        "Of ", total, " seeded faults " if len(faults) != 1 else " seeded fault ",
        count_of(counted["caught"], "faults caught"),
        " was caught, " if counted["caught"] == 1 else " were caught, ",
        count_of(counted["SURVIVED"], "faults that survived"), " survived"
    ]
    if recorded:
        said += [
            " (recorded on commit ",
            Quoted(recorded[0][0][:10], "record of faults", is_name=True),
            *([" and others"] if recorded[1:] else []), ", not with these results)"
        ]
    rest = len(faults) - run
    if counted["equivalent"]:
        said += ["; ", count_of(counted["equivalent"], "equivalent faults"), " change no result"]
    if rest:
        said += ["; ", count_of(rest, "other faults"), " were not run since they were written"]
    return [*said, "."]


def since_last(before: RunRow, now: RunRow, anchor: Callable[[str], str]) -> list[Piece]:
    """What changed from one run to the next, in words."""
    if any(before.about[key] != now.about[key] for key in ("tier", "subject")):
        return ["The earlier run is of another tier or subject: not comparable."]
    rows = in_order([before, now])
    if len(rows) < 2:
        return ["The two runs are the same run."]
    halved = margin_changes(rows)
    closer = [count_of(len(halved), "margins that halved")] if halved else ["no"]
    return [
        "Since ", Quoted(rows[0].label, "the earlier run"), ": ", *_changed(changes(rows), anchor),
        "; ", *closer, " margins halved." if halved else " margin halved."
    ]


def _changed(found: list[Change], anchor: Callable[[str], str]) -> list[Piece]:
    if not found:
        return ["no verdict and no ruling changed"]
    worse = [change for change in found if change.is_regression]
    said: list[Piece] = [
        count_of(len(worse), "changes for the worse"), " worse, ",
        count_of(len(found) - len(worse), "other changes"), " new or changed otherwise"
    ]
    if not worse:
        return said
    named = [
        Quoted(one.name, f"finding {one.name}", anchor(one.name) if one.after else "", is_name=True)
        for one in worse[:MOST_NAMED]
    ]
    return [*said, "; worse: ", *in_words([[name] for name in named])]
