"""Why an engine's laws fail, as far as the project knows: causes.toml beside each adapter, and the
scripts that show a fault by the engine alone."""
from __future__ import annotations

import itertools
import tomllib
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from data.bundle import Bundle

ADAPTERS = Path(__file__).resolve().parents[2] / "verification/subjects/adapters"


@dataclass(frozen=True)
class Reproduction:
    """A script that uses the engine alone."""
    name: str
    page: str       # its file on the site
    source: str


@dataclass(frozen=True)
class Cause:
    """Why a law fails."""
    words: str
    reproductions: list[Reproduction]


@cache
def _known(folder: Path) -> dict[str, Any]:
    file = folder / "causes.toml"
    return tomllib.loads(file.read_text()) if file.is_file() else {}


def _folder_of(bundle: Bundle) -> Path | None:
    """Of the adapter in this project; None for another's."""
    stem = Path(bundle.adapter["file"]).stem
    return next((file.parent for file in sorted(ADAPTERS.glob("*/*.*")) if file.stem == stem), None)


def causes_of(bundle: Bundle) -> dict[str, Cause]:
    """By the law that fails; of versions that were looked into."""
    folder = _folder_of(bundle)
    known = _known(folder) if folder else {}
    settings = " ".join([bundle.arguments or Path(bundle.adapter["file"]).stem,
                         *(f"{k}={v}" for k, v in sorted(bundle.about["settings"].items()) if v)])
    return {
        law: _cause_of(folder, cause)
        for cause in known.get("cause", []) if settings in cause["settings"]
        and bundle.about["version"] in cause.get("versions", known.get("versions", []))
        for law in cause["laws"] if bundle.laws.get(law, [""])[0] == "fails"
    }


def _cause_of(folder: Path, said: dict[str, Any]) -> Cause:
    """What `by` says, a script's name as the link that stands behind the words."""
    parts = said.get("by", "").split("; ") if "by" in said else []
    scripts = {part: _reproductions(folder, part) for part in parts}
    words = [said["cause"], *(part for part in parts if not scripts[part])]
    found = list(itertools.chain(*scripts.values()))
    return Cause(", ".join([*words, "shown by"] if found else words), found)


def _reproductions(folder: Path, words: str) -> list[Reproduction]:
    """Those whose file the words name."""
    files = sorted((folder / "reproductions").glob("*.*"))
    return [Reproduction(f"{folder.name}/{file.name}",
                         f"reproduction-{folder.name}-{file.name}.html", file.read_text())
            for file in files if file.name in words]
