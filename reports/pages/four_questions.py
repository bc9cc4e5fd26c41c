"""The four questions that the suite is for, answered by a run: each with a sentence whose numbers
are looked up in the run, and a figure of the study behind it."""
from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Protocol

from markupsafe import Markup

from data.results import Finding
from data.studies import Study
from pages.conclusions import Results
from pages.sentences import Number, Piece
from plots.plot_style import Plot


class Drawn(Protocol):
    """A study with the plots of its figures, in their order."""
    study: Study
    anchor: str
    plots: list[Plot]


@dataclass(frozen=True)
class Answer:
    """A question, its answer and a figure."""
    title: str
    words: list[Piece]
    study: str            # the study of the figure
    anchor: str           # of that study
    caption: str
    svg: Markup


# title, study and figure
FIGURES = {
    "momentum": ("Do bending forces conserve momentum?", "momentum-drift", "drift-damped"),
    "order": ("Are the integrators of second order?", "time-order.hinge", "errors-in-x"),
    "iterations": ("How many CG iterations does a solve take?", "cg-iterations", "damping"),
    "contact": ("Do forecasting and projection keep their invariants?", "forecast-time", "miss"),
}
SCHEMES = ("A", "B", "C")


def four_questions(results: Results, drawn: Iterable[Drawn]) -> list[Answer]:
    """Those that the run answers and whose figures it has."""
    views = {view.study.name: view for view in drawn}
    answer = {"momentum": _momentum, "order": _order, "iterations": _iterations,
              "contact": _contact}
    answers = []
    for key, (title, study, name) in FIGURES.items():
        words, figure = answer[key](results), _figure(views.get(study), name)
        if words and figure:
            answers.append(Answer(title, words, study, views[study].anchor, *figure))
    return answers


def _figure(view: Drawn | None, name: str) -> tuple[str, Markup] | None:
    """Title and plot, its ids apart from those of the same plot elsewhere on the page."""
    for figure, plot in zip(view.study.figures, view.plots) if view else ():
        if figure.name == name:
            apart = re.sub(r'(\bid="|url\(#|href="#)', r"\g<1>answer-", str(plot.svg))
            return figure.title, Markup(apart)  # made by matplotlib from escaped texts
    return None


def _number(finding: Finding) -> Number:
    return Number(finding.measured, finding.unit, f"finding {finding.name}")


def _worst(findings: list[Finding]) -> Number:
    return _number(max(findings, key=lambda one: one.measured))


def _least(findings: list[Finding]) -> Number:
    return _number(min(findings, key=lambda one: one.measured))


def _momentum(results: Results) -> list[Piece]:
    forces = results.named("bending.forces-sum-to-zero")
    torques = results.named("bending.torques-sum-to-zero")
    damping = results.named("bending.damping-forces-conserve-momentum")
    kept = [
        one for scheme in ("A", "B")
        for one in results.named("momentum-drift.", f"damped-angular-is-conserved.{scheme}")
    ]
    drifts = [*results.named("momentum-drift.damped-drift-order.C"),
              *results.named("strain-momentum.drift-is-first-order.")]
    if not (forces and torques and damping and kept and drifts):
        return []
    return results.guarded(
        ["Yes, to rounding. On crumpled sheets the elastic forces add up to at most ",
         _worst(forces), ", their torques to ", _worst(torques), ", damping forces to ",
         _worst(damping), ". Steps of schemes A and B keep the angular momentum of a free sheet, "
         "damped or not, to ", _worst(kept), ". Under scheme C that of a damped sheet drifts by "
         "the square of the step; at active strain limits those of A and C drift by first order."],
        [*forces, *torques, *damping, *kept, *drifts],
    )


def _order(results: Results) -> list[Piece]:
    smooth = [one for one in results.named("time-order.") if one.name.endswith((".x", ".v"))]
    of_paper = [one for one in smooth if one.name.split(".")[2] in SCHEMES]
    contact = results.named("filtered-order.contact-leaves-no-second-order.")
    limits = results.named("filtered-order.strain-limits-leave-no-second-order.")
    if not (of_paper and contact and limits):
        return []
    others = [one for one in smooth if one not in of_paper]
    return results.guarded(
        ["In smooth motion, yes: the observed orders of schemes A, B and C, in positions and "
         "velocities, with constant, alternating and random steps, are within ", _worst(of_paper),
         " of two",
         *(["; other methods are within ", _worst(others), " of their nominal orders"]
           if others else []),
         ". Not with contact, where orders are ", _least(contact), " to ", _worst(contact),
         ", nor at active strain limits, where they are ", _least(limits), " to ",
         _worst(limits), "."],
        [*smooth, *contact, *limits],
    )


def _iterations(results: Results) -> list[Piece]:
    usual = results.named("cg-iterations.fewer-than-ten")
    mesh = results.named("cg-iterations.do-not-grow-with-the-mesh")
    most = [
        row["largest"] for row in results.rows("cg-iterations", "damping ratio", "largest")
        if isinstance(row["largest"], (int, float))
    ]
    if not (usual and mesh and most):
        return []
    return results.guarded(
        ["At a damping ratio of a tenth and half the elastic limit, at most ", _worst(usual),
         ", at every tolerance tried. Heavier damping needs more, up to ",
         Number(max(most), "iterations", "study cg-iterations"),
         " in the settings tried. At a fixed damping ratio a finer mesh needs no more."],
        [*usual, *mesh],
    )


def _contact(results: Results) -> list[Piece]:
    plane = results.named("forecast-time.exact-on-a-plane")
    curved = results.named("forecast-time.second-order-on-a-")
    lands = results.named("projection.points-land-where-the-map-says")
    counted = [*results.named("projection.no-point-is-left-inside"),
               *results.named("projection.order-of-depths-is-preserved")]
    if not (plane and curved and lands and len(counted) > 1):
        return []
    return results.guarded(
        ["Yes. A point forecast to lie on a plane at rest misses it by ", _worst(plane),
         "; on balls and on moving surfaces it misses by the square of the step, in order within ",
         _worst(curved), ". Projected points reach their prescribed signed distance within ",
         _worst(lands), "; none is left inside, and the order of their depths is kept."],
        [*plane, *curved, *lands, *counted],
    )
