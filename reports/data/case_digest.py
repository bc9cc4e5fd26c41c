"""One number for what a case simulates: two files with the same number are the same scene, whatever they say of it."""
from __future__ import annotations

import hashlib
import json
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

PROSE = ("title", "about", "ablation")  # of a case: what it says of itself, and what it says of its parts


def case_digest(name: str, read: Callable[[str], bytes]) -> str:
    """16 hexadecimal digits of the case `name` ("balloon.toml", "hard/twist.toml"), its meshes with it. `read` gives
    the bytes of a file of the folder cases/, and raises FileNotFoundError if there is none. Throws ValueError for a case
    with a body of `frames`, whose files it does not name."""
    said = tomllib.loads(read(name).decode("utf-8"))
    scene = {key: value for key, value in said.items() if key not in PROSE}
    for expected in scene.get("expect", {}).values():
        expected.pop("why", None)
    folder = name.rpartition("/")[0]
    meshes = [hashlib.sha256(read(f"{folder}/{file}" if folder else file)).hexdigest() for file in mesh_files(scene)]
    return hashlib.sha256(json.dumps([scene, meshes], sort_keys=True).encode("utf-8")).hexdigest()[:16]


def mesh_files(value: Any) -> list[str]:
    """All files of meshes that a case names, in its order."""
    if isinstance(value, dict):
        if "frames" in value:
            raise ValueError(f"the files of the folder {value['frames']} cannot be told from the case: it has no digest")
        return [file for inner in value.values() for file in mesh_files(inner)]
    if isinstance(value, list):
        return [file for inner in value for file in mesh_files(inner)]
    return [value] if isinstance(value, str) and value.endswith(".obj") else []


def case_files(cases: Path) -> dict[str, str]:
    """Of each case, the name of its file, as case_digest takes it."""
    return {file.stem: str(file.relative_to(cases)) for file in sorted(cases.glob("**/*.toml"))}
