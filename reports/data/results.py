"""Reads what a run wrote (HDF5, layout in verification/FORMAT.md) into plain dataclasses.

    run = load_run("results/run.h5")
    case = load_case("results/hanging_sheet.h5"); x = case.positions(-1)     # N x 3 [m]

Reading never decides anything: outcomes are the strings that the program wrote. An absent attribute
becomes "" or NaN, an absent group an empty list. Nothing large is read before it is asked for.
"""
from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from data.damage import why_unreadable
from data.hdf5_values import (
    Column, attributes_of, columns_of, from_attributes, in_order, numbers_of, text_of, texts_of
)
from data.records import record
from data.studies import Study, study_of
from data.unreadable import Unreadable, read_json, reading


@dataclass
class Finding:
    """One answered question. It held iff measured + uncertainty <= bound; `outcome` says so, as
    written by the program."""
    name: str
    kind: str          # "check" | "study" | "validation" | "bench"
    study: str
    claim: str
    source: str
    measured: float    # [unit]
    bound: float       # [unit]; for "bench" the stated target
    uncertainty: float  # [unit]
    unit: str
    why_bound: str
    outcome: str       # "holds" | "fails" | "inconclusive" | "not applicable" | "measured"
    note: str
    seconds: float
    better: str        # "higher" | "lower" for "bench", else ""
    faults: list[str]
    evidence: list[Column]
    # of the bound: "reasoned" | "empirical"; "" in files that do not hold it, as the next two
    basis: str = ""
    scope: str = ""      # "specific" | "generic" | "structural"
    # "estimated" | "counted" | "within bound" | "computed" | "timed once" | "structural"
    certainty: str = ""
    headline: str = ""   # what was measured, in words and units, where the judged number is another


@dataclass
class Claim:
    """A sentence of the paper and what the run ruled of it."""
    name: str          # "T1"
    section: str       # of the paper
    statement: str
    ruling: str        # "confirmed" | "confirmed under a condition" | "refuted" | "undecided"
    recorded: str      # the ruling that is expected
    condition: str     # in words; "" if none
    why: str           # a paragraph
    decided_by: list[tuple[str, str]]   # name of a finding, its role
    paragraph: int = 0      # of the section, from 1; 0 in files that do not hold it
    begins: str = ""        # the first words of the paper's sentence
    printed: str = ""       # a formula as printed, and
    restored: str = ""      # as it must read; "" where they agree
    paper: str = ""         # its key, "BMF03"; "" in files that do not hold it
    paper_title: str = ""   # with its year
    missing: str = ""       # undecided without findings: what a ruling needs and the suite lacks


@dataclass
class FaultCheck:
    """Result of one check or test on a program with a seeded fault. Tests measure nothing: NaN."""
    name: str
    outcome: str
    measured: float
    bound: float
    margin: float      # measured/bound


@dataclass
class Fault:
    """A seeded fault: one edit of one file, the law that it breaks, and who must notice."""
    name: str
    file: str
    find: str
    replace: str
    law: str
    caught_by: list[str]
    outcome: str       # "caught" | "SURVIVED" | "not run"
    caught_by_tests: list[str] = field(default_factory=list)   # names of test cases
    checks: list[FaultCheck] = field(default_factory=list)   # of those that are named
    commit: str = ""   # on which a recorded outcome was found; "" for one of this run, or none


@dataclass
class CaseEntry:
    """A case as the run names it. `path` may point at a file that is not there."""
    name: str
    title: str
    about: str
    seconds: float
    stopped: str       # "" or the reason
    path: Path


@dataclass
class CaseObject:
    """An object that the cloth can hit: a surface that moves as a whole, or deforms."""
    name: str
    vertices: np.ndarray     # V x 3 [m], before its motion
    triangles: np.ndarray    # F x 3
    rotation: np.ndarray | None = None     # T x 4: quaternions w, x, y, z; None: it deforms
    translation: np.ndarray | None = None  # T x 3 [m]; None: it deforms
    deformed: np.ndarray | None = None     # T x V x 3 [m]; None: it moves as a whole
    shape: str = ""                        # of the case file: "half_space", "sphere", "mesh", ...

    def positions(self, frame: int) -> np.ndarray:
        """Its vertices in one frame, V x 3 [m]: v + 2 w (q x v) + 2 q x (q
        x v), then moved; or as stored."""
        if self.deformed is not None:
            return self.deformed[frame]
        w, q = self.rotation[frame, 0], self.rotation[frame, 1:]
        twice = 2.0 * np.cross(q, self.vertices)
        return self.vertices + w * twice + np.cross(q, twice) + self.translation[frame]


