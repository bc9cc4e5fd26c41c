"""Pages of standing results: solvers by groups of laws, a page a solver, a page a run, and what
differs between two. Counts and sorts what bundles say; judges nothing."""
from __future__ import annotations

import itertools
import json
import re
from collections import Counter
from dataclasses import dataclass, field
from functools import cached_property
from math import inf, log
from pathlib import Path
from typing import Any

from jinja2 import FileSystemLoader
from markupsafe import Markup

from data.bundle import SPREAD, Bundle, Row, agrees, differences, disagreements, law_set
from data.quantities import ratio_of
from data.whole_file import write_whole
from pages.render import REPORTS, TEMPLATES, new_environment
from standing.causes import Cause, Reproduction, causes_of
from standing.measured import COLUMNS, MESHES, PARAMETERS, by_mesh, costs_of, is_in

SCHEMA = 1                  # of results.json
STYLES = ("pages/style.css", "pages/opening.css", "pages/site.css",
          "standing/standing.css")
# Columns of the first page: beginnings of laws' names. What is none of these is in the last.
GROUPS = {
    "rest, weight, momentum": "smoke rest inertia gravity momentum held time limits repeat"
                              " symmetry precision",
    "forces": "forces bending damping together",
    "order, stability": "order stability vibration game-step",
    "stiffness, mesh": "calibration size materials strain-limits",
    "hangs, folds, buckles": "cantilever buckling strip drape floor chain wrinkles",
    "obstacles, friction": "contact ball box capsule capstan obstacles tunnelling",
    "cloth on cloth": "self-collision layers",
    "moving, air, cost": "moving air cost",
}
OTHER = "others"
CHANGES = ("Decided otherwise", "Decided in one of the two alone", "Same outcome, another number")
# What choosers ask, and the law that answers.
QUESTIONS = {
    "stretches as the scene says": "calibration.young-s-modulus-is-the-scene-s",
    "bends as the scene says": "calibration.bending-rigidity-is-the-scene-s",
    "bending survives refinement": "calibration.rigidity-survives-refinement",
    "stretches alike at steps of 1/60 s": "game-step.static-stretch-is-that-of-short-steps",
    "keeps its speed": "inertia.free-sheet-keeps-its-velocity",
    "keeps angular momentum": "momentum.angular-drift-falls-with-the-step",
    "slides as Coulomb says": "contact.slides-as-coulomb-says",
    "sticks until Coulomb's slope": "contact.slips-at-coulomb-s-slope",
    "stops at a thin box": "tunnelling.thin-box-stops-a-slow-sheet",
    "does not pass through itself": "self-collision.folded-sheet-never-passes-through-itself",
}
NOT_ASKED: Row = ["not asked", None, None, "", None, ""]


@dataclass
class Cell:
    """Laws of a group: how many hold, fail, are not decided; the largest measured/bound of those
    that fail [1], None without a number."""
    holds: int
    fails: int
    undecided: int
    worst: float | None


