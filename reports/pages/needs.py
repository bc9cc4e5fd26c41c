"""Which of its parts a scene needs: what `foldproof ablate` found.
Reads and counts; decides nothing."""
from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from math import nan
from pathlib import Path
from typing import Any

from data.case_digest import has_changed, part_of_time
from data.records import record
from data.unreadable import read_json
from pages.section import Section

NO_EFFECT = "no effect if added"
CANNOT_TELL = "cannot tell"
# how a part stands: its mark, and words after "2 parts are"
NEEDS = {
    "needed": ("\u25cf", "needed"),
    "kept for a reason": ("\u25d0", "not needed, and kept for a reason that the case gives"),
    "left out for a reason": ("\u25cb", "missing, and left out for a reason that the case gives"),
    "not needed here": ("", "not needed, without a reason"),
    "missing here": ("", "missing, without a reason"),
    NO_EFFECT: ("\u00b7", "absent, and of no effect if added"),
    CANNOT_TELL: ("?", "undecided: the change is within the error bar"),
}
# if the case gives one
REASONED = {"not needed here": "kept for a reason", "missing here": "left out for a reason"}
WRONG = "\u2715"                # not needed, or missing, without a reason; or a reason for nothing
# of parts, in the order of the paper
KINDS = (
    "gravity", "springs", "damping of springs", "bending", "damping of bending", "rest angles",
    "held particles", "objects", "friction of objects", "points between particles",
    "sticky parts", "strain limits", "self-collision"
)
COUNTED = {
    "steps": "steps", "elastic_evaluations": "force evaluations", "cg_iterations": "CG iterations",
    "object_queries": "object queries", "strain_sweeps": "strain sweeps",
    "crossing_queries": "crossing queries"
}


@dataclass
class PartNeed:
    """A part of a scene, run without it if it is there, else with it."""
    name: str
    present: bool
    need: str                  # needed, not needed here, missing here, NO_EFFECT or CANNOT_TELL
    because: str
    declared: str              # why the case has it, or leaves it out, all the same; or ""
    # as the program says: needed, or of no effect if added, or a reason is given, and only then;
    # or it cannot tell
    as_it_should_be: bool
    position_difference: float  # by how much positions differ [m]
    energy_difference: float   # by how much the energy differs [J]
    # pairs of an edge and a triangle that meet, most of a frame, in that run
    crossings: float
    deepest: float             # inside an object, in that run [m]
    time: float                # seconds of that run over the scene's own [1]
    # counted work of that run over the scene's own, where that is not nothing [1]
    work: list[tuple[str, float]]

    @property
    def standing(self) -> str:
        """One of NEEDS."""
        return REASONED.get(self.need, self.need) if self.declared else self.need

    @property
    def mark(self) -> str:
        """One letter for how it stands."""
        mark = NEEDS[self.standing][0] if self.standing in NEEDS else ""
        return mark if mark and self.as_it_should_be else WRONG

    @property
    def kind(self) -> str:
        """One of KINDS, or its own name."""
        for opening, kind in (("object '", "objects"), ("sticky '", "sticky parts")):
            if self.name.startswith(opening):
                return kind
        return self.name


@dataclass
class CaseNeeds:
    """A scene, its own error and its parts."""
    name: str
    overrides: list[str]       # "table.key=value", by which it was another than the shipped one
    part_of_time: str          # "first 1 of 3 s" where not the whole run was asked, else ""
    wrong: str                 # why nothing can be said of it; or ""
    other_mesh: str            # what the mesh's own error comes from, in words
    value: float               # own error, with its error bar [m]
    without_bar: float         # m
    time: float                # of the steps, with its error bar [m]; NaN: not known
    mesh: float                # m; NaN: not known
    unknown: str               # why one of them is not known
    seconds: float
    crossings: float
    deepest: float             # m
    parts: list[PartNeed]
    commit: str                # of the program that was asked
    uncommitted: bool          # that program had changes that were not committed
    recorded: bool             # kept with the cases, not found beside the run
    changed: bool              # the shipped case is another scene by now; only of what is recorded

    def tally(self) -> str:
        """How many parts are needed, in words."""
        counts = Counter(part.standing for part in self.parts)
        return ", ".join(
            f"{counts[standing]} {'undecided' if standing == CANNOT_TELL else standing}"
            for standing in NEEDS
            if counts[standing]
        )


