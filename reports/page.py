"""Puts what was read and drawn into the page. Groups, counts and sorts for display; decides nothing."""
from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from math import isnan, log10
from pathlib import Path
from typing import Any

import numpy as np
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

import ledger
import quantities
from case_pictures import PictureRow, length_text
from field_pictures import FieldView
from kill_matrix import Mutation, kill_tables
from ledger import ClaimView
from map_plots import map_notes
from plot_style import Plot, level_text
from point_marks import has_mark
from results import Case, CaseEntry, Column, Fault, Finding, Run, Study, StudyFigure
from study_plots import choose_pens, floors_below, key_svg, points_left_out
from trust import Coverage, Tolerances, Variants

FOLDER = Path(__file__).resolve().parent
OUTCOMES = ("holds", "fails", "inconclusive", "not applicable")
WHOLE_TABLE, WHOLE_STUDY_TABLE = 12, 60   # rows; longer tables show FIRST_ROWS and LAST_ROWS
FIRST_ROWS, LAST_ROWS = 7, 3
FIRST_STUDIES = ("work-precision", "stability-oscillator", "stability-sheet", "variable-step-stability")
MARGIN_DECADES = (-4.0, 1.0)        # log10(measured / bound) at the ends of the margin bar


@dataclass
class CaseView:
    """A case with its pictures and plots; `problem` says why there are none."""
    entry: CaseEntry
    anchor: str
    case: Case | None = None
    row: PictureRow | None = None
    turning: FieldView | None = None
    plots: list[tuple[str, Plot]] = field(default_factory=list)
    problem: str = ""
    foreign: str = ""               # why the file is not the one that the run wrote


@dataclass
class StudyView:
    """A study with its plots, in the order of its figures and of its maps, and its findings."""
    study: Study
    anchor: str
    plots: list[Plot]
    maps: list[Plot]
    findings: list[Finding]


@dataclass
class Page:
    """All that the template shows."""
    provenance: dict[str, Any]
    claims: list[ClaimView]
    checks: list[Finding]
    studies: list[StudyView]
    other_findings: list[Finding]   # of studies or kinds that have no section of their own
    cases: list[CaseView]
    rates: list[Finding]
    bench_studies: list[StudyView]
    bench_provenance: dict[str, Any]
    faults: list[Fault]
    tolerances: Tolerances
    coverage: Coverage | None = None
    variants: Variants | None = None
    unended: str = ""               # why this is not what was run last
    mutation: Mutation | None = None   # what scripts/mutate found, where that lies beside the run

    def first_studies(self) -> list[StudyView]:
        """The studies that help to choose an integrator, in the order of FIRST_STUDIES."""
        wanted = [view for view in self.studies if view.study.name in FIRST_STUDIES]
        return sorted(wanted, key=lambda view: FIRST_STUDIES.index(view.study.name))

    def other_studies(self) -> list[StudyView]:
        """All other studies, as the run lists them."""
        return [view for view in self.studies if view.study.name not in FIRST_STUDIES]


def render(page: Page) -> str:
    """The whole report as one HTML text."""
    environment = Environment(loader=FileSystemLoader(FOLDER), autoescape=True, undefined=StrictUndefined,
                              trim_blocks=True, lstrip_blocks=True)
    environment.filters.update(number=quantities.number_html, unit=quantities.unit_text,
                               seconds=quantities.seconds_html, bar_length=length_text)
    environment.globals.update(
        quantity=quantities.quantity_html, ratio=quantities.ratio_of, isnan=isnan, anchor=Anchors().of,
        outcome_class=outcome_class, counts=count_outcomes, groups=group_by_prefix, margin=margin_percent,
        table=shown_rows, whole_study_table=WHOLE_STUDY_TABLE, whole_table=WHOLE_TABLE, orders=order_table, keys=figure_keys, notes=figure_notes, map_notes=map_notes,
        rulings=ledger.ruling_counts, sections=ledger.by_section, style=Markup(_style()), viewer=Markup(_viewer()),
        known_faults={fault.name: fault for fault in page.faults}, caught=CaughtCount(page.faults),
        kill_tables=kill_tables(page.faults),
        known_findings={finding.name for finding in _all_findings(page)})
    return environment.get_template("page.html.j2").render(page=page, said=page.provenance)


