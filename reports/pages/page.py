"""The report of a run as its templates see it: what was read and drawn, and how it is grouped.
Groups and sorts for display; decides nothing."""
from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from data.results import Case, CaseEntry, Fault, Finding, Run
from data.studies import Study
from data.trials import Trial
from pages import errors, needs, trust
from pages.hard_cases import STUDIES as HARD_STUDIES, CaseFindings, findings_by_case, is_of_case
from pages.ledger import ClaimView, claim_views
from pages.section import Section, Source
from pages.solver_words import is_of_frames, repeats
from pages.trust import Tolerances, tolerances_of
from pictures.case_pictures import PictureRow
from pictures.garment_pictures import GarmentView
from plots.plot_style import Plot
from viewer.field_pictures import FieldView

FIRST_STUDIES = (
    "work-precision", "long-contact", "stability-oscillator", "stability-sheet",
    "variable-step-stability"
)
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
    garment: GarmentView | None = None
    turning: FieldView | None = None
    plots: list[tuple[str, Plot]] = field(default_factory=list)
    problem: str = ""
    foreign: str = ""  # why the file is not the one that the run wrote


@dataclass
class StudyView:
    """A study with its plots, in the order of its figures and of its maps, and its findings."""

    study: Study
    anchor: str
    plots: list[Plot] = field(default_factory=list)
    maps: list[Plot] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)

    @property
    def is_of_settings(self) -> bool:
        """Of how far a solver's settings can be trusted."""
        return self.study.name.startswith("converge.") and self.study.name.endswith(".settings")


@dataclass
class Page:
    """All that the templates show."""

    run: Run
    bench: Run | None  # speed measurements
    cases: list[CaseView]
    drawn: list[StudyView]  # those of the speed measurements last
    trial: Trial | None = None  # of another solver, or of frames
    unended: str = ""  # why this is not what was run last
    parts: dict[str, Any] = field(default_factory=dict)  # what sections read, by their names

    def __post_init__(self) -> None:
        for view in self.drawn:
            view.findings = [
                finding
                for finding in self._everything
                if finding.kind in OF_STUDIES and finding.study == view.study.name
            ]

    @property
    def alone(self) -> bool:
        """Simulations that no run of the verification made."""
        return self.run.path is None

    @property
    def provenance(self) -> dict[str, Any]:
        return self.run.provenance

    @property
    def studies(self) -> list[StudyView]:
        return self.drawn[: len(self.run.studies)]

    @property
    def bench_studies(self) -> list[StudyView]:
        return self.drawn[len(self.run.studies) :]

    @cached_property
    def _everything(self) -> list[Finding]:
        return self.run.findings + (self.bench.findings if self.bench else [])

    @cached_property
    def claims(self) -> list[ClaimView]:
        return claim_views(self.run.claims, self._everything)

    @cached_property
    def checks(self) -> list[Finding]:
        """All but those of cases."""
        return [one for one in self._everything if one.kind == "check" and not is_of_case(one)]

    @cached_property
    def rates(self) -> list[Finding]:
        """Rates of work."""
        return [one for one in self._everything if one.kind == "bench"]

    @cached_property
    def other_findings(self) -> list[Finding]:
        """Of studies or kinds that have no section of their own."""
        known = {view.study.name for view in self.drawn}
        return [
            one
            for one in self._everything
            if one.kind not in ("check", "bench") and one.study not in known
        ]

    @cached_property
    def _of_cases(self) -> tuple[list[CaseFindings], list[CaseFindings]]:
        anchors = [view.anchor for view in self.cases]
        return findings_by_case(self.run.findings, self.run.cases, anchors)

    @property
    def case_findings(self) -> list[CaseFindings]:
        return self._of_cases[0]

    @property
    def hard_findings(self) -> list[CaseFindings]:
        """Of cases/hard."""
        return self._of_cases[1]

    @property
    def faults(self) -> list[Fault]:
        return faults_of(self.run)

    @cached_property
    def tolerances(self) -> Tolerances:
        return tolerances_of(self.run.findings)

    def sections(self) -> list[Section]:
        """Those that have something to show, in their order."""
        return [section for section in SECTIONS if section.shown(self)]

    def title(self, name: str) -> str:
        """Of a section."""
        return next(one for one in SECTIONS if one.name == name).title_on(self)

    def links(self) -> dict[str, str]:
        """What the bar calls the shown sections, and their names; the first of one link counts."""
        found: dict[str, str] = {}
        for section in self.sections():
            found.setdefault(section.link or section.title_on(self), section.name)
        return found

    def validations(self) -> list[StudyView]:
        """The studies whose findings compare with something measured, or with the continuum."""
        return [view for view in self.studies if any(f.kind == VALIDATION for f in view.findings)]

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
        elsewhere += [*FIRST_STUDIES, *HARD_STUDIES]
        return [
            view for view in self.studies
            if view.study.name not in elsewhere and not view.is_of_settings
        ]

    def settings_studies(self) -> list[StudyView]:
        """What `converge --over` and `--runs` found."""
        return [view for view in self.studies if view.is_of_settings]

    def errors_alone(self) -> bool:
        """Is this what `foldproof converge` found, and nothing else?"""
        names = [view.study.name for view in self.studies]
        return bool(names) and all(name.startswith("converge.") for name in names)

    def study_findings(self) -> list[Finding]:
        """All that do not belong to checks, cases or rates."""
        return [one for view in self.drawn for one in view.findings] + self.other_findings

    def all_findings(self) -> list[Finding]:
        """All that the page shows, once each."""
        return self.checks + self.study_findings() + self.of_cases() + self.rates

    def of_cases(self) -> list[Finding]:
        groups = self.case_findings + self.hard_findings
        return [finding for group in groups for finding in group.findings]

    @property
    def expectations(self) -> dict[str, CaseFindings]:
        """Of cases with pictures, by their anchors."""
        groups = self.case_findings + self.hard_findings
        return {group.anchor: group for group in groups if group.anchor}

    def case_of(self, name: str) -> CaseFindings | None:
        """The case that a finding is of."""
        return self._case_of.get(name)

    @cached_property
    def _case_of(self) -> dict[str, CaseFindings]:
        groups = self.case_findings + self.hard_findings
        return {finding.name: group for group in groups for finding in group.findings}

    @cached_property
    def program(self) -> str:
        """Command for the program: results of an installed one are repeated with that one."""
        made_by = [self.provenance, *(view.case.about_run for view in self.cases if view.case)]
        typed = {str(about.get("command", "")).split(" ")[0] for about in made_by} - {""}
        return "foldproof" if typed == {"foldproof"} else "build/foldproof"

    @cached_property
    def commands(self) -> dict[str, str]:
        """Commands that repeat findings outside a verification run: of simulations, and of a trial
        of another solver."""
        if self.trial:
            names = [one.name for one in self.all_findings()]
            return {name: repeats(self.trial, self.program, name) for name in names}
        typed = str(self.provenance.get("command", ""))
        if typed.split(" ")[1:2] == ["judge"]:
            return {finding.name: typed for finding in self.all_findings()}
        if not self.alone:
            return {}
        made_by = {
            view.entry.name: str(view.case.about_run.get("command", ""))
            for view in self.cases
            if view.case
        }
        return {
            name: made_by[group.name]
            for name, group in self._case_of.items()
            if made_by.get(group.name)
        }


