"""Which of its parts a scene needs: what `foldproof ablate` found.
Reads and counts; decides nothing."""
from __future__ import annotations

import json
from collections import Counter
from dataclasses import dataclass
from math import nan
from pathlib import Path
from typing import Any

from data.case_digest import case_digest, case_files
from data.unreadable import reading

NO_EFFECT = "no effect if added"
CANNOT_TELL = "cannot tell"
NEEDS = ("needed", "kept for a reason", "left out for a reason", "not needed here", "missing here",
         NO_EFFECT, CANNOT_TELL)
# if the case gives one
REASONED = {"not needed here": "kept for a reason", "missing here": "left out for a reason"}
MARKS = {
    "needed": "\u25cf", "kept for a reason": "\u25d0", "left out for a reason": "\u25cb",
    NO_EFFECT: "\u00b7", CANNOT_TELL: "?"
}
WRONG = "\u2715"                # not needed, or missing, without a reason; or a reason for nothing
KINDS = (
    "gravity",
    "springs",
    "damping of springs",
    "bending",
    "damping of bending",
    "rest angles",
    "held particles",
    "objects",
    "friction of objects",
    # of parts, in the order of the paper
    "points between particles",
    "sticky parts",
    "strain limits",
    "self-collision",
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
    fits: bool
    moved: float               # by how much positions differ [m]
    energy: float              # by how much the energy differs [J]
    # pairs of an edge and a triangle that meet, most of a frame, in that run
    crossings: float
    deepest: float             # inside an object, in that run [m]
    seconds: float             # that run over the scene's own [1]
    # counted work of that run over the scene's own, where that is not nothing [1]
    work: list[tuple[str, float]]

    @property
    def standing(self) -> str:
        """One of NEEDS."""
        return REASONED.get(self.need, self.need) if self.declared else self.need

    @property
    def mark(self) -> str:
        """One letter for how it stands."""
        return MARKS.get(self.standing, WRONG) if self.fits else WRONG

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
    steps: str                 # what the steps' own error comes from, in words
    mesh: str                  # what the mesh's own error comes from, in words
    own_error: float           # with its error bar [m]
    without_bar: float         # m; NaN: of an earlier record
    time_error: float          # with its error bar [m]; NaN: not known
    mesh_error: float          # m; NaN: not known
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
        return list(dict.fromkeys(case.commit for case in self.cases if case.recorded == recorded))

    def of_origin(self, recorded: bool) -> list[CaseNeeds]:
        """The cases that are recorded, or those asked beside the run."""
        return [case for case in self.cases if case.recorded == recorded]

    def kinds(self) -> list[str]:
        """Of parts that any case has or lacks, those of KINDS first."""
        found = {part.kind: None for case in self.cases for part in case.parts}
        return [kind for kind in KINDS if kind in found] + [
            kind for kind in found if kind not in KINDS
        ]

    def count(self, standing: str) -> int:
        """Parts of all cases that stand so, one of NEEDS."""
        return sum(part.standing == standing for case in self.cases for part in case.parts)

    def in_words(self) -> str:
        """How many parts stand how, one sentence for each kind that there is."""
        said = {
            "needed": "needed",
            "kept for a reason": "not needed, and kept for a reason that the case gives",
            "left out for a reason": "missing, and left out for a reason that the case gives",
            "not needed here": "not needed, without a reason",
            "missing here": "missing, without a reason",
            NO_EFFECT: "absent, and of no effect if added",
            CANNOT_TELL: "undecided: the change is within the error bar"
        }
        counts = {standing: self.count(standing) for standing in NEEDS}
        return " ".join(
            f"{count} part{'s are' if count != 1 else ' is'} {said[standing]}."
            for standing, count in counts.items()
            if count
        )

    def of(self, name: str) -> CaseNeeds | None:
        """Result for the case of that name; None if it was not requested."""
        return next((case for case in self.cases if case.name == name), None)


def load_needs(file: Path, cases: Path | None = None) -> Needs | None:
    """The outcomes of `foldproof ablate --out DIR`, and of cases that it does not speak of those
    that are recorded in the folder `cases`; None if there are none.
    Throws Unreadable for other files."""
    found: list[CaseNeeds] = []
    if file.is_file():
        with reading(file):
            here = json.loads(file.read_text(encoding="utf-8"))
            found = [
                _case(row, here["program"], recorded=False, changed=False) for row in here["cases"]
            ]
    known, kept = {case.name for case in found}, cases / "needs.json" if cases else None
    if cases and kept and kept.is_file():
        with reading(kept):
            rows = json.loads(kept.read_text(encoding="utf-8"))["cases"]
            found += [
                _case(row, row["program"], recorded=True, changed=_has_changed(row, cases))
                for row in rows
                if row["case"] not in known
            ]
    return Needs(found) if found else None


def _has_changed(row: dict[str, Any], cases: Path) -> bool:
    files = case_files(cases)
    return (
        row["case"] not in files
        or case_digest(files[row["case"]], lambda name: (cases / name).read_bytes())
        != row["digest"]
    )


def _case(
    row: dict[str, Any], program: dict[str, Any], *, recorded: bool, changed: bool
) -> CaseNeeds:
    own, scene = row["own_error"], row["run"]
    part_of_time = (
        f"first {row['asked_end']:g} of {row['end']:g} s"
        if row.get("asked_end") != row.get("end")
        else ""
    )
    kind, mesh = (
        ("coarser mesh", f"from a coarser mesh, {', '.join(own['coarser_mesh'])},")
        if own.get("coarser_mesh")
        else ("finer mesh", "finer mesh")
    )
    # earlier records have the change from one halving of the step
    steps = "its steps" if own.get("levels") else "half the step"
    unknown = "; ".join(
        f"{other}: {why}"
        for other, why in ((steps, own["without_time"]), (kind, own["without_mesh"]))
        if why
    )
    return CaseNeeds(
        row["case"], row.get("overrides", []), part_of_time, row["wrong"], steps, mesh,
        _number(own["value"]), _number(own.get("without_bar")), _number(own["time"]),
        _number(own["mesh"]), unknown,
        scene["seconds"], _number(scene["crossings"]), _number(scene["deepest"]),
        [_part(part, scene) for part in row["parts"]], program["commit"],
        program.get("tree") == "dirty", recorded, changed
    )


def _part(part: dict[str, Any], scene: dict[str, Any]) -> PartNeed:
    run = part["run"]
    work = [
        (words, run[key] / scene[key])
        for key, words in COUNTED.items()
        if scene[key] and run[key] != scene[key]
    ]
    return PartNeed(
        part["name"], part["present"], part["need"], part["because"],
        part["declared"], part["as_it_should_be"], _number(part["position_difference"]),
        _number(part["energy_difference"]), _number(run["crossings"]), _number(run["deepest"]),
        run["seconds"] / scene["seconds"] if scene["seconds"] else nan, work
    )


def _number(value: float | None) -> float:
    return nan if value is None else float(value)