def _all_findings(page: Page) -> list[Finding]:
    of_studies = [finding for view in page.studies + page.bench_studies for finding in view.findings]
    return page.checks + of_studies + page.other_findings + page.rates


class Anchors:
    """Permanent ids: a name is its own anchor where HTML allows; the same name gets the same anchor each
    time."""

    def __init__(self) -> None:
        self._taken: dict[str, str] = {}

    def of(self, name: str) -> str:
        """The anchor of a name."""
        wanted = re.sub(r"[^\w.\-]+", "-", name).strip("-") or "unnamed"
        while self._taken.setdefault(wanted, name) != name:
            wanted += "-2"
        return wanted


class CaughtCount:
    """How many of a finding's seeded faults were caught; None where the run's folder has no outcomes."""

    def __init__(self, faults: list[Fault]) -> None:
        self._caught = {fault.name for fault in faults if fault.outcome == "caught"}
        self.known = any(fault.outcome in ("caught", "SURVIVED") for fault in faults)

    def of(self, finding: Finding) -> int:
        """How many of the faults that name this finding were caught."""
        return sum(name in self._caught for name in finding.faults)


def outcome_class(outcome: str) -> str:
    """The CSS class of an outcome."""
    return re.sub(r"[^a-z]+", "-", outcome.lower()).strip("-") or "unknown"


def count_outcomes(findings: Iterable[Finding]) -> list[tuple[str, int]]:
    """How many findings have each outcome; the four usual ones always, others where they occur."""
    counted = Counter(finding.outcome for finding in findings)
    others = sorted(set(counted) - set(OUTCOMES))
    return [(outcome, counted[outcome]) for outcome in (*OUTCOMES, *others)]


def group_by_prefix(findings: Iterable[Finding]) -> list[tuple[str, list[Finding]]]:
    """Findings by the part of their name before the first dot, groups in the order of their first member."""
    grouped: dict[str, list[Finding]] = {}
    for finding in findings:
        grouped.setdefault(finding.name.split(".")[0], []).append(finding)
    return list(grouped.items())


def margin_percent(finding: Finding) -> float | None:
    """Length of the margin bar in percent, on a logarithmic scale; None where measured/bound says nothing."""
    ratio = quantities.ratio_of(finding.measured, finding.bound)
    if isnan(ratio):
        return None
    low, high = MARGIN_DECADES
    return 100.0 * min(max((log10(max(ratio, 1e-300)) - low) / (high - low), 0.0), 1.0)


@dataclass
class ShownTable:
    """A table ready to be set: heads with units, the rows shown first and last, and how many lie between."""
    heads: list[tuple[str, str, bool]]   # name, unit, whether it holds numbers
    first: list[tuple[Markup, ...]]
    left_out: int
    last: list[tuple[Markup, ...]]


def shown_rows(columns: list[Column], most: int = WHOLE_TABLE) -> ShownTable:
    """What is shown of a table, all of it up to `most` rows; vectors are set as one column for each component."""
    flat = [part for column in columns for part in _components(column)]
    count = max((len(column.values) for column in flat), default=0)
    whole = count <= most
    kept = [*range(count)] if whole else [*range(FIRST_ROWS), *range(count - LAST_ROWS, count)]
    cells = [quantities.cells_html(column.values[row] if row < len(column.values) else "" for row in kept)
             for column in flat]
    rows = list(zip(*cells))
    cut = len(rows) if whole else FIRST_ROWS
    heads = [(column.name.replace("_", " "), column.unit, column.values.dtype.kind == "f") for column in flat]
    return ShownTable(heads, rows[:cut], count - len(rows), rows[cut:])


def _components(column: Column) -> list[Column]:
    if column.values.ndim == 1:
        return [column]
    flat = column.values.reshape(len(column.values), -1)
    names = "xyz" if flat.shape[1] == 3 else [str(k + 1) for k in range(flat.shape[1])]
    return [Column(f"{column.name} {name}", column.unit, flat[:, k]) for k, name in enumerate(names)]


