"""Names that findings and studies had in version 0.1.0, and those that they have now
(scripts/renames.toml)."""
from __future__ import annotations

import tomllib
from dataclasses import replace
from pathlib import Path

from data.results import Run

RENAMES = Path(__file__).resolve().parents[2] / "scripts" / "renames.toml"
BEFORE = "0.1.0"   # the last version with the old names


def current_names(version: str) -> dict[str, str]:
    """The new name of each finding that a run of this version calls otherwise."""
    if version != BEFORE:
        return {}
    return tomllib.loads(RENAMES.read_text(encoding="utf-8"))["findings"]


def with_current_names(run: Run) -> Run:
    """The run with its findings and studies called as they are today; itself if it
    was written after the renames."""
    now = current_names(str(run.provenance.get("version")))
    if not now:
        return run
    return replace(
        run,
        findings=[
            replace(one, name=now.get(one.name, one.name), study=now.get(one.study, one.study))
            for one in run.findings
        ],
        studies=[replace(one, name=now.get(one.name, one.name)) for one in run.studies],
        claims=[
            replace(one, decided_by=[(now.get(name, name), role) for name, role in one.decided_by])
            for one in run.claims
        ],
    )
