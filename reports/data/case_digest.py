"""A digest of the scene of a case: two files with the same digest simulate the same
scene, whatever their comments."""
from __future__ import annotations

import hashlib
import json
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

PROSE = ("title", "about", "ablation")  # prose keys of a case, which the digest ignores


def case_digest(name: str, read: Callable[[str], bytes]) -> str:
    """16 hexadecimal digits of the case `name` ("balloon.toml", "hard/twist.toml") and its meshes.
    `read` gives the bytes of a file of the folder cases/, and raises FileNotFoundError if there is
    none. Throws ValueError for a case with a body of `frames`, whose files it does not name."""
    said = tomllib.loads(read(name).decode("utf-8"))
    scene = {key: value for key, value in said.items() if key not in PROSE}
    for expected in scene.get("expect", {}).values():
        for prose in ("why", "despite_error"):
            expected.pop(prose, None)
    folder = name.rpartition("/")[0]
    meshes = [
        hashlib.sha256(read(f"{folder}/{file}" if folder else file)).hexdigest()
        for file in mesh_files(scene)
    ]
    return hashlib.sha256(json.dumps([scene, meshes], sort_keys=True).encode("utf-8")).hexdigest()[
        :16
    ]


def mesh_files(value: Any) -> list[str]:
    """All mesh files that a case names, in order."""
    if isinstance(value, dict):
        if "frames" in value:
            raise ValueError(
                f"the files of the folder {value['frames']} cannot be told from the case: it has no"
                " digest"
            )
        return [file for inner in value.values() for file in mesh_files(inner)]
    if isinstance(value, list):
        return [file for inner in value for file in mesh_files(inner)]
    return [value] if isinstance(value, str) and value.endswith(".obj") else []


def case_files(cases: Path) -> dict[str, str]:
    """The file name of each case, as used by case_digest. fabrics.toml and engines.toml are data;
    cantilever.toml is for `foldproof settle`, not for runs in time."""
    no_runs = {"fabrics", "engines", "cantilever"}
    return {
        file.stem: str(file.relative_to(cases))
        for file in sorted(cases.glob("**/*.toml"))
        if file.stem not in no_runs and not file.name.endswith(".campaign.toml")
    }


def has_changed(row: dict[str, Any], cases: Path) -> bool:
    """Whether the case of a row of a record in the folder `cases` is another scene by now."""
    file = case_files(cases).get(row["case"])
    return file is None or (
        case_digest(file, lambda name: (cases / name).read_bytes()) != row["digest"]
    )


def part_of_time(row: dict[str, Any]) -> str:
    """"first 1 of 3 s" where not the whole run was asked, else ""."""
    asked, end = row["asked_end"], row["end"]
    return f"first {asked:g} of {end:g} s" if asked != end else ""