@dataclass
class Case:
    """One simulation. Frames stay in the file until `positions` asks for one."""
    path: Path
    about_run: dict[str, Any]          # root attributes: command, commit, built, case_text, ...
    triangles: np.ndarray              # M x 3
    held: np.ndarray                   # N, true where the motion is prescribed
    frame_times: np.ndarray            # T [s]
    diagnostics: dict[str, Column] = field(default_factory=dict)
    findings: list[Finding] = field(default_factory=list)   # what was expected of it, judged
    objects: list[CaseObject] = field(default_factory=list)
    gravity: np.ndarray | None = None  # 3 [m/s^2]; None: there is none, or the file does not say

    def positions(self, frame: int) -> np.ndarray:
        """Positions of all particles in one frame, N x 3 [m]; negative counts from the end."""
        with h5py.File(self.path, "r") as file:
            data = file["frames/positions"]
            return np.asarray(data[frame % data.shape[0]], dtype=float)

    def every_frame(self, quantity: str) -> np.ndarray | None:
        """The "positions" [m] or "velocities" [m/s] of all particles in all frames, T x N x 3, or
        their "object_distance" [m], T x N; None if the file has none."""
        with h5py.File(self.path, "r") as file:
            return numbers_of(file, f"frames/{quantity}")

    def stuck(self, frame: int) -> np.ndarray | None:
        """N, true for particles that stick to something in one frame; None if
        nothing in the case is sticky."""
        with h5py.File(self.path, "r") as file:
            if "sticky/bond_counts" not in file:
                return None
            ends = np.cumsum(np.asarray(file["sticky/bond_counts"], dtype=int))
            frame %= len(ends)
            first = ends[frame - 1] if frame > 0 else 0
            stuck = np.zeros(len(self.held), dtype=bool)
            stuck[np.asarray(file["sticky/bonds"][first:ends[frame], 2], dtype=int)] = True
            return stuck

    def masses(self) -> np.ndarray | None:
        """Masses of all particles, N [kg]; None if the file has none."""
        with h5py.File(self.path, "r") as file:
            return numbers_of(file, "mesh/mass")

    def pattern(self) -> np.ndarray | None:
        """Corners of all triangles in flat panels, M x 3 x 2 [m]; None without a pattern."""
        with h5py.File(self.path, "r") as file:
            return numbers_of(file, "mesh/pattern")

    def rest_positions(self) -> np.ndarray | None:
        """Rest positions of all particles, N x 3 [m]; None if the file has none."""
        with h5py.File(self.path, "r") as file:
            return numbers_of(file, "mesh/rest_positions")


@dataclass
class Run:
    """Everything that one run found."""
    provenance: dict[str, Any]
    findings: list[Finding]
    studies: list[Study]
    cases: list[CaseEntry]
    faults: list[Fault]
    claims: list[Claim] = field(default_factory=list)
    path: Path | None = None           # run.h5; None where a run is made up of case files alone


@contextmanager
def reading_hdf5(path: Path) -> Iterator[None]:
    """As `reading`, of an HDF5 file, which is looked through for damage first."""
    with reading(path):
        if why := why_unreadable(path):
            raise Unreadable(f"{path}: {why}")
        yield


def load_run(path: str | Path) -> Run:
    """Reads run.h5 or bench.h5. Throws Unreadable naming the file if it
    cannot be opened, or is damaged."""
    path = Path(path)
    with reading_hdf5(path), h5py.File(path, "r") as file:
        return Run(
            path=path,
            provenance=attributes_of(file),
            findings=[_finding(name, group) for name, group in in_order(file, "findings")],
            studies=[study_of(name, group) for name, group in in_order(file, "studies")],
            cases=[
                _case_entry(attributes_of(group), name, path.parent)
                for name, group in in_order(file, "cases")
            ],
            faults=_with_outcomes(_faults(file), path.parent / "faults.json"),
            claims=[_claim(name, attributes_of(group)) for name, group in in_order(file, "claims")],
        )


