"""The four questions that the suite is for, answered by a run: each with a sentence whose numbers
are looked up in the run, and a figure of the study behind it."""
from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Protocol

from markupsafe import Markup

from data.results import Finding, Study
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
    svg: Markup


# title, study and figure
FIGURES = {
    "momentum": ("Do bending forces conserve momentum?", "momentum-drift", "drift-undamped"),
    "order": ("Is each integrator as accurate as it claims?", "time-order.hinge", "errors-in-x"),
    "iterations": ("How many iterations does a solve take?", "cg-iterations", "tolerance"),
    "contact": ("Do forecasts and projection do what they promise?", "wrinkle-preservation",
                "profile-blend"),
}
SCHEMES = ("A", "B", "C")


def four_questions(results: Results, drawn: Iterable[Drawn]) -> list[Answer]:
    """Those that the run answers and whose figures it has."""
    views = {view.study.name: view for view in drawn}
    words = {"momentum": _momentum, "order": _order, "iterations": _iterations,
             "contact": _contact}
    answers = []
    for key, (title, study, figure) in FIGURES.items():
        said, svg = words[key](results), _figure(views.get(study), figure)
        if said and svg:
            answers.append(Answer(title, said, study, views[study].anchor, svg))
    return answers


def _figure(view: Drawn | None, name: str) -> Markup | None:
    """The plot, its ids apart from those of the same plot elsewhere on the page."""
    for figure, plot in zip(view.study.figures, view.plots) if view else ():
        if figure.name == name:
            apart = re.sub(r'(\bid="|url\(#|href="#)', r"\g<1>answer-", str(plot.svg))
            return Markup(apart)  # made by matplotlib from escaped texts
    return None


def _number(finding: Finding) -> Number:
    return Number(finding.measured, finding.unit, f"finding {finding.name}")


def _worst(findings: list[Finding]) -> Number:
    return _number(max(findings, key=lambda one: one.measured))


def _momentum(results: Results) -> list[Piece]:
    forces = results.named("bending.forces-sum-to-zero")
    torques = results.named("bending.torques-sum-to-zero")
    drift = results.named("momentum-drift.linear-is-conserved")
    turning = [
        one for one in results.named("momentum-drift.undamped-angular-is-conserved.")
        if one.name.rsplit(".", 1)[1] in SCHEMES
    ]
    if not (forces and torques and drift and turning):
        return []
    return results.guarded(
        ["Yes, to rounding. On crumpled sheets the forces add up to at most ", _worst(forces),
         ", their torques to ", _worst(torques),
         ". Over whole runs, under every integrator, linear momentum drifts by at most ",
         _worst(drift), "; angular momentum (figure), under schemes A, B and C, by at most ",
         _worst(turning), "."],
        [*forces, *torques, *drift, *turning],
    )


def _order(results: Results) -> list[Piece]:
    of_all = [one for one in results.named("time-order.hinge.") if one.name.endswith((".x", ".v"))]
    of_paper = [one for one in of_all if one.name.split(".")[2] in SCHEMES]
    if not of_paper:
        return []
    others = [one for one in of_all if one not in of_paper]
    return results.guarded(
        ["Yes. With constant, alternating and random steps, the observed orders of schemes A, B "
         "and C differ from two by at most ", _worst(of_paper),
         *([", those of all other methods from their own by at most ", _worst(others)]
           if others else []), "."],
        of_all,
    )


def _iterations(results: Results) -> list[Piece]:
    usual = results.named("cg-iterations.fewer-than-ten")
    mesh = results.named("cg-iterations.do-not-grow-with-the-mesh")
    if not (usual and mesh):
        return []
    return results.guarded(
        ["At most ", _worst(usual), " of conjugate gradients, at a damping ratio of a tenth and "
         "half the elastic limit, at every tolerance tried. Finer meshes need no more."],
        [*usual, *mesh],
    )


def _contact(results: Results) -> list[Piece]:
    forecast = results.named("forecast-time.exact-on-a-plane")
    lands = results.named("projection.points-land-where-the-map-says")
    waves = results.named("wrinkle-preservation.wavelength-is-preserved")
    if not (forecast and lands and waves):
        return []
    return results.guarded(
        ["Yes. A point forecast to lie on a plane misses it by ", _worst(forecast),
         ". Projected points land within ", _worst(lands),
         " of the depth that the map gives them, and wrinkles keep their wavelength within ",
         _worst(waves), "."],
        [*forecast, *lands, *waves],
    )
