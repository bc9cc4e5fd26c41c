"""Reads what a run wrote (HDF5, layout in verification/FORMAT.md) into plain dataclasses.

    run = load_run("results/run.h5")
    case = load_case("results/hanging_sheet.h5"); x = case.positions(-1)     # N x 3 [m]

Reading never decides anything: outcomes are the strings that the program wrote. An absent attribute
becomes "" or NaN, an absent group an empty list. Nothing large is read before it is asked for.
"""
from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from data.damage import why_unreadable
from data.hdf5_values import (
    Column, attributes_of, columns_of, in_order, number_of, text_of, texts_of
)
from data.unreadable import Unreadable, reading


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
class Curve:
    """y against x; points below `floor` mean nothing (NaN: no floor). pair_orders has one entry
    less than x, or is None. `slope` is the one expected in log-log axes (NaN: none). marks has one
    entry for each point, or is None."""
    label: str
    x: np.ndarray
    y: np.ndarray
    floor: float
    pair_orders: np.ndarray | None
    slope: float
    marks: np.ndarray | None    # "measured" | "unfinished" | "diverged"


@dataclass
class OnAxes:
    """Fields common to figures and maps."""
    name: str
    title: str
    caption: str
    x_label: str
    x_unit: str
    y_label: str
    y_unit: str
    x_scale: str       # "linear" | "log"
    y_scale: str
    curves: list[Curve]


@dataclass
class StudyFigure(OnAxes):
    """One set of axes. `slope` is the expected slope in log-log axes (NaN: none)."""
    slope: float


@dataclass
class StudyMap(OnAxes):
    """A quantity over two parameters, with limits known beforehand as curves over it."""
    quantity: str
    unit: str          # of the values
    scale: str         # of the values
    x: np.ndarray      # n
    y: np.ndarray      # m
    values: np.ndarray  # m x n; NaN where there is none, as the caption says


@dataclass
class Table:
    """A titled table of columns of equal length."""
    title: str
    columns: list[Column]


@dataclass
class Study:
    """A measured rate or cost, with its curves and tables."""
    name: str
    claim: str
    source: str
    about: str
    seconds: float
    figures: list[StudyFigure]
    tables: list[Table]
    maps: list[StudyMap] = field(default_factory=list)


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
            data = file.get(f"frames/{quantity}")
            return None if data is None else np.asarray(data, dtype=float)

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

    def rest_positions(self) -> np.ndarray | None:
        """Rest positions of all particles, N x 3 [m]; None if the file has none."""
        with h5py.File(self.path, "r") as file:
            return (
                np.asarray(file["mesh/rest_positions"], dtype=float)
                if "mesh/rest_positions" in file
                else None
            )


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
            studies=[_study(name, group) for name, group in in_order(file, "studies")],
            cases=[
                _case_entry(name, group, path.parent) for name, group in in_order(file, "cases")
            ],
            faults=_with_outcomes(_faults(file), path.parent / "faults.json"),
            claims=[_claim(name, group) for name, group in in_order(file, "claims")],
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
        return Case(
            path=path, about_run=attributes_of(file), held=held,
            triangles=np.asarray(file["mesh/triangles"], dtype=np.int64).reshape(-1, 3),
            frame_times=np.asarray(file["frames/time"], dtype=float),
            objects=[_object(group) for group in file.get("objects", {}).values()],
            findings=[_finding(name, group) for name, group in file.get("findings", {}).items()],
            diagnostics={column.name: column for column in columns_of(file.get("diagnostics"))},
            gravity=_gravity(file)
        )


def _gravity(file: h5py.File) -> np.ndarray | None:
    return np.asarray(file["gravity"], dtype=float).reshape(3) if "gravity" in file else None


