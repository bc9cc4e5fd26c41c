"""A bundle from the folder that `judge --out` wrote, with a run of the reference as yardstick."""
from __future__ import annotations

import hashlib
import json
import os
import re
import shlex
import subprocess
import tempfile
from pathlib import Path
from typing import Any

from data.bundle import LONGEST, SPREAD, Row, Tables, text_of
from data.unreadable import Unreadable

DECLARED = ("level", "precision", "scheme", "order", "capabilities", "solve_tolerance",
            "mass_matrix", "substep", "deterministic", "contact_offset")
PROGRAM = ("version", "commit", "tree", "compiler", "flags")
MOST_SOURCE = 200_000  # bytes of an adapter that are kept


def bundle_text(folder: Path, program: str) -> str:
    """Judges the reference by the same law set, which takes about 20 s."""
    facts = json.loads((folder / "solver.json").read_text())
    with tempfile.TemporaryDirectory(prefix="foldproof yardstick ") as scratch:
        subprocess.run(
            [program, "judge", "--solver", f"exec {shlex.quote(program)} serve", "--laws",
             facts["laws"]["set"], "--out", f"{scratch}/out"], check=False,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        yardstick = rows_of(Path(scratch) / "out")
        its_facts = json.loads((Path(scratch) / "out/solver.json").read_text())
    if facts["laws"]["changed"] or facts["laws"]["gone"]:
        raise Unreadable(f"{folder}: laws changed since {facts['laws']['set']} was frozen: "
                         "this program cannot make a bundle of it")
    return text_of({"about": about(folder, facts), "adapter": adapter_of(facts["command"]),
                    "laws": rows_of(folder), "yardstick": yardstick,
                    "evidence": {"laws": tables_of(facts["calibration"] + facts["cost"]),
                                 "yardstick": tables_of(its_facts["cost"])}})


def rows_of(folder: Path) -> dict[str, Row]:
    found = json.loads((folder / "verdicts.json").read_text())["findings"]
    return {
        one["name"]: [one["outcome"], one["measured"], one["bound"], one["unit"],
                      round(one["seconds"], 4), "" if one["outcome"] == "holds" else
                      without_folders(one["note"])[:LONGEST - len(one["unit"])]]
        for one in found
    }


def without_folders(note: str) -> str:
    """A Python adapter's last words name files of its machine: their names alone."""
    return re.sub(r'File "[^"]*/([^"/]+)"', r'File "\1"', note)


def tables_of(evidence: list[dict[str, Any]]) -> Tables:
    return {
        table["law"]: [[one["name"], one["unit"], [cell if cell is None or isinstance(cell, str)
                                                   else float(f"{cell:.5g}")
                                                   for cell in one["values"]]]
                       for one in table["columns"]]
        for table in evidence
    }


def about(folder: Path, facts: dict[str, Any]) -> dict[str, Any]:
    program = json.loads((folder / "verdicts.json").read_text())["program"]
    return {
        "engine": program["subject"], "version": facts["version"] or "0",
        "settings": facts["settings"], "options": facts["options"],
        "declared": {name: facts[name] for name in DECLARED},
        "mapping": {key: value[:LONGEST] for key, value in facts["mapping"].items()},
        "command": facts["command"][:LONGEST],
        "machine": {"cpu": program["cpu"], "cores": os.cpu_count(),
                    "load at the end": round(os.getloadavg()[0], 1)},
        "program": {name: program[name] for name in PROGRAM},
        "law_set": facts["laws"]["set"], "seed": program["seed"], "spread": SPREAD,
        "date": program["date"]
    }


def adapter_of(command: str) -> dict[str, str]:
    """The last file that the command names, with its source if it is text."""
    files = [Path(word) for word in shlex.split(command) if Path(word).is_file()]
    if not files:
        return {"file": "unknown", "sha256": "", "source": ""}
    data = files[-1].read_bytes()
    digest = hashlib.sha256(data).hexdigest()
    try:
        source = data.decode() if len(data) <= MOST_SOURCE else ""
    except UnicodeDecodeError:
        source = ""
    return {"file": files[-1].name, "sha256": digest, "source": source}
