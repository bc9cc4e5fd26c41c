"""Five conclusions of a run in plain English. Each is a sentence whose numbers are looked up in the
run; it is made only where the findings that it rests on are there, and says so
where one of them does not hold."""
from __future__ import annotations

from collections.abc import Callable, Iterable
from math import isfinite

from data.results import Finding
from data.studies import Study
from pages.answers import cheapest_of, rows_of
from pages.ledger import ClaimView, count_rulings
from pages.sentences import Conclusion, Number, Piece, Quoted, in_words

MOST_REFUTED = 4           # claims that are quoted


class Results:
    """What a run found, by name."""

    def __init__(
        self, findings: Iterable[Finding], studies: Iterable[Study], claims: Iterable[ClaimView],
        anchor: Callable[[str], str]
    ) -> None:
        self.findings = {finding.name: finding for finding in findings}
        self.studies = {study.name: study for study in studies}
        self.claims = list(claims)
        self.anchor = anchor

    def named(self, start: str, end: str = "") -> list[Finding]:
        """Findings by the ends of their names; those that were not applicable left out."""
        return [
            finding
            for name, finding in self.findings.items()
            if name.startswith(start) and name.endswith(end) and finding.outcome != "not applicable"
        ]

    def rows(self, study: str, *columns: str) -> list[dict[str, object]]:
        """Rows of the first table of a study that has these columns; none if there is none."""
        tables = self.studies[study].tables if study in self.studies else []
        return next(
            (rows for table in tables if (rows := rows_of(table)) and set(columns) <= set(rows[0])),
            [],
        )

    def guarded(self, pieces: list[Piece], rests_on: Iterable[Finding]) -> list[Piece]:
        """The sentence; if a finding that it rests on does not hold,
        that instead. Nothing without any."""
        found = list(rests_on)
        broken = [finding for finding in found if finding.outcome != "holds"]
        if not found:
            return []
        if broken:
            return [
                "Not shown by this run: ", self.quoted(broken[0]),
                f" {broken[0].outcome or 'has no outcome'}. "
            ]
        return pieces

    def quoted(self, finding: Finding) -> Quoted:
        return Quoted(
            finding.name, f"finding {finding.name}", self.anchor(finding.name), is_name=True
        )


def conclusions_of(results: Results, is_brief: bool = False) -> list[Conclusion]:
    """The conclusions that the run allows. Brief ones name claims and do not tell them."""
    made = (
        _paper(results, is_brief),
        *(make(results) for make in (_integrator, _steps, _mesh, _contact)),
    )
    return [conclusion for conclusion in made if conclusion]


def _paper(results: Results, is_brief: bool) -> Conclusion | None:
    """How many claims hold, and which do not."""
    if not results.claims:
        return None
    counted = dict(count_rulings(view.claim for view in results.claims))
    parts = [
        [
            Number(count, "1", f"claims that are {ruling}"), " is " if count == 1 else " are ",
            Quoted(ruling, "rulings")
        ]
        for ruling, count in counted.items()
    ]
    refuted = [view.claim for view in results.claims if view.claim.ruling == "refuted"]
    told = [
        [
            Quoted(claim.name, f"claim {claim.name}", results.anchor(claim.name), is_name=True),
            *([] if is_brief else [" ", Quoted(claim.statement, f"claim {claim.name}")]),
        ]
        for claim in refuted[:MOST_REFUTED]
    ]
    if len(refuted) > MOST_REFUTED:
        told.append([Number(len(refuted) - MOST_REFUTED, "1", "claims that are refuted"), " more"])
    end = ". " if is_brief or len(refuted) > MOST_REFUTED else " "
    rest = (
        ["Refuted: ", *in_words(told, *((", ", " and ") if is_brief else (" ", " "))), end]
        if refuted
        else []
    )
    return Conclusion(
        [
            "Of ", Number(len(results.claims), "1", "claims"),
            " claims " if len(results.claims) > 1 else " claim ", *in_words(parts), "."
        ],
        rest,
        ["Read a claim's condition before relying on it."],
    )


def _integrator(results: Results) -> Conclusion | None:
    """The cheapest methods, and scheme C against them."""
    cheapest = cheapest_of(results.studies.values())
    if not cheapest:
        return None
    source = "study work-precision"
    error = Number(cheapest.errors[0], cheapest.unit, source)
    rows = [(scene, choices[0]) for scene, choices in cheapest.rows if choices[0]]
    factors = [
        1.0 if choice.method == "C" else dict(choice.others).get("C", float("nan"))
        for _, choice in rows
    ]
    known = [factor for factor in factors if isfinite(factor)]
    if not known:
        return None
    winners = dict.fromkeys((choice.method, *choice.tied) for _, choice in rows)
    is_one_best = bool(set.intersection(*(set(winner) for winner in winners)))
    picks = [
        [
            *in_words([[Quoted(method, source, is_name=True)] for method in winner]),
            " tied on " if len(winner) > 1 else " on ",
            *in_words(
                [
                    [Quoted(scene, source)]
                    for scene, choice in rows
                    if (choice.method, *choice.tied) == winner
                ]
            ),
        ]
        for winner in winners
    ]
    next_best = [
        choice.others[0][1] for _, choice in rows if choice.others and isfinite(choice.others[0][1])
    ]
    rest: list[Piece] = ["Cheapest: ", *in_words(picks, between="; ", last="; ")]
    if next_best:
        rest += ["; the next best costs ", *_range(next_best, source), " times as much"]
    missed = len(factors) - len(known)
    more: list[Piece] = (
        [", and misses it on ", Number(missed, "1", source), " of "] if missed else [" on "]
    )
    return Conclusion(
        [
            "" if is_one_best else "No integrator is cheapest everywhere: ", "scheme C costs ",
            *_range(known, source), " times the cheapest for ", error, " error", *more,
            Number(len(rows), "1", source), " motions."
        ],
        [*rest, ". "],
        [
            "Price your own case with ",
            Quoted("foldproof precision CASE", "command", is_name=True), "."
        ],
    )