@dataclass
class OrderTable:
    """Observed orders under a plot: one row for each curve, beginning with its key."""
    heads: list[str]
    rows: list[tuple[Markup, str, list[Markup]]]


def order_table(figure: StudyFigure) -> OrderTable | None:
    """The observed order of every pair of points, as the program wrote them; None if it wrote none."""
    with_orders = [curve for curve in figure.curves if curve.pair_orders is not None
                   and len(curve.pair_orders)]
    if not with_orders:
        return None
    widest = max(with_orders, key=lambda curve: len(curve.pair_orders))
    shared = all(len(curve.x) == len(widest.x) and np.allclose(curve.x, widest.x, equal_nan=True)
                 for curve in with_orders)
    heads = [f"{level_text(a)} – {level_text(b)}" if shared else f"pair {k + 1}"
             for k, (a, b) in enumerate(zip(widest.x[:-1], widest.x[1:]))][:len(widest.pair_orders)]
    rows = []
    for curve, pen in zip(figure.curves, choose_pens(figure.curves)):
        orders = curve.pair_orders if curve.pair_orders is not None else []
        cells = [quantities.order_html(order) for order in orders]
        rows.append((key_svg(pen), curve.label, cells + [Markup("")] * (len(heads) - len(cells))))
    return OrderTable(heads, rows)


def figure_keys(figure: StudyFigure) -> list[tuple[Markup, str]]:
    """Key and label of every curve, for screens too narrow for the plot's own labels."""
    return [(key_svg(pen), curve.label) for curve, pen in zip(figure.curves, choose_pens(figure.curves))]


def figure_notes(figure: StudyFigure) -> list[str]:
    """What a reader of the plot must know and cannot see."""
    notes = []
    left_out, floors = points_left_out(figure), floors_below(figure)
    if left_out:
        logarithmic = "log" in (figure.x_scale, figure.y_scale)
        what = "NaN, infinite, or not positive on a logarithmic axis" if logarithmic else "NaN or infinite"
        notes.append(f"{left_out} point{'s' if left_out > 1 else ''} not drawn ({what}).")
    if any(has_mark(curve, "unfinished").any() for curve in figure.curves):
        notes.append("Hollow: a solve on the way of that run did not finish.")
    if floors:
        plural = "s" if len(floors) > 1 else ""
        notes.append(f"Noise floor of {len(floors)} curve{plural} below the plot: at most "
                     f"{quantities.number_text(max(floors))} {quantities.unit_text(figure.y_unit)}.")
    return notes


def findings_by_section(run: Run, bench: Run | None) -> tuple[list[Finding], list[Finding], list[Finding]]:
    """Checks; findings that no section of a study shows; rates of work."""
    known = {study.name for study in run.studies + (bench.studies if bench else [])}
    findings = run.findings + (bench.findings if bench else [])
    checks = [finding for finding in findings if finding.kind == "check"]
    rates = [finding for finding in findings if finding.kind == "bench"]
    others = [finding for finding in findings if finding.kind not in ("check", "bench")
              and finding.study not in known]
    return checks, others, rates


def faults_of(run: Run) -> list[Fault]:
    """The seeded faults of the run; where it lists none, the names that its findings mention."""
    if run.faults:
        return run.faults
    mentioned: dict[str, list[str]] = {}
    for finding in run.findings:
        for fault in finding.faults:
            mentioned.setdefault(fault, []).append(finding.name)
    return [Fault(name, "", "", "", "", caught_by, "not run") for name, caught_by in mentioned.items()]


def _style() -> str:
    return "".join((FOLDER / name).read_text(encoding="utf-8") for name in ("style.css", "view.css"))


def _viewer() -> str:
    """The program of the views, with names of its own."""
    parts = [(FOLDER / name).read_text(encoding="utf-8") for name in ("viewer_data.js", "viewer_gl.js", "viewer.js")]
    return '"use strict";\n{\n' + "".join(parts) + "}\n"