@dataclass
class Standing:
    """A run and where it stands."""
    bundle: Bundle
    file: str                       # of its page
    reruns: list[Bundle] = field(default_factory=list)      # that agree
    others: list[Bundle] = field(default_factory=list)      # of the same, that do not

    @property
    def status(self) -> str:
        if not self.bundle.yardstick:
            return "recorded"
        return "re-run" if self.reruns else "submitted"

    @property
    def settings(self) -> str:
        """Words of the adapter's command that its name has are left out."""
        about = self.bundle.about
        words = [word for word in self.bundle.arguments.split() if word not in about["engine"]]
        return " ".join(words + [f"{key}={value}" if value else key
                                 for key, value in about["settings"].items()])

    @cached_property
    def causes(self) -> dict[str, Cause]:
        return causes_of(self.bundle)

    @property
    def reproductions(self) -> dict[str, Reproduction]:
        """By page."""
        return {one.page: one for cause in self.causes.values() for one in cause.reproductions}

    @property
    def name(self) -> str:
        about = self.bundle.about
        return " ".join(filter(None, (about["engine"], about["version"], self.settings)))

    def row(self, law: str) -> Row:
        return self.bundle.laws.get(law, NOT_ASKED)

    def cells(self, laws: list[str]) -> dict[str, Cell]:
        return {group: cell_of([self.row(law) for law in laws if group_of(law) == group])
                for group in groups_of(laws)}

    def whole(self, laws: list[str]) -> Cell:
        return cell_of([self.row(law) for law in laws])

    def seconds(self) -> tuple[float, float]:
        """Of all laws, and of the reference on that machine for the laws that both ran [s]."""
        common = [law for law, row in self.bundle.laws.items()
                  if row[0] in ("holds", "fails", "inconclusive") and law in self.bundle.yardstick]
        return (sum(self.bundle.laws[law][4] or 0 for law in common),
                sum(self.bundle.yardstick[law][4] or 0 for law in common))


def changes(one: Bundle, other: Bundle) -> dict[str, list[tuple[str, Row, Row]]]:
    """Laws that differ by more than the spread, by the heading under which they stand; the largest
    factors between numbers first."""
    found: dict[str, list[tuple[str, Row, Row]]] = {heading: [] for heading in CHANGES}
    for law, a, b in differences(one, other, SPREAD):
        decided = sum(row[0] in ("holds", "fails") for row in (a, b))
        if decided:
            same = a[0] == b[0]
            found[CHANGES[1 if decided == 1 else 2 if same else 0]].append((law, a, b))
    return {heading: sorted(rows, key=_factor, reverse=True) for heading, rows in found.items()}


def _factor(change: tuple[str, Row, Row]) -> float:
    _, a, b = change
    if not a[1] or not b[1]:
        return inf
    return abs(log(b[1] / a[1])) if b[1] / a[1] > 0 else inf


def group_of(law: str) -> str:
    beginning = law.partition(".")[0]
    return next((group for group, words in GROUPS.items() if beginning in words.split()), OTHER)


def groups_of(laws: list[str]) -> list[str]:
    present = {group_of(law) for law in laws}
    return [group for group in (*GROUPS, OTHER) if group in present]


def cell_of(rows: list[Row]) -> Cell:
    counts = Counter(row[0] for row in rows)
    ratios = [ratio_of(row[1], row[2]) for row in rows if row[0] == "fails" and row[1] is not None]
    finite = [ratio for ratio in ratios if ratio < float("inf")]
    return Cell(counts["holds"], counts["fails"],
                len(rows) - counts["holds"] - counts["fails"], max(finite, default=None))


def slug(*words: str) -> str:
    return re.sub(r"[^a-z0-9.]+", "-", " ".join(words).lower()).strip("-.")[:80] or "solver"


def standings_of(bundles: list[Bundle]) -> list[Standing]:
    """By engine, version, settings, date; each with a page of its own. Runs that agree are one,
    the first."""
    order = sorted(bundles, key=lambda one: (*version_key(one), one.about["date"]))
    taken: Counter[str] = Counter()
    standings = []
    for bundle in order:
        if any(bundle in shown.reruns for shown in standings):
            continue
        one = Standing(bundle, "")
        name = slug(one.name)
        taken[name] += 1
        one.file = f"run-{name}{f'-{taken[name]}' if taken[name] > 1 else ''}.html"
        same = [other for other in order if other is not bundle
                and other.identity == bundle.identity]
        one.reruns = [other for other in same if agrees(bundle, other)]
        one.others = [other for other in same if not agrees(bundle, other)]
        standings.append(one)
    return standings


def version_key(bundle: Bundle) -> tuple[Any, ...]:
    about = bundle.about
    numbers = [int(part) for part in re.findall(r"\d{1,9}", about["version"])]
    return about["engine"].lower(), numbers, about["version"], str(bundle.identity)


