"""Reads what a run wrote (HDF5, layout in README.md) into plain dataclasses.

    from results import load_run, load_case
    run = load_run("results/run.h5")
    case = load_case("results/hanging_sheet.h5"); x = case.positions(-1)     # N x 3 [m]

Reading never decides anything: outcomes are the strings that the program wrote. An absent attribute becomes
"" or NaN, an absent group an empty list. Nothing large is read before it is asked for.
"""
from __future__ import annotations

import json
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import h5py
import numpy as np


@dataclass
class Column:
    """One column of a table: numbers, or strings as an object array."""
    name: str
    unit: str
    values: np.ndarray


@dataclass
class Finding:
    """One answered question. It held iff measured + uncertainty <= bound; `outcome` says so, as written by
    the program."""
    name: str
    kind: str          # "check" | "study" | "bench"
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


@dataclass
class Curve:
    """y against x; points below `floor` mean nothing (NaN: no floor). pair_orders has one entry less than x,
    or is None."""
    label: str
    x: np.ndarray
    y: np.ndarray
    floor: float
    pair_orders: np.ndarray | None


@dataclass
class StudyFigure:
    """One set of axes. `slope` is the expected slope in log-log axes (NaN: none)."""
    name: str
    title: str
    caption: str
    x_label: str
    x_unit: str
    y_label: str
    y_unit: str
    x_scale: str       # "linear" | "log"
    y_scale: str
    slope: float
    curves: list[Curve]


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
class Case:
    """One simulation. Frames stay in the file until `positions` asks for one."""
    path: Path
    about_run: dict[str, Any]          # root attributes: command, commit, built, case_text, ...
    triangles: np.ndarray              # M x 3
    held: np.ndarray                   # N, true where the motion is prescribed
    frame_times: np.ndarray            # T [s]
    diagnostics: dict[str, Column] = field(default_factory=dict)

    def positions(self, frame: int) -> np.ndarray:
        """Positions of all particles in one frame, N x 3 [m]; negative counts from the end."""
        with h5py.File(self.path, "r") as file:
            data = file["frames/positions"]
            return np.asarray(data[frame % data.shape[0]], dtype=float)


@dataclass
class Run:
    """Everything that one run found."""
    provenance: dict[str, Any]
    findings: list[Finding]
    studies: list[Study]
    cases: list[CaseEntry]
    faults: list[Fault]


def load_run(path: str | Path) -> Run:
    """Reads run.h5 or bench.h5. Throws OSError if it cannot be opened."""
    path = Path(path)
    with h5py.File(path, "r") as file:
        return Run(provenance=_attributes(file),
                   findings=[_finding(name, group) for name, group in _in_order(file, "findings")],
                   studies=[_study(name, group) for name, group in _in_order(file, "studies")],
                   cases=[_case_entry(name, group, path.parent) for name, group in _in_order(file, "cases")],
                   faults=_with_outcomes(_faults(file), path.parent / "faults.json"))


def load_case(path: str | Path) -> Case:
    """Reads one simulation but its frames. Throws OSError or KeyError if the file is not one."""
    path = Path(path)
    with h5py.File(path, "r") as file:
        particles = file["frames/positions"].shape[1]
        held = np.asarray(file["mesh/held"], dtype=bool) if "mesh/held" in file else np.zeros(particles, bool)
        return Case(path=path, about_run=_attributes(file), held=held,
                    triangles=np.asarray(file["mesh/triangles"], dtype=np.int64).reshape(-1, 3),
                    frame_times=np.asarray(file["frames/time"], dtype=float),
                    diagnostics={column.name: column for column in _columns(file.get("diagnostics"))})


def case_entry_of_file(path: Path) -> CaseEntry | None:
    """The entry of a case file that no run names; None if the file holds no frames."""
    try:
        with h5py.File(path, "r") as file:
            if "frames" not in file:
                return None
            said = _attributes(file)
    except OSError:
        return None
    return CaseEntry(name=_text(said, "case_name") or path.stem, title=_text(said, "title") or path.stem,
                     about=_text(said, "about"), seconds=_number(said, "seconds"),
                     stopped=_text(said, "stopped"),
                     path=path)


def _finding(name: str, group: h5py.Group) -> Finding:
    said = _attributes(group)
    texts = {key: _text(said, key) for key in
             ("kind", "study", "claim", "source", "unit", "why_bound", "outcome", "note", "better")}
    numbers = {key: _number(said, key) for key in ("measured", "bound", "uncertainty", "seconds")}
    return Finding(name=name, **texts, **numbers, faults=_texts(said, "faults"),
                   evidence=_columns(group.get("evidence")))


