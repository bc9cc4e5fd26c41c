#!/usr/bin/python3
"""Bundles of judged solvers, and the pages on which they stand.

    reports/make_results.py bundle FOLDER FILE PROGRAM      writes a bundle of what judge wrote
    reports/make_results.py add FILE... --in FOLDER         checks bundles, and keeps copies
    reports/make_results.py site DIR --in FOLDER            writes the pages of all in the folder
"""
from __future__ import annotations

import argparse
import hashlib
import sys
from pathlib import Path

sys.dont_write_bytecode = True

from data.bundle import Refused, check_submission, read_bundle  # noqa: E402
from data.command_line import OneLineParser, refuse, require_modules  # noqa: E402
from data.make_bundle import bundle_text  # noqa: E402
from data.unreadable import Unreadable, one_line  # noqa: E402
from data.whole_file import write_whole  # noqa: E402


SHIPPED = Path(__file__).resolve().parent / "standing"


def main() -> int:
    """Returns 0; refuses with exit code 2."""
    parser = OneLineParser(description="Bundles of judged solvers, and their pages.")
    parser.add_argument("action", choices=("bundle", "add", "site"))
    parser.add_argument("paths", nargs="+")
    parser.add_argument("--in", dest="folder", type=Path, default=SHIPPED)
    said = parser.parse_args()
    try:
        {"bundle": make, "add": add, "site": site}[said.action](said)
    except (Refused, Unreadable) as error:
        refuse("results", str(error))
    except (OSError, KeyError, ValueError) as error:
        refuse("results", one_line(error))
    return 0


def make(said: argparse.Namespace) -> None:
    folder, file, program = said.paths
    write_whole(Path(file), bundle_text(Path(folder), program).encode())
    read_bundle(Path(file))
    print(file)


def add(said: argparse.Namespace) -> None:
    """All are checked before one is kept; a kept file is named by its content."""
    checked = [(Path(path), check_submission(Path(path))) for path in said.paths]
    said.folder.mkdir(parents=True, exist_ok=True)
    for path, bundle in checked:
        data = path.read_bytes()
        kept = said.folder / f"submitted-{hashlib.sha256(data).hexdigest()[:16]}.json"
        write_whole(kept, data)
        print(f"{kept}: {bundle.about['engine']} {bundle.about['version']}, submitted")


def site(said: argparse.Namespace) -> None:
    require_modules("results", "numpy", "h5py", "matplotlib", "jinja2")
    from standing.site import write_site

    files = sorted(said.folder.glob("*.json"))
    if not files:
        raise Unreadable(f"{said.folder}: there is no bundle in it")
    print(write_site([read_bundle(file) for file in files], Path(said.paths[0])))


if __name__ == "__main__":
    sys.exit(main())
