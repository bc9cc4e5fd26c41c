"""Runs over time: the verdicts of each, and the first run in which something changed. Subtracts,
divides and sorts; outcomes are the words that the runs stored.

A log is a file of JSON lines, a row for each run:

    {"date": ..., "commit": ..., "version": ..., "tier": ..., "subject": ..., "cpu": ...,
     "command": ...,
     "counts": {"holds": 1008, ...}, "rulings": {"T1": "confirmed", ...},
     "costs": {"the whole run": 52.1, "study time-order.hinge": 1.2, "case grab": 0.8, ...},  # s
     "findings": {NAME: [outcome, measured, bound, seconds], ...}}
"""
from __future__ import annotations

import json
import os
from collections import Counter
from dataclasses import asdict, dataclass
from math import inf, isfinite, nan
from pathlib import Path
from typing import Any

from data.quantities import ratio_of
from data.records import record
from data.results import load_run
from data.unreadable import Unreadable

ABOUT = ("date", "commit", "version", "tier", "subject", "cpu", "command")
RULED = "claim"            # the kind of a claim in verdicts.json
CLOSER = 2.0               # a margin that shrinks by this factor is listed


@dataclass(frozen=True)
class Judged:
    """One finding of one run."""
    outcome: str
    measured: float    # NaN where the run stored no number
    bound: float
    seconds: float

    @property
    def margin(self) -> float:
        """measured/bound [1]; NaN where that says nothing."""
        return ratio_of(self.measured, self.bound)


@dataclass(frozen=True)
class RunRow:
    """One run."""
    about: dict[str, str]              # the keys ABOUT
    counts: dict[str, int]             # findings of each outcome
    rulings: dict[str, str]            # by claim
    # of the run, its studies and its cases [s]; empty without run.h5
    costs: dict[str, float]
    findings: dict[str, Judged]

    @property
    def key(self) -> tuple[str, ...]:
        """Two rows with the same key are of the same run."""
        return tuple(self.about[name] for name in ("date", "commit", "command", "cpu"))

    @property
    def outcomes(self) -> dict[str, str]:
        """By finding."""
        return {name: judged.outcome for name, judged in self.findings.items()}

    @property
    def label(self) -> str:
        """Date and commit, short."""
        return f"{self.about['date'][:16].replace('T', ' ')} {self.about['commit'][:7] or '-'}"


@dataclass(frozen=True)
class Change:
    """A finding or a claim that differs from the run before that had it."""
    run: RunRow
    name: str
    before: str        # outcome or ruling; "" if there was none
    after: str         # "" if there is none any more

    @property
    def is_regression(self) -> bool:
        """It held, or was ruled as before, and does no longer. A finding that is gone is one."""
        return (
            self.before in ("holds", "confirmed", "confirmed under a condition")
            and self.after != self.before
        )


@dataclass(frozen=True)
class MarginChange:
    """A finding whose measured/bound grew by at least CLOSER from one run to the next."""
    run: RunRow
    name: str
    before: float
    after: float


def row_of(path: Path) -> RunRow:
    """The row of a folder's verdicts.json, or of the file itself.
    Throws Unreadable naming the file if it holds no finished run."""
    file = path / "verdicts.json" if path.is_dir() else path
    if not file.exists():
        missing = "file" if path.is_dir() else "folder or file"
        raise Unreadable(
            f"{file}: there is no such {missing}; give the folder of `foldproof verify --out`"
        )
    try:
        written = json.loads(file.read_text(encoding="utf-8"))
        about = {name: str(written["program"].get(name, "")) for name in ABOUT}
        findings = {
            row["name"]: record(Judged, row, outcome=row["outcome"] or "did not run")
            for row in written["findings"]
            if row["kind"] != RULED
        }
        rulings = {row["id"]: row["ruling"] for row in written["findings"] if row["kind"] == RULED}
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise Unreadable(
            f"{file}: no verdicts of foldproof: {type(error).__name__}: {error}"
        ) from error
    if not findings:
        raise Unreadable(f"{file}: no findings in it; the run was cut off before the first")
    return RunRow(about, dict(Counter(judged.outcome for judged in findings.values())), rulings,
                  _costs(file.with_name("run.h5"), about), findings)


def _costs(file: Path, about: dict[str, str]) -> dict[str, float]:
    """Seconds that the run beside verdicts.json took; none if it is
    not there, or is another run's."""
    if not file.is_file():
        return {}
    run = load_run(file)
    if str(run.provenance.get("date")) != about["date"]:
        return {}
    costs = {"the whole run": float(run.provenance.get("seconds", nan))}
    costs |= {f"study {study.name}": study.seconds for study in run.studies}
    costs |= {f"case {case.name}": case.seconds for case in run.cases}
    return {what: seconds for what, seconds in costs.items() if isfinite(seconds)}