def _study(name: str, group: h5py.Group) -> Study:
    said = _attributes(group)
    return Study(name=name, claim=_text(said, "claim"), source=_text(said, "source"),
                 about=_text(said, "about"),
                 seconds=_number(said, "seconds"),
                 figures=[_figure(key, figure) for key, figure in _in_order(group, "figures")],
                 tables=[Table(_text(_attributes(table), "title") or key, _columns(table))
                         for key, table in _in_order(group, "tables")])


def _figure(name: str, group: h5py.Group) -> StudyFigure:
    said = _attributes(group)
    texts = {key: _text(said, key) for key in ("title", "caption", "x_label", "x_unit", "y_label", "y_unit")}
    scales = {key: _text(said, key) or "linear" for key in ("x_scale", "y_scale")}
    return StudyFigure(name=name, **texts, **scales, slope=_number(said, "slope"),
                       curves=[_curve(key, curve) for key, curve in _in_order(group, "curves")])


def _curve(name: str, group: h5py.Group) -> Curve:
    said = _attributes(group)
    orders = np.asarray(group["pair_orders"], dtype=float) if "pair_orders" in group else None
    return Curve(label=_text(said, "label") or name, floor=_number(said, "floor"), pair_orders=orders,
                 x=np.asarray(group["x"], dtype=float), y=np.asarray(group["y"], dtype=float))


def _case_entry(name: str, group: h5py.Group, folder: Path) -> CaseEntry:
    said = _attributes(group)
    return CaseEntry(name=name, title=_text(said, "title") or name, about=_text(said, "about"),
                     seconds=_number(said, "seconds"), stopped=_text(said, "stopped"),
                     path=folder / (_text(said, "file") or f"{name}.h5"))


def _with_outcomes(faults: list[Fault], file: Path) -> list[Fault]:
    """Outcomes of `scripts/faults --out DIR/faults.json`, if that was run for this folder."""
    if not file.is_file():
        return faults
    outcomes = {row["name"]: row["outcome"] for row in json.loads(file.read_text())["faults"]}
    return [replace(fault, outcome=outcomes.get(fault.name, fault.outcome)) for fault in faults]


def _faults(file: h5py.File) -> list[Fault]:
    columns = {column.name: [str(value) for value in column.values]
               for column in _columns(file.get("faults"))}
    keys = ("name", "file", "find", "replace", "law", "caught_by", "outcome")
    rows = zip(*(columns.get(key, [""] * len(columns.get("name", []))) for key in keys))
    return [Fault(name, where, find, replace, law,
                  [part.strip() for part in caught.split(",") if part.strip()], outcome)
            for name, where, find, replace, law, caught, outcome in rows]


def _columns(group: h5py.Group | None) -> list[Column]:
    if group is None:
        return []
    sets = [(key, item) for key, item in group.items() if isinstance(item, h5py.Dataset)]
    sets.sort(key=lambda entry: (_number(_attributes(entry[1]), "order", 0), entry[0]))
    return [Column(key, _text(_attributes(item), "unit"), _values(item)) for key, item in sets]


def _values(data: h5py.Dataset) -> np.ndarray:
    values = data[()]
    if np.asarray(values).dtype.kind in "OSU":
        return np.array([_decoded(value) for value in np.atleast_1d(values)], dtype=object)
    return np.atleast_1d(np.asarray(values, dtype=float))


def _in_order(group: h5py.Group, key: str) -> list[tuple[str, h5py.Group]]:
    inner = [(name, item) for name, item in group.get(key, {}).items() if isinstance(item, h5py.Group)]
    return sorted(inner, key=lambda entry: (_number(_attributes(entry[1]), "order", 0), entry[0]))


def _attributes(item: h5py.Group | h5py.Dataset) -> dict[str, Any]:
    return {key: _decoded(value) for key, value in item.attrs.items()}


def _decoded(value: Any) -> Any:
    if isinstance(value, bytes):
        return value.decode("utf-8", "replace")
    if isinstance(value, np.ndarray) and value.dtype.kind in "OSU":
        return [_decoded(entry) for entry in value.ravel()]
    return value


def _text(said: dict[str, Any], key: str) -> str:
    value = said.get(key, "")
    return "" if isinstance(value, h5py.Empty) else str(value)


def _texts(said: dict[str, Any], key: str) -> list[str]:
    value = said.get(key, [])
    if isinstance(value, str):
        value = [value]
    return [] if isinstance(value, h5py.Empty) else [str(entry) for entry in value if str(entry)]


def _number(said: dict[str, Any], key: str, absent: float = float("nan")) -> float:
    value = said.get(key, absent)
    try:
        return float(np.ravel(value)[0])
    except (TypeError, ValueError, IndexError):
        return absent
