"""A run of foldproof in numpy, by name. Lengths in m, times in s, all else in
the unit that stands beside it.

    from foldproof_results import load_results
    run = load_results("results")                    # or the path of a run.h5 or bench.h5
    x = run.trajectory("hanging_sheet").positions    # T x N x 3 [m]

Reading is that of results.py. A file that is missing, damaged, or none of foldproof's raises
Unreadable, which names it.
"""
from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from data.hdf5_values import Column
from data.results import CaseEntry, CaseObject, Claim, Finding, load_case, load_run
from data.studies import OnAxes, Study, StudyMap
from data.unreadable import Unreadable

__all__ = [
    "Results", "Trajectory", "Unreadable", "columns_of_study", "evidence_of", "findings_table",
    "load_results", "load_trajectory"
]

Item = TypeVar("Item")


@dataclass
class Trajectory:
    """One simulation of N particles and M triangles: T frames, and S rows of
    diagnostics, one for each step."""
    times: np.ndarray               # T [s]
    positions: np.ndarray           # T x N x 3 [m]
    velocities: np.ndarray | None   # T x N x 3 [m/s]; None if the file has none
    triangles: np.ndarray           # M x 3, numbers of particles from 0
    held: np.ndarray                # N, true where the motion is prescribed
    # name: unit, and values of S or, for vectors, S x 3; "time" [s] belongs to them all. Energies
    # and momenta, the step, and what it cost: cg_iterations, object_contacts, close_pairs, ...
    diagnostics: dict[str, Column]
    rest: np.ndarray | None         # N x 3, positions of the rest shape [m]; None: not in the file
    masses: np.ndarray | None       # N [kg]; None: not in the file
    # T x N, to the nearest object, negative inside [m]; None without objects
    distances: np.ndarray | None
    objects: dict[str, CaseObject]  # by name: .triangles, .positions(frame), V x 3 [m]
    findings: dict[str, Finding]    # what the case expects, judged


@dataclass
class Results:
    """Findings of one run, by name, in order. The classes are those of results.py,
    where each field has its unit."""
    # version, commit, compiler, flags, cpu, date, command, tier, seed, seconds [s], ...
    provenance: dict[str, Any]
    # .outcome, .measured, .bound and .uncertainty [.unit]; evidence_of(...) for the rest
    findings: dict[str, Finding]
    studies: dict[str, Study]       # columns_of_study(...) for their numbers
    claims: dict[str, Claim]        # "T1": .ruling, .decided_by
    cases: dict[str, CaseEntry]     # .title, .seconds [s], .path

    def trajectory(self, case: str) -> Trajectory:
        """The simulation of a case of this run. Throws KeyError for a
        name that the run does not have."""
        if case not in self.cases:
            raise KeyError(
                f"no case '{case}' in this run; it has: {', '.join(self.cases) or 'none'}"
            )
        return load_trajectory(self.cases[case].path)


def load_results(path: str | Path) -> Results:
    """Reads a run: the folder that holds run.h5, or the file itself. Trajectories stay on the disk
    until they are asked for."""
    path = Path(path)
    file = path / "run.h5" if path.is_dir() else path
    run = load_run(file)
    if not (run.findings or run.studies or run.cases):
        raise Unreadable(
            f"{file}: no run of foldproof: it holds no findings, no studies and no cases"
        )
    findings, studies, claims, cases = (
        _by_name((item.name, item) for item in items)
        for items in (run.findings, run.studies, run.claims, run.cases)
    )
    return Results(run.provenance, findings, studies, claims, cases)


def load_trajectory(path: str | Path) -> Trajectory:
    """Reads one <case>.h5 with all its frames."""
    case = load_case(path)
    positions, velocities = case.every_frame("positions"), case.every_frame("velocities")
    frames, particles = len(case.frame_times), len(case.held)
    for what in (positions, velocities):
        if what is not None and what.shape != (frames, particles, 3):
            raise Unreadable(
                f"{path}: damaged: {frames} frames of {particles} particles, but an array of"
                f" {what.shape}"
            )
    if case.triangles.size and not (case.triangles.min() >= 0 and case.triangles.max() < particles):
        raise Unreadable(
            f"{path}: damaged: a triangle names a particle that is none of the {particles}"
        )
    return Trajectory(
        case.frame_times, positions, velocities, case.triangles, case.held, case.diagnostics,
        case.rest_positions(), case.masses(), case.every_frame("object_distance"),
        _by_name((one.name, one) for one in case.objects),
        _by_name((finding.name, finding) for finding in case.findings)
    )


def findings_table(findings: dict[str, Finding]) -> dict[str, np.ndarray]:
    """Findings as columns of one length: name, outcome, measured, bound, uncertainty, unit,
    seconds, claim. pandas.DataFrame takes it as it is."""
    names = ("name", "outcome", "measured", "bound", "uncertainty", "unit", "seconds", "claim")
    return {
        name: np.array([getattr(finding, name) for finding in findings.values()])
        for name in names
    }


def evidence_of(finding: Finding) -> dict[str, Column]:
    """The columns of a finding's evidence by name: .unit, and .values, equally many in all
    (numbers, or strings)."""
    return _by_name((column.name, column) for column in finding.evidence)


def columns_of_study(study: Study) -> dict[str, dict[str, Column]]:
    """All numbers of a study: first the name of a figure or map or the title of
    a table, then that of a column.

    A table has its own columns. A curve of a figure, or over a map, is "LABEL: x" and "LABEL: y" (n
    each), "LABEL: order" (n - 1, between neighbours) where orders were observed, "LABEL: mark" (n
    strings: measured | unfinished | diverged) where runs were marked. A map has "x" (n), "y" (m)
    and "values" (m x n; NaN where there is none)."""
    of_figures = [(figure.name, _columns_of_curves(figure)) for figure in study.figures]
    of_maps = [(study_map.name, _columns_of_map(study_map)) for study_map in study.maps]
    of_tables = [
        (table.title, _by_name((column.name, column) for column in table.columns))
        for table in study.tables
    ]
    return _by_name(of_figures + of_maps + of_tables)


def _columns_of_map(study_map: StudyMap) -> dict[str, Column]:
    own = [Column("x", study_map.x_unit, study_map.x), Column("y", study_map.y_unit, study_map.y),
           Column("values", study_map.unit, study_map.values)]
    return {column.name: column for column in own} | _columns_of_curves(study_map)


def _columns_of_curves(axes: OnAxes) -> dict[str, Column]:
    columns = []
    for curve in axes.curves:
        parts = [
            ("x", axes.x_unit, curve.x), ("y", axes.y_unit, curve.y),
            ("order", "1", curve.pair_orders), ("mark", "", curve.marks)
        ]
        columns += [
            Column(f"{curve.label}: {part}", unit, values)
            for part, unit, values in parts
            if values is not None
        ]
    return _by_name((column.name, column) for column in columns)


def _by_name(items: Iterable[tuple[str, Item]]) -> dict[str, Item]:
    """Items by name, in their order. Of two with one name the second gets " (2)"
    behind it, so that none is lost."""
    named: dict[str, Item] = {}
    for name, item in items:
        free, count = name, 1
        while free in named:
            count += 1
            free = f"{name} ({count})"
        named[free] = item
    return named
