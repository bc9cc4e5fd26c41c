"""Puts what was read and drawn into the page. Groups, counts and
sorts for display; decides nothing."""
from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from math import isnan
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from data import quantities
from data.fault_record import commits_of
from data.formulas import GREEK, formula_html
from data.mutation_scores import MutationPage
from data.results import Case, CaseEntry, Column, Fault, Finding, Run, Study
from data.trials import Trial
from pages import ledger
from pages.answers import cheapest_of, lasting_steps
from pages.compare import Comparison
from pages.four_questions import four_questions
from pages.conclusions import Results
from pages.figure_words import figure_keys, figure_notes, order_table
from pages.hard_cases import STUDIES as HARD_STUDIES, CaseFindings, is_of_case
from pages.kill_matrix import Mutation, kill_tables
from pages.ledger import ClaimView
from pages.errors import Errors
from pages.needs import Needs
from pages.said import bound_html, measured_html, rule_html
from pages.sentences import Piece, html_of
from pages.site import FIRST, Cuts, split, without_marks
from pages.solver_words import is_of_frames, repeats, standfirst_of, title_of
from pages.summary import Judged, Summary, summary_of
from pages.summary_markdown import count_words
from pages.trust import Coverage, Kinds, Machines, Tolerances, Variants
from pictures.case_pictures import PictureRow, length_text
from pictures.sketches import sketch_of
from plots.map_plots import map_notes
from plots.plot_style import Plot
from viewer.field_pictures import FieldView

REPORTS = Path(__file__).resolve().parents[1]
TEMPLATES = (REPORTS / "pages", REPORTS / "viewer")
OUTCOMES = ("holds", "fails", "inconclusive", "not applicable")
WHOLE_TABLE, WHOLE_STUDY_TABLE = 12, 60  # rows; longer tables show FIRST_ROWS and LAST_ROWS
FIRST_ROWS, LAST_ROWS = 7, 3
FIRST_STUDIES = (
    "work-precision",
    "long-contact",
    "stability-oscillator",
    "stability-sheet",
    "variable-step-stability",
)
MOST_OPEN = 5  # findings that do not plainly hold, on the first screen
STYLES = (
    "pages/style.css",
    "viewer/view.css",
    "pages/opening.css",
    "pages/print.css",
    "pages/summary.css",
    "pages/site.css",
)
MOST_BYTES = 500_000  # of a report on one page
MOST_WORDS = 450  # of the page of verdict: two minutes
BAR_END = 1.25  # measured / bound at the end of the margin bar


# the kind of findings that compare with something measured, or the continuum
VALIDATION = "validation"
OF_STUDIES = ("study", VALIDATION)  # kinds of findings that studies have


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
    foreign: str = ""  # why the file is not the one that the run wrote


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
    other_findings: list[Finding]  # of studies or kinds that have no section of their own
    cases: list[CaseView]
    rates: list[Finding]
    bench_studies: list[StudyView]
    bench_provenance: dict[str, Any]
    faults: list[Fault]
    tolerances: Tolerances
    kinds: Kinds
    case_findings: list[CaseFindings] = field(default_factory=list)
    hard_findings: list[CaseFindings] = field(default_factory=list)  # of cases/hard
    coverage: Coverage | None = None
    needs: Needs | None = None  # which of its parts each scene needs
    errors: Errors | None = None  # how large the error of each scene's step is
    variants: Variants | None = None
    machines: Machines | None = None
    alone: bool = False  # simulations that no run of the verification made
    unended: str = ""  # why this is not what was run last
    mutants: MutationPage | None = None  # random slips, from the shipped scores
    mutation: Mutation | None = None  # what scripts/mutate found, where that lies beside the run
    trial: Trial | None = None  # of another solver, or of frames

    def validations(self) -> list[StudyView]:
        """The studies whose findings compare with something measured, or with the continuum."""
        return [
            view
            for view in self.studies
            if any(finding.kind == VALIDATION for finding in view.findings)
        ]

    def first_studies(self) -> list[StudyView]:
        """The studies that help to choose an integrator, in the order of FIRST_STUDIES."""
        wanted = [view for view in self.studies if view.study.name in FIRST_STUDIES]
        return sorted(wanted, key=lambda view: FIRST_STUDIES.index(view.study.name))

    def hard_studies(self) -> list[StudyView]:
        """The studies that stand with the hard cases."""
        return [view for view in self.studies if view.study.name in HARD_STUDIES]

    def other_studies(self) -> list[StudyView]:
        """All other studies, as the run lists them."""
        elsewhere = [view.study.name for view in self.validations()]
        return [
            view
            for view in self.studies
            if view.study.name not in [*FIRST_STUDIES, *HARD_STUDIES, *elsewhere]
        ]

    def errors_alone(self) -> bool:
        """Is this what `foldproof converge` found, and nothing else?"""
        return bool(self.studies) and all(
            view.study.name.startswith("converge.") for view in self.studies
        )

    def all_findings(self) -> list[Finding]:
        """All that the page shows, once each."""
        of_studies = [
            finding for view in self.studies + self.bench_studies for finding in view.findings
        ]
        of_cases = [
            finding for case in self.case_findings + self.hard_findings for finding in case.findings
        ]
        return self.checks + of_studies + self.other_findings + of_cases + self.rates