def faults_of(run: Run) -> list[Fault]:
    """The seeded faults of the run; where it lists none, the names that its findings mention."""
    if run.faults:
        return run.faults
    mentioned: dict[str, list[str]] = {}
    for finding in run.findings:
        for fault in finding.faults:
            mentioned.setdefault(fault, []).append(finding.name)
    return [Fault(name, "", "", "", "", by, "not run") for name, by in mentioned.items()]


def _of_frames(page: Page) -> bool:
    return page.trial is not None and is_of_frames(page.trial)


def _checks_title(page: Page) -> str:
    return "Laws" if page.trial and not _of_frames(page) else "Checks"


def _studies_title(page: Page) -> str:
    if _of_frames(page):
        return "What the frames show"
    return "Error against cost" if page.trial else "Studies"


# In the order of the page. A link that an earlier section has stands in the bar once.
SECTIONS = (
    Section("claims", "Claims", lambda page: page.claims),
    Section("checks", _checks_title, lambda page: page.checks),
    Section("settings", "Your settings", Page.settings_studies),
    Section(
        "studies", _studies_title,
        lambda page: page.first_studies() or page.other_studies() or page.other_findings
    ),
    Section("validation", "Validation", Page.validations),
    Section("cases", "Cases", lambda page: page.cases),
    Section(
        "case-findings", "Findings of other cases",
        lambda page: [group for group in page.case_findings if not group.anchor], "Cases"
    ),
    needs.SECTION,
    errors.SECTION,
    trust.SECTION,
    Section("hard", "Hard cases", lambda page: page.hard_findings or page.hard_studies()),
    Section("speed", "Costs", lambda page: page.rates or page.bench_studies),
    Section("provenance", "Provenance", lambda page: page.provenance),
)


def read_parts(source: Source) -> dict[str, Any]:
    """What the sections read. Throws Unreadable for a file that is not what its name says."""
    return {section.name: section.read(source) for section in SECTIONS}