@dataclass
class Needs:
    """Results for all requested cases."""
    cases: list[CaseNeeds]

    def commits(self, recorded: bool) -> list[str]:
        """Of the programs that were asked, recorded cases or those beside the run, each once."""
        return list(dict.fromkeys(case.commit for case in self.of_origin(recorded)))

    def of_origin(self, recorded: bool) -> list[CaseNeeds]:
        """The cases that are recorded, or those asked beside the run."""
        return [case for case in self.cases if case.recorded == recorded]

    def kinds(self) -> list[str]:
        """Of parts that any case has or lacks, those of KINDS first."""
        found = {part.kind: None for case in self.cases for part in case.parts}
        known = [kind for kind in KINDS if kind in found]
        return known + [kind for kind in found if kind not in KINDS]

    def in_words(self) -> str:
        """How many parts stand how, one sentence for each kind that there is."""
        counts = Counter(part.standing for case in self.cases for part in case.parts)
        return " ".join(
            f"{counts[standing]} part{'s are' if counts[standing] != 1 else ' is'} {words}."
            for standing, (_, words) in NEEDS.items()
            if counts[standing]
        )

    def of(self, name: str) -> CaseNeeds | None:
        """Result for the case of that name; None if it was not requested."""
        return next((case for case in self.cases if case.name == name), None)


def load_needs(file: Path, cases: Path | None = None) -> Needs | None:
    """The outcomes of `foldproof ablate --out DIR`, and of cases that it does not speak of those
    that are recorded in the folder `cases`; None if there are none.
    Throws Unreadable for other files."""
    found = read_json(file, lambda said: [
        _case(row, said["program"], recorded=False, changed=False) for row in said["cases"]
    ]) or []
    known = {case.name for case in found}
    if cases:
        found += read_json(cases / "needs.json", lambda said: [
            _case(row, row["program"], recorded=True, changed=has_changed(row, cases))
            for row in said["cases"]
            if row["case"] not in known
        ]) or []
    return Needs(found) if found else None


def _case(row: dict[str, Any], program: dict[str, Any], **origin: bool) -> CaseNeeds:
    own, scene = row["own_error"], row["run"]
    kind, other_mesh = (
        ("coarser mesh", f"from a coarser mesh, {', '.join(own['coarser_mesh'])},")
        if own["coarser_mesh"]
        else ("finer mesh", "finer mesh")
    )
    reasons = (("its steps", own["without_time"]), (kind, own["without_mesh"]))
    return record(
        CaseNeeds, scene | own | row, **origin, name=row["case"], part_of_time=part_of_time(row),
        other_mesh=other_mesh, unknown="; ".join(f"{of}: {why}" for of, why in reasons if why),
        parts=[_part(part, scene) for part in row["parts"]], commit=program["commit"],
        uncommitted=program.get("tree") == "dirty"
    )


def _part(part: dict[str, Any], scene: dict[str, Any]) -> PartNeed:
    run = part["run"]
    work = [
        (words, run[key] / scene[key])
        for key, words in COUNTED.items()
        if scene[key] and run[key] != scene[key]
    ]
    time = run["seconds"] / scene["seconds"] if scene["seconds"] else nan
    return record(PartNeed, run | part, time=time, work=work)


SECTION = Section(
    "needs", "What each scene needs", lambda page: page.parts["needs"], "Needs",
    lambda source: load_needs(source.folder / "ablation.json", source.shipped)
)