def render_pages(page: Page) -> dict[str, str]:
    """The report as pages: files from its folder, the first page first, and HTML texts. One page if
    all is on one screen or two: of simulations alone, or of at most MOST_BYTES."""
    cuts = Cuts(is_site=True)
    text = render(page, cuts=cuts)
    if page.alone or len(text.encode("utf-8")) <= MOST_BYTES:
        return {FIRST: without_marks(text)}
    return split(text, cuts, _viewer())


def render(page: Page, since: list[Piece] | None = None, cuts: Cuts | None = None) -> str:
    """The whole report as one HTML text; `since` says what changed from the run before, `cuts` take
    note of the pages into which the text can be cut."""
    environment = new_environment()
    environment.globals.update(cuts=cuts or Cuts(is_site=False))
    environment.globals.update(
        keys=figure_keys,
        notes=figure_notes,
        map_notes=map_notes,
        orders=order_table,
        table=select_rows,
        groups=group_by_prefix,
        margin=margin_percent,
        plain=all_hold,
        whole_study_table=WHOLE_STUDY_TABLE,
        whole_table=WHOLE_TABLE,
        most_open=MOST_OPEN,
        viewer=Markup(_viewer()),
        rulings=ledger.ruling_counts,
        sections=ledger.by_section,
        papers=ledger.by_paper,
        cheapest=cheapest_of(view.study for view in page.studies),
        lasting=lasting_steps(view.study for view in page.studies),
        sketch_of=sketch_of,
        known_faults={fault.name: fault for fault in page.faults},
        caught=CaughtCount(page.faults),
        by_file=faults_by_file,
        commits=commits_of(page.faults),
        fault_outcomes=fault_outcomes,
        kill_tables=kill_tables(page.faults),
        known_findings={finding.name for finding in page.all_findings()},
        commands=commands_of(page),
        program=program_of(page),
        expectations={
            case.anchor: case for case in page.case_findings + page.hard_findings if case.anchor
        },
        of_case={
            finding.name: case
            for case in page.case_findings + page.hard_findings
            for finding in case.findings
        }.get,
    )
    return environment.get_template("page.html.j2").render(
        page=page,
        said=page.provenance,
        summary=summary_of_page(page, since, environment),
        answers=[] if page.trial else four_questions(
            Results(
                page.all_findings(),
                [view.study for view in page.studies],
                [],
                environment.globals["anchor"],
            ),
            page.studies,
        ),
        title=title_of(page.trial) if page.trial else "What was found",
        standfirst=standfirst_of(page.trial, _judged(page)) if page.trial else "",
        of_frames=page.trial is not None and is_of_frames(page.trial),
    )


def _judged(page: Page) -> int:
    """How many findings the summary counts."""
    return sum(finding.kind != "bench" for finding in page.all_findings())


def summary_of_page(page: Page, since: list[Piece] | None, environment: Environment) -> Summary:
    """The page of verdict, with anchors as in the environment's other templates."""
    findings = [finding for finding in page.all_findings() if finding.kind != "bench"]
    studies = [view.study for view in page.studies]
    judged = Judged(
        provenance=page.provenance,
        findings=findings,
        studies=len(studies),
        faults=page.faults,
        tolerances=page.tolerances,
        results=Results(findings, studies, page.claims, environment.globals["anchor"]),
        since=since or [],
        alone=page.alone,
        trial=page.trial,
    )
    whole = summary_of(judged)
    return whole if count_words(whole) <= MOST_WORDS else summary_of(replace(judged, is_brief=True))


