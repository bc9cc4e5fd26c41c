"""The folder of a run: what it holds, or what its case files make up where no run wrote it."""
from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

from data.fault_record import with_record
from data.results import Case, Run, case_entry_of_file, load_case, load_run
from data.unreadable import Unreadable

OF_A_CASE = ("precision.h5", "converge.h5")  # of `foldproof precision` and `foldproof converge`


def read_folder(folder: Path) -> tuple[Run, Run | None]:
    """The run (made up of the case files alone if there is no run.h5) and
    the speed measurements, if any."""
    bench = load_run(folder / "bench.h5") if (folder / "bench.h5").is_file() else None
    others = [load_run(folder / name) for name in OF_A_CASE if (folder / name).is_file()]
    studies = [study for other in others for study in other.studies]
    if (folder / "run.h5").is_file():
        run = load_run(folder / "run.h5")
        return replace(run, studies=run.studies + studies, faults=with_record(run.faults)), bench
    entries = [
        case_entry_of_file(path)
        for path in sorted(folder.glob("*.h5"))
        if path.name not in ("bench.h5", *OF_A_CASE)
    ]
    cases = [entry for entry in entries if entry is not None]
    if not cases and bench is None and not others:
        if not folder.exists():
            raise FileNotFoundError(f"{folder}: there is no such folder")
        raise FileNotFoundError(
            f"{folder}: no run.h5, no bench.h5 and no case file; run `foldproof verify` "
            "or `foldproof simulate` with --out first"
        )
    simulations = [one for case in cases if (one := load_if_readable(case.path))]
    alone = bench or (others[0] if others else None)
    provenance = (
        common_to([one.about_run for one in simulations])
        if simulations
        else alone.provenance
        if alone
        else {}
    )
    findings = [finding for one in simulations for finding in one.findings]
    return (
        Run(provenance=provenance, findings=findings, studies=studies, cases=cases, faults=[]),
        bench,
    )


def load_if_readable(path: Path) -> Case | None:
    """One simulation; None for a damaged file; the page says so."""
    try:
        return load_case(path)
    except Unreadable:
        return None


def common_to(provenances: list[dict[str, Any]]) -> dict[str, Any]:
    """The value that all of them share."""
    first, *others = provenances
    return {
        key: said
        for key, said in first.items()
        if all(str(other.get(key)) == str(said) for other in others)
    }