def load_case(path: str | Path) -> Case:
    """Reads one simulation but its frames. Throws Unreadable naming the file
    if it is not one, or is damaged."""
    path = Path(path)
    with reading_hdf5(path), h5py.File(path, "r") as file:
        for needed in ("mesh/triangles", "frames/time", "frames/positions"):
            if needed not in file:
                raise Unreadable(f"{path}: no simulation of foldproof: it has no /{needed}")
        nobody = np.zeros(file["frames/positions"].shape[1], bool)
        held = np.asarray(file["mesh/held"], dtype=bool) if "mesh/held" in file else nobody
        gravity = numbers_of(file, "gravity")
        return Case(
            path=path, about_run=attributes_of(file), held=held,
            triangles=_triangles(file["mesh"]), frame_times=numbers_of(file, "frames/time"),
            objects=[_object(group) for group in file.get("objects", {}).values()],
            findings=[_finding(name, group) for name, group in file.get("findings", {}).items()],
            diagnostics={column.name: column for column in columns_of(file.get("diagnostics"))},
            gravity=None if gravity is None else gravity.reshape(3)
        )


def case_entry_of_file(path: Path) -> CaseEntry | None:
    """The entry of a case file that no run names; None if the file holds no frames."""
    try:
        with reading_hdf5(path), h5py.File(path, "r") as file:
            if "frames" not in file:
                return None
            attributes = attributes_of(file)
    except Unreadable:
        return None
    name = text_of(attributes, "case_name") or path.stem
    return from_attributes(
        CaseEntry, attributes, name=name, title=text_of(attributes, "title") or path.stem, path=path
    )


def _case_entry(attributes: dict[str, Any], name: str, folder: Path) -> CaseEntry:
    file = Path(text_of(attributes, "file") or f"{name}.h5").name
    return from_attributes(
        CaseEntry, attributes, name=name, title=text_of(attributes, "title") or name,
        path=folder / file
    )


def _triangles(group: h5py.Group) -> np.ndarray:
    return np.asarray(group["triangles"], dtype=np.int64).reshape(-1, 3)


def _object(group: h5py.Group) -> CaseObject:
    arrays = {key: numbers_of(group, key) for key in ("vertices", "rotation", "translation")}
    return from_attributes(
        CaseObject, attributes_of(group), **arrays, deformed=numbers_of(group, "positions"),
        triangles=_triangles(group)
    )


def _finding(name: str, group: h5py.Group) -> Finding:
    return from_attributes(
        Finding, attributes_of(group), name=name, evidence=columns_of(group.get("evidence"))
    )


def _claim(name: str, attributes: dict[str, Any]) -> Claim:
    names, roles = texts_of(attributes, "decided_by"), texts_of(attributes, "roles")
    decided_by = list(zip(names, roles + [""] * len(names)))
    return from_attributes(Claim, attributes, name=name, decided_by=decided_by)


def _with_outcomes(faults: list[Fault], file: Path) -> list[Fault]:
    """Outcomes of `scripts/faults --out DIR/faults.json`, if that was run for this folder."""
    def outcomes(said: dict[str, Any]) -> dict[str, dict[str, Any]]:
        return {
            row["name"]: {
                "outcome": row["outcome"],
                "checks": [record(FaultCheck, check) for check in row.get("checks", [])]
            }
            for row in said["faults"]
        }
    known = read_json(file, outcomes) or {}
    return [replace(fault, **known.get(fault.name, {})) for fault in faults]


def _faults(file: h5py.File) -> list[Fault]:
    columns = {column.name: map(str, column.values) for column in columns_of(file.get("faults"))}
    rows = [dict(zip(columns, row)) for row in zip(*columns.values())]
    return [
        record(
            Fault, row,
            caught_by=[part.strip() for part in row["caught_by"].split(",") if part.strip()],
            caught_by_tests=[test for test in row.get("caught_by_tests", "").split("\n") if test]
        )
        for row in rows
    ]