def program_of(page: Page) -> str:
    """Command for the program: results of an installed one are repeated with that one."""
    made_by = [page.provenance, *(view.case.about_run for view in page.cases if view.case)]
    typed = {str(about.get("command", "")).split(" ")[0] for about in made_by} - {""}
    return "foldproof" if typed == {"foldproof"} else "build/foldproof"


def commands_of(page: Page) -> dict[str, str]:
    """Commands that repeat findings outside a verification run: of simulations, and of a trial of
    another solver."""
    if page.trial:
        program = program_of(page)
        return {one.name: repeats(page.trial, program, one.name) for one in page.all_findings()}
    typed = str(page.provenance.get("command", ""))
    if typed.split(" ")[1:2] == ["judge"]:
        return {finding.name: typed for finding in page.all_findings()}
    if not page.alone:
        return {}
    made_by = {
        view.entry.name: str(view.case.about_run.get("command", ""))
        for view in page.cases
        if view.case
    }
    return {
        finding.name: made_by[group.name]
        for group in page.case_findings + page.hard_findings
        for finding in group.findings
        if made_by.get(group.name)
    }


def render_comparison(comparison: Comparison) -> str:
    """The page of two runs as one HTML text."""
    environment = new_environment()
    environment.globals.update(rulings=ledger.count_rulings)
    return environment.get_template("compare.html.j2").render(said=comparison)