def _range(values: list[float], source: str) -> list[Piece]:
    low, high = Number(min(values), "1", source), Number(max(values), "1", source)
    return [low] if low.value == high.value else [low, " to ", high]


def _steps(results: Results) -> Conclusion | None:
    """Steps that a damped sheet needs, and what alternating them does."""
    rows = results.rows("stability-sheet", "width of a cell", "schemes A and B")
    if not rows:
        return None
    finest = min(rows, key=lambda row: float(row["width of a cell"]))
    source = "study stability-sheet"
    explicit = [
        float(value)
        for name, value in finest.items()
        if name not in ("width of a cell", "schemes A and B")
    ]
    headline = results.guarded(["Damping does not shorten the stable step of schemes A and B."],
                               results.named("stability-sheet.limit-does-not-depend-on-damping."))
    resonance = results.guarded(
        ["Without damping, alternating between two stable steps can be unstable. "],
        results.named("variable-step-stability.alternating-steps-resonate."),
    )
    if not headline or not explicit:
        return None
    return Conclusion(
        headline,
        [
            "With cells of ", Number(float(finest["width of a cell"]), "1", source),
            " of a side, they take ", Number(float(finest["schemes A and B"]), "1", source),
            " steps in a unit of time, and explicit methods ", *_range(explicit, source), ". ",
            *resonance
        ],
        ["Use a constant step for undamped cloth."] if resonance else [],
    )


def _mesh(results: Results) -> Conclusion | None:
    """The mesh's error against the step's, and bending that depends on the pattern."""
    cells, mesh, step = "cells along a side", "error of the mesh", "error of the step"
    rows = results.rows("mesh-error", cells, mesh, step)
    headline = results.guarded(["On a smooth motion the mesh, not the step, sets the error."],
                               results.named("mesh-error.usual-step-error-is-below-a-tenth-of-it"))
    if not rows or not headline:
        return None
    finest = max(rows, key=lambda row: float(row[cells]))
    source = "study mesh-error"
    rest: list[Piece] = [
        "With ", Number(float(finest[cells]), "1", source), " cells a side the mesh errs by ",
        Number(float(finest[mesh]), "%", source), ", the step by ",
        Number(float(finest[step]), "%", source), ". "
    ]
    patterns = results.rows("bending-rigidity", "least", "greatest")
    if patterns:
        source = "study bending-rigidity"
        low, high = min(float(row["least"]) for row in patterns), max(
            float(row["greatest"]) for row in patterns
        )
        rest += results.guarded(
            [
                "Bending stiffness depends on the triangles' pattern and direction, from ",
                Number(low, "1", source), " to ", Number(high, "ke", source), ". "
            ],
            results.named("bending-rigidity.depends-on-"),
        )
    return Conclusion(headline, rest, ["Calibrate bending on the mesh that you use."])


def _contact(results: Results) -> Conclusion | None:
    """Crossings and depth inside objects."""
    never = results.named("case.", ".never-crosses-itself")
    headline = results.guarded(["Cloth crosses itself in no stored frame."],
                               never + results.named("crossing-queries.no-meeting-is-missed."))
    if not never:
        return None
    rest: list[Piece] = [
        "In ",
        Number(sum(one.outcome == "holds" for one in never), "1", "findings never-crosses-itself"),
        " of ", Number(len(never), "1", "findings never-crosses-itself"),
        " cases that promise it, decided exactly. "
    ]
    kept = {finding.name.rsplit(".", 1)[0] for finding in never}
    others = [
        finding
        for finding in results.named("case.", ".ends-untangled")
        if finding.name.rsplit(".", 1)[0] not in kept
    ]
    if others:
        rest += results.guarded(
            [
                Number(len(others), "1", "findings ends-untangled"),
                " more may cross on the way and end untangled. "
            ],
            others,
        )
    asked = results.rows("crossing-queries", "asked", "missed")
    if asked:
        total = {
            key: Number(sum(float(row[key]) for row in asked), "1", "study crossing-queries")
            for key in ("asked", "missed")
        }
        rest += [
            total["missed"], " of ", total["asked"],
            " queries of a moving vertex and triangle, or two edges, missed a crossing. "
        ]
    outside = results.named("case.", ".stays-outside")
    if outside:
        deepest = max(outside, key=lambda one: one.measured)
        rest += results.guarded(
            [
                "In ", Number(len(outside), "1", "findings stays-outside"),
                " cases that promise to stay outside objects, no particle is deeper than ",
                Number(deepest.measured, deepest.unit, f"finding {deepest.name}"),
                ". "
            ],
            outside,
        )
    rest += results.guarded(["A pin thinner than an edge passes through. "],
                            results.named("pointwise-contact.a-thin-pin-passes-through"))
    return Conclusion(headline, rest, ["Keep edges shorter than an object's details."])