def _object(group: h5py.Group) -> CaseObject:
    names = {
        "vertices": "vertices", "rotation": "rotation", "translation": "translation",
        "positions": "deformed"
    }
    arrays = {
        field: np.asarray(group[key], dtype=float) for key, field in names.items() if key in group
    }
    attributes = attributes_of(group)
    return CaseObject(
        name=text_of(attributes, "name"), shape=text_of(attributes, "shape"), **arrays,
        triangles=np.asarray(group["triangles"], dtype=np.int64).reshape(-1, 3)
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
    return CaseEntry(
        name=text_of(attributes, "case_name") or path.stem,
        title=text_of(attributes, "title") or path.stem, about=text_of(attributes, "about"),
        seconds=number_of(attributes, "seconds"), stopped=text_of(attributes, "stopped"), path=path
    )


def _finding(name: str, group: h5py.Group) -> Finding:
    attributes = attributes_of(group)
    texts = {
        key: text_of(attributes, key)
        for key in (
            "kind", "study", "claim", "source", "unit", "why_bound", "outcome", "note", "better",
            "basis", "scope", "certainty", "headline"
        )
    }
    numbers = {
        key: number_of(attributes, key) for key in ("measured", "bound", "uncertainty", "seconds")
    }
    return Finding(name=name, **texts, **numbers, faults=texts_of(attributes, "faults"),
                   evidence=columns_of(group.get("evidence")))


def _study(name: str, group: h5py.Group) -> Study:
    attributes = attributes_of(group)
    return Study(
        name=name,
        claim=text_of(attributes, "claim"),
        source=text_of(attributes, "source"),
        about=text_of(attributes, "about"),
        seconds=number_of(attributes, "seconds"),
        figures=[_figure(key, figure) for key, figure in in_order(group, "figures")],
        maps=[_map(key, group) for key, group in in_order(group, "maps")],
        tables=[
            Table(text_of(attributes_of(table), "title") or key, columns_of(table))
            for key, table in in_order(group, "tables")
        ],
    )


def _figure(name: str, group: h5py.Group) -> StudyFigure:
    attributes = attributes_of(group)
    return StudyFigure(
        name=name, **_axes(attributes), slope=number_of(attributes, "slope"), curves=_curves(group)
    )


def _map(name: str, group: h5py.Group) -> StudyMap:
    attributes = attributes_of(group)
    x, y = (np.asarray(group[key], dtype=float) for key in "xy")
    return StudyMap(
        name=name, **_axes(attributes), quantity=text_of(attributes, "quantity"),
        unit=text_of(attributes, "unit"), scale=text_of(attributes, "scale") or "linear", x=x, y=y,
        curves=_curves(group),
        values=np.asarray(group["values"], dtype=float).reshape(len(y), len(x))
    )


def _axes(attributes: dict[str, Any]) -> dict[str, str]:
    texts = {
        key: text_of(attributes, key)
        for key in ("title", "caption", "x_label", "x_unit", "y_label", "y_unit")
    }
    return texts | {key: text_of(attributes, key) or "linear" for key in ("x_scale", "y_scale")}


def _curves(group: h5py.Group) -> list[Curve]:
    return [_curve(key, curve) for key, curve in in_order(group, "curves")]


def _curve(name: str, group: h5py.Group) -> Curve:
    attributes = attributes_of(group)
    orders = np.asarray(group["pair_orders"], dtype=float) if "pair_orders" in group else None
    x, y = (np.asarray(group[key], dtype=float) for key in "xy")
    marks = group["marks"].asstr()[:] if "marks" in group else None
    return Curve(
        label=text_of(attributes, "label") or name, floor=number_of(attributes, "floor"),
        pair_orders=orders, slope=number_of(attributes, "slope"), x=x, y=y, marks=marks
    )


def _claim(name: str, group: h5py.Group) -> Claim:
    attributes = attributes_of(group)
    texts = {
        key: text_of(attributes, key)
        for key in (
            "section", "statement", "ruling", "recorded", "condition", "why", "begins", "printed",
            "restored", "paper", "paper_title", "missing"
        )
    }
    names, roles = texts_of(attributes, "decided_by"), texts_of(attributes, "roles")
    paragraph = number_of(attributes, "paragraph")
    return Claim(name=name, **texts, decided_by=list(zip(names, roles + [""] * len(names))),
                 paragraph=0 if np.isnan(paragraph) else int(paragraph))


def _case_entry(name: str, group: h5py.Group, folder: Path) -> CaseEntry:
    attributes = attributes_of(group)
    return CaseEntry(
        name=name, title=text_of(attributes, "title") or name, about=text_of(attributes, "about"),
        seconds=number_of(attributes, "seconds"), stopped=text_of(attributes, "stopped"),
        path=folder / Path(text_of(attributes, "file") or f"{name}.h5").name
    )


def _with_outcomes(faults: list[Fault], file: Path) -> list[Fault]:
    """Outcomes of `scripts/faults --out DIR/faults.json`, if that was run for this folder."""
    if not file.is_file():
        return faults
    with reading(file):
        rows = {row["name"]: row for row in json.loads(file.read_text(encoding="utf-8"))["faults"]}
        return [
            _with_outcome(fault, rows[fault.name]) if fault.name in rows else fault
            for fault in faults
        ]


def _with_outcome(fault: Fault, row: dict[str, Any]) -> Fault:
    def number(value: float | None) -> float:
        return float("nan") if value is None else value
    checks = [
        FaultCheck(
            attributes["name"], attributes["outcome"],
            *(number(attributes[key]) for key in ("measured", "bound", "margin"))
        )
        for attributes in row.get("checks", [])
    ]
    return replace(fault, outcome=row["outcome"], checks=checks)


def _faults(file: h5py.File) -> list[Fault]:
    columns = {column.name: [str(value) for value in column.values]
               for column in columns_of(file.get("faults"))}
    keys = ("name", "file", "find", "replace", "law", "caught_by", "outcome", "caught_by_tests")
    rows = zip(*(columns.get(key, [""] * len(columns.get("name", []))) for key in keys))
    return [
        Fault(
            name, where, find, replace, law,
            [part.strip() for part in caught.split(",") if part.strip()], outcome,
            [test for test in tests.split("\n") if test]
        )
        for name, where, find, replace, law, caught, outcome, tests in rows
    ]