def new_environment() -> Environment:
    """Values shared by all templates."""
    environment = Environment(
        loader=FileSystemLoader(TEMPLATES),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(
        number=quantities.number_html,
        known=quantities.known_html,
        unit=quantities.unit_text,
        seconds=quantities.seconds_html,
        bar_length=length_text,
        sentence=html_of,
        measured=measured_html,
        bound=bound_html,
        rule=rule_html,
        formula=formula_html,
    )
    environment.globals.update(
        quantity=quantities.quantity_html,
        ratio=quantities.ratio_of,
        isnan=isnan,
        anchor=Anchors().of,
        outcome_class=outcome_class,
        counts=count_outcomes,
        style=Markup(_text_of(*STYLES)),
        script=Markup(
            _text_of("pages/filter.js").replace(
                "{{ greek }}", json.dumps(GREEK, ensure_ascii=False)
            )
        ),
    )
    return environment


class Anchors:
    """Permanent ids: a name is its own anchor where HTML allows; the same name
    gets the same anchor each time."""

    def __init__(self) -> None:
        self._taken: dict[str, str] = {}

    def of(self, name: str) -> str:
        """The anchor of a name."""
        wanted = re.sub(r"[^\w.\-]+", "-", name).strip("-") or "unnamed"
        while self._taken.setdefault(wanted, name) != name:
            wanted += "-2"
        return wanted


class CaughtCount:
    """How many of a finding's seeded faults were caught; None where
    the run's folder has no outcomes."""

    def __init__(self, faults: list[Fault]) -> None:
        self._caught = {fault.name for fault in faults if fault.outcome == "caught"}
        self.known = any(fault.outcome in ("caught", "SURVIVED") for fault in faults)

    def of(self, finding: Finding) -> int:
        """How many of the faults that name this finding were caught."""
        return sum(name in self._caught for name in finding.faults)


def faults_by_file(faults: Iterable[Fault]) -> list[tuple[str, list[Fault]]]:
    """Faults by the file that they edit, files in the order of their first fault."""
    grouped: dict[str, list[Fault]] = {}
    for fault in faults:
        grouped.setdefault(fault.file, []).append(fault)
    return list(grouped.items())


def fault_outcomes(faults: list[Fault]) -> list[tuple[str, int]]:
    """How many faults have each outcome; all together where none is known."""
    if not CaughtCount(faults).known:
        return [("faults" if len(faults) != 1 else "fault", len(faults))]
    return list(Counter(fault.outcome or "not run" for fault in faults).items())


def outcome_class(outcome: str) -> str:
    """The CSS class of an outcome."""
    return re.sub(r"[^a-z]+", "-", outcome.lower()).strip("-") or "unknown"


def count_outcomes(findings: Iterable[Finding]) -> list[tuple[str, int]]:
    """How many findings have each outcome; the four usual ones always, others where they occur."""
    counted = Counter(finding.outcome for finding in findings)
    others = sorted(set(counted) - set(OUTCOMES))
    return [(outcome, counted[outcome]) for outcome in (*OUTCOMES, *others)]


def all_hold(findings: Iterable[Finding]) -> bool:
    """Whether nothing asks to be looked at: every finding holds or does not apply."""
    return all(finding.outcome in ("holds", "not applicable") for finding in findings)


def group_by_prefix(findings: Iterable[Finding]) -> list[tuple[str, list[Finding]]]:
    """Findings by the part of their name before the first dot, groups in
    the order of their first member."""
    grouped: dict[str, list[Finding]] = {}
    for finding in findings:
        grouped.setdefault(finding.name.split(".")[0], []).append(finding)
    return list(grouped.items())


def margin_percent(finding: Finding) -> float | None:
    """Length of the margin bar in percent: measured / bound, on a scale from zero to BAR_END; None
    where that says nothing."""
    ratio = quantities.ratio_of(finding.measured, finding.bound)
    return None if isnan(ratio) else 100.0 * min(ratio / BAR_END, 1.0)


@dataclass
class ShownTable:
    """A table ready to be set: heads with units, the rows shown first and
    last, and how many lie between."""

    heads: list[tuple[str, str, bool]]  # name, unit, whether it holds numbers
    first: list[tuple[Markup, ...]]
    left_out: int
    last: list[tuple[Markup, ...]]


def select_rows(columns: list[Column], most: int = WHOLE_TABLE) -> ShownTable:
    """The displayed part of a table, up to `most` rows; vectors get one column per component."""
    flat = [part for column in columns for part in _components(column)]
    count = max((len(column.values) for column in flat), default=0)
    whole = count <= most
    kept = [*range(count)] if whole else [*range(FIRST_ROWS), *range(count - LAST_ROWS, count)]
    cells = [
        quantities.cells_html(
            column.values[row] if row < len(column.values) else "" for row in kept
        )
        for column in flat
    ]
    rows = list(zip(*cells))
    cut = len(rows) if whole else FIRST_ROWS
    heads = [
        (column.name.replace("_", " "), column.unit, column.values.dtype.kind == "f")
        for column in flat
    ]
    return ShownTable(heads, rows[:cut], count - len(rows), rows[cut:])


def _components(column: Column) -> list[Column]:
    if column.values.ndim == 1:
        return [column]
    flat = column.values.reshape(len(column.values), -1)
    names = "xyz" if flat.shape[1] == 3 else [str(k + 1) for k in range(flat.shape[1])]
    return [
        Column(f"{column.name} {name}", column.unit, flat[:, k]) for k, name in enumerate(names)
    ]


def findings_by_section(
    run: Run, bench: Run | None
) -> tuple[list[Finding], list[Finding], list[Finding]]:
    """Checks but those of cases; findings that no section of a study shows; rates of work."""
    known = {study.name for study in run.studies + (bench.studies if bench else [])}
    findings = run.findings + (bench.findings if bench else [])
    checks = [
        finding for finding in findings if finding.kind == "check" and not is_of_case(finding)
    ]
    rates = [finding for finding in findings if finding.kind == "bench"]
    others = [
        finding
        for finding in findings
        if finding.kind not in ("check", "bench") and finding.study not in known
    ]
    return checks, others, rates


def faults_of(run: Run) -> list[Fault]:
    """The seeded faults of the run; where it lists none, the names that its findings mention."""
    if run.faults:
        return run.faults
    mentioned: dict[str, list[str]] = {}
    for finding in run.findings:
        for fault in finding.faults:
            mentioned.setdefault(fault, []).append(finding.name)
    return [
        Fault(name, "", "", "", "", caught_by, "not run") for name, caught_by in mentioned.items()
    ]


def _text_of(*names: str) -> str:
    return "".join((REPORTS / name).read_text(encoding="utf-8") for name in names)


def _viewer() -> str:
    """The program of the views, with names of its own."""
    return (
        '"use strict";\n{\n'
        + _text_of("viewer/viewer_data.js", "viewer/viewer_gl.js", "viewer/viewer.js")
        + "}\n"
    )