def write_site(bundles: list[Bundle], folder: Path) -> Path:
    """Writes index.html, the other pages, table.svg and results.json; returns the first. All of one
    law set: the newest that a bundle has."""
    newest = max(bundle.about["law_set"] for bundle in bundles)
    shown = standings_of([one for one in bundles if one.about["law_set"] == newest])
    laws = list(law_set(newest))
    environment = new_environment()
    environment.loader = FileSystemLoader((*TEMPLATES, REPORTS / "standing"))
    style = "\n".join((REPORTS / file).read_text(encoding="utf-8") for file in STYLES)
    environment.globals.update(
        style=Markup(style), laws=laws, set_name=newest, groups=groups_of(laws),
        group_of=group_of, older=sum(one.about["law_set"] != newest for one in bundles),
        changes=changes, change_headings=CHANGES, meshes=MESHES, mesh_columns=COLUMNS,
        by_mesh=by_mesh, is_in=is_in, disagreements=disagreements, spread=SPREAD,
        questions=answered(shown))
    engines = {engine: list(runs) for engine, runs in
               itertools.groupby(shown, key=lambda one: one.bundle.about["engine"])}
    costs = costs_of([(one.name, one.bundle) for one in shown])
    pages = {"index.html": ("standing.html.j2", {"engines": engines, "shown": shown}),
             "table.svg": ("standing-table.svg.j2", {"shown": shown}),
             "measured.html": ("standing-measured.html.j2",
                               {"runs": shown, "parameters": PARAMETERS, "costs": costs})}
    files = engine_files(list(engines))
    environment.globals["engine_file"] = files.__getitem__
    for engine, runs in engines.items():
        pairs = [(f"difference-{slug(files[engine].removesuffix('.html'))}-{a + 1}-{b + 1}.html",
                  runs[a], runs[b]) for a, b in itertools.combinations(range(len(runs)), 2)]
        pages[files[engine]] = ("standing-engine.html.j2",
                                {"engine": engine, "runs": runs, "pairs": pairs})
        for file, one, other in pairs:
            pages[file] = ("standing-difference.html.j2", {"a": one, "b": other})
        for run in runs:
            pages[run.file] = ("standing-run.html.j2", {"run": run})
            pages |= {page: ("standing-reproduction.html.j2", {"one": one})
                      for page, one in run.reproductions.items()}
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("*.html"):
        if old.name.startswith(("run-", "engine-", "difference-", "reproduction-")):
            old.unlink()
    for file, (template, values) in pages.items():
        text = environment.get_template(template).render(values)
        write_whole(folder / file, text.encode("utf-8"))
    write_whole(folder / "results.json", json_of(shown, laws, newest).encode("utf-8"))
    return folder / "index.html"


def answered(shown: list[Standing]) -> dict[str, str]:
    """The questions that a run answers."""
    return {question: law for question, law in QUESTIONS.items()
            if any(run.row(law)[0] in ("holds", "fails") for run in shown)}


def engine_files(engines: list[str]) -> dict[str, str]:
    files: dict[str, str] = {}
    for engine in engines:
        name = f"engine-{slug(engine)}"
        files[engine] = f"{name}-{len(files)}.html" if f"{name}.html" in files.values() \
            else f"{name}.html"
    return files


def json_of(shown: list[Standing], laws: list[str], newest: str) -> str:
    """For other programs; a row a run. Fields are added, never changed."""
    rows = [{"engine": one.bundle.about["engine"], "version": one.bundle.about["version"],
             "settings": one.settings, "status": one.status, "page": one.file,
             "holds": (whole := one.whole(laws)).holds, "fails": whole.fails,
             "undecided": whole.undecided,
             "groups": {group: vars(cell) for group, cell in one.cells(laws).items()},
             "laws": one.bundle.laws} for one in shown]
    return json.dumps({"schema": SCHEMA, "law_set": newest, "runs": rows}, indent=1) + "\n"
