"""Templates to texts: the report, cut into pages or whole, its page of verdict, two runs."""
from __future__ import annotations

import json
import re
from dataclasses import replace
from math import isnan
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from data import quantities
from data.fault_record import commits_of
from data.formulas import GREEK, formula_html
from pages import counts, ledger
from pages.answers import cheapest_of, lasting_steps
from pages.compare import Comparison
from pages.conclusions import Results
from pages.figure_words import figure_keys, figure_notes, order_table
from pages.four_questions import Answer, four_questions
from pages.kill_matrix import kill_tables
from pages.page import Page
from pages.said import bound_html, measured_html, rule_html
from pages.sentences import Piece, html_of
from pages.shown_table import WHOLE_STUDY_TABLE, WHOLE_TABLE, select_rows
from pages.site import FIRST, Cuts, split
from pages.solver_words import is_of_frames, standfirst_of, title_of
from pages.summary import Judged, Summary, summary_of
from pages.summary_markdown import TITLE, count_words, summary_markdown
from pictures.case_pictures import length_text
from pictures.sketches import sketch_of
from plots.map_plots import map_notes

REPORTS = Path(__file__).resolve().parents[1]
TEMPLATES = (REPORTS / "pages", REPORTS / "viewer")
STYLES = (
    "pages/style.css", "viewer/view.css", "pages/opening.css", "pages/print.css",
    "pages/summary.css", "pages/site.css"
)
MOST_OPEN = 5  # findings that do not plainly hold, on the first screen
MOST_BYTES = 500_000  # of a report on one page
MOST_WORDS = 450  # of the page of verdict: two minutes
_LINK = re.compile(r'<a href="#[^"]*"[^>]*>(.*?)</a>', re.DOTALL)


def render_pages(page: Page) -> dict[str, str]:
    """The report as pages: files from its folder, the first page first, and HTML texts. One page if
    all is on one screen or two: of simulations alone, or of at most MOST_BYTES."""
    cuts = Cuts(is_site=True)
    text = render(page, cuts=cuts)
    if page.alone or len(text.encode("utf-8")) <= MOST_BYTES:
        return {FIRST: render(page)}
    return split(text, cuts, _viewer())


def render(page: Page, since: list[Piece] | None = None, cuts: Cuts | None = None) -> str:
    """The whole report as one HTML text; `since` says what changed from the run before, `cuts` take
    note of the pages into which the text can be cut."""
    environment = new_environment()
    studies = [view.study for view in page.studies]
    environment.globals.update(
        cuts=cuts or Cuts(is_site=False), keys=figure_keys, notes=figure_notes,
        map_notes=map_notes, orders=order_table, table=select_rows,
        groups=counts.group_by_prefix, margin=counts.margin_percent, plain=counts.all_hold,
        whole_study_table=WHOLE_STUDY_TABLE, whole_table=WHOLE_TABLE, most_open=MOST_OPEN,
        viewer=Markup(_viewer()), rulings=ledger.ruling_counts, claims_by_section=ledger.by_section,
        papers=ledger.by_paper, cheapest=cheapest_of(studies), lasting=lasting_steps(studies),
        sketch_of=sketch_of, known_faults={fault.name: fault for fault in page.faults},
        caught=counts.CaughtCount(page.faults), by_file=counts.faults_by_file,
        commits=commits_of(page.faults), fault_outcomes=counts.fault_outcomes,
        kill_tables=kill_tables(page.faults),
        known_findings={finding.name for finding in page.all_findings()}, commands=page.commands,
        program=page.program, of_case=page.case_of,
    )
    return environment.get_template("page.html.j2").render(
        page=page, said=page.provenance, summary=summary_of_page(page, since, environment),
        answers=[] if page.trial else _answers(page, environment),
        title=title_of(page.trial) if page.trial else "What was found",
        standfirst=standfirst_of(page.trial, len(_judged(page))) if page.trial else "",
    )


def _answers(page: Page, environment: Environment) -> list[Answer]:
    studies = [view.study for view in page.studies]
    anchor = environment.globals["anchor"]
    return four_questions(Results(page.all_findings(), studies, [], anchor), page.studies)


def _judged(page: Page) -> list[Any]:
    """The findings that the summary counts: all but rates of work."""
    return [finding for finding in page.all_findings() if finding.kind != "bench"]


def summary_of_page(page: Page, since: list[Piece] | None, environment: Environment) -> Summary:
    """The page of verdict, with anchors as in the environment's other templates."""
    findings, studies = _judged(page), [view.study for view in page.studies]
    results = Results(findings, studies, page.claims, environment.globals["anchor"])
    judged = Judged(
        page.provenance, findings, page.faults, page.tolerances, results, since or [], page.alone,
        trial=page.trial
    )
    whole = summary_of(judged)
    return whole if count_words(whole) <= MOST_WORDS else summary_of(replace(judged, is_brief=True))


def render_summary(page: Page, since: list[Piece] | None = None) -> tuple[str, str]:
    """The page of verdict alone, as one HTML text that needs nothing beside it and has no links, as
    there is nothing to lead to; and as Markdown."""
    environment = new_environment()
    summary = summary_of_page(page, since, environment)
    text = environment.get_template("summary_page.html.j2").render(summary=summary, title=TITLE)
    return _LINK.sub(r'<span class="quoted">\1</span>', text), summary_markdown(summary)


def render_comparison(comparison: Comparison) -> str:
    """The page of two runs as one HTML text."""
    environment = new_environment()
    environment.globals.update(rulings=ledger.count_rulings)
    return environment.get_template("compare.html.j2").render(said=comparison)


def new_environment() -> Environment:
    """Values shared by all templates."""
    environment = Environment(
        loader=FileSystemLoader(TEMPLATES), autoescape=True, undefined=StrictUndefined,
        trim_blocks=True, lstrip_blocks=True
    )
    environment.filters.update(
        number=quantities.number_html, known=quantities.known_html, unit=quantities.unit_text,
        seconds=quantities.seconds_html, bar_length=length_text, sentence=html_of,
        measured=measured_html, bound=bound_html, rule=rule_html, formula=formula_html
    )
    greek = json.dumps(GREEK, ensure_ascii=False)
    environment.globals.update(
        quantity=quantities.quantity_html, ratio=quantities.ratio_of, isnan=isnan,
        is_of_frames=is_of_frames, anchor=Anchors().of, outcome_class=counts.outcome_class,
        counts=counts.count_outcomes, style=Markup(_text_of(*STYLES)),
        script=Markup(_text_of("pages/filter.js").replace("{{ greek }}", greek))
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


def _text_of(*names: str) -> str:
    return "".join((REPORTS / name).read_text(encoding="utf-8") for name in names)


def _viewer() -> str:
    """The program of the views, with names of its own."""
    program = _text_of("viewer/viewer_data.js", "viewer/viewer_gl.js", "viewer/viewer.js")
    return '"use strict";\n{\n' + program + "}\n"