def read_log(path: Path) -> list[RunRow]:
    """The rows of a log, in its order; none if there is no such file. A last line that was cut off
    is left out. Throws Unreadable naming file and line for any other line that is no row."""
    if not path.exists():
        return []
    try:
        lines = path.read_text(encoding="utf-8").split("\n")
    except (OSError, ValueError) as error:
        raise Unreadable(f"{path}: {error}") from error
    rows = []
    for number, line in enumerate(lines, start=1):
        if not line.strip():
            continue
        try:
            rows.append(_row_of_line(line))
        except (ValueError, KeyError, TypeError) as error:
            if number == len(lines):
                break  # the last line has no end: a writer was cut off
            raise Unreadable(f"{path}:{number}: no row of a history: {error}") from error
    return rows


def _row_of_line(line: str) -> RunRow:
    said = json.loads(line)
    keys = ("outcome", "measured", "bound", "seconds")
    findings = {
        name: record(Judged, dict(zip(keys, row, strict=True)))
        for name, row in said["findings"].items()
    }
    return record(RunRow, said, about={name: str(said[name]) for name in ABOUT}, findings=findings)


def append_to_log(path: Path, rows: list[RunRow]) -> int:
    """Appends those rows that the log does not have, and says how many. Each row
    is written whole, by one call."""
    known = {row.key for row in read_log(path)}
    new = {row.key: row for row in rows if row.key not in known}
    if not new:
        return 0
    _repair_end(path)
    with open(path, "a", encoding="utf-8") as file:
        for row in new.values():
            file.write(_line_of(row) + "\n")
            file.flush()
            os.fsync(file.fileno())
    return len(new)


def _repair_end(path: Path) -> None:
    """Cuts off a last line that was not written to its end."""
    if not path.exists():
        return
    content = path.read_bytes()
    if content and not content.endswith(b"\n"):
        os.truncate(path, content.rfind(b"\n") + 1)


def _line_of(row: RunRow) -> str:
    findings = {
        name: [_written(value) for value in asdict(judged).values()]
        for name, judged in row.findings.items()
    }
    return json.dumps(
        row.about
        | {"counts": row.counts, "rulings": row.rulings, "costs": row.costs, "findings": findings},
        ensure_ascii=False,
        separators=(",", ":"),
    )


def _written(value: Any) -> Any:
    """JSON has no NaN and no infinity."""
    return None if isinstance(value, float) and not isfinite(value) else value


def in_order(rows: list[RunRow]) -> list[RunRow]:
    """Each run once, by date; runs of the same second as they were given."""
    once = {row.key: row for row in rows}
    return sorted(once.values(), key=lambda row: row.about["date"])


def changes(rows: list[RunRow]) -> list[Change]:
    """All changes of outcomes and rulings, by run, those for the worse first. A run is compared
    with the last one before it of the same tier and subject; a run that did not ask everything
    (`check`, `study`) only in what it asked."""
    found: list[Change] = []
    for before, run in _neighbours(rows):
        asked_all = is_whole(run) and is_whole(before)
        of_run: list[Change] = []
        for old, new in ((before.outcomes, run.outcomes), (before.rulings, run.rulings)):
            names = old.keys() | new.keys() if asked_all else old.keys() & new.keys()
            of_run += [
                Change(run, name, old.get(name, ""), new.get(name, ""))
                for name in sorted(names)
                if old.get(name, "") != new.get(name, "")
            ]
        found += sorted(of_run, key=lambda change: not change.is_regression)
    return found


def is_whole(row: RunRow) -> bool:
    """Whether the run asked everything of its tier."""
    return " verify" in f" {row.about['command']}"


def margin_changes(rows: list[RunRow]) -> list[MarginChange]:
    """Findings that came closer to their bound by CLOSER or more, the largest factor first."""
    found = [
        MarginChange(run, name, before.findings[name].margin, judged.margin)
        for before, run in _neighbours(rows)
        for name, judged in run.findings.items()
        if name in before.findings
    ]
    closer = [one for one in found if one.after >= CLOSER * one.before and one.after > 0.01]
    return sorted(closer, key=lambda one: -(one.after / one.before if one.before > 0 else inf))


def _neighbours(rows: list[RunRow]) -> list[tuple[RunRow, RunRow]]:
    """Each run with the one before it of the same tier and subject."""
    last: dict[tuple[str, str], RunRow] = {}
    found = []
    for row in rows:
        kind = (row.about["tier"], row.about["subject"])
        if kind in last:
            found.append((last[kind], row))
        last[kind] = row
    return found
