"""What scripts share that build programs or ask them: commands, whole files, how they end."""

import argparse
import functools
import hashlib
import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "build" / "foldproof"


class Unusable(Exception):
    """Why nothing can be said."""


def output_of(command: list, folder: Path = ROOT) -> str:
    """Output of a command; if it fails, the end of what it printed is the error."""
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, errors="replace",
                          check=False)
    if done.returncode:
        words = " ".join(map(str, command[:6]))
        raise Unusable(f"`{words}` failed:\n{(done.stdout + done.stderr)[-3000:]}")
    return done.stdout


def build(folder: Path, targets: list[str], *options: str, jobs: int | None = None) -> None:
    """Brings programs in a folder of their own up to date: a Release with these options."""
    output_of(["cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
               *options])
    output_of(["ninja", "-C", folder, "-j", str(jobs or os.cpu_count()), *targets])


def require_program() -> None:
    if not PROGRAM.is_file():
        raise Unusable("there is no build; run scripts/setup first")


@functools.cache
def listed() -> dict[str, Any]:
    """All that `foldproof list --json` says. It reads every case, so the answer is kept for as long
    as the program and the cases are the same."""
    require_program()
    digest = hashlib.sha256(PROGRAM.read_bytes())
    for case in sorted((ROOT / "cases").rglob("*.toml")):
        digest.update(case.read_bytes())
    key, stored = digest.hexdigest(), ROOT / "build/faults/listed.json"
    kept = json.loads(stored.read_text(encoding="utf-8")) if stored.is_file() else {}
    if kept.get("key") != key:
        kept = {"key": key, "listed": json.loads(output_of([PROGRAM, "list", "--json"]))}
        write_at_once(stored, json.dumps(kept))
    return kept["listed"]


def commit() -> str:
    return output_of(["git", "describe", "--always", "--dirty"]).strip()


def write_at_once(path: Path, text: str) -> None:
    """Another program that reads the file now finds the old text, or the new one."""
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f"{path.name}.{os.getpid()}.partial")
    with open(part, "w", encoding="utf-8") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
    part.replace(path)


def write_json(path: Path, content: dict[str, Any]) -> None:
    write_at_once(path, json.dumps(content, indent=1) + "\n")


def parser_of(text: str | None) -> argparse.ArgumentParser:
    """A parser of the command line whose help begins with this text as it is laid out."""
    return argparse.ArgumentParser(
        description=text, formatter_class=argparse.RawTextHelpFormatter)


def end(main: Callable[[], int], *unusable: type[Exception]) -> None:
    """Ends with the exit code of main; with 2 and the reason where nothing can be said."""
    try:
        sys.exit(main())
    except (Unusable, OSError, *unusable) as reason:
        print(f"scripts/{Path(sys.argv[0]).name}: {reason}", file=sys.stderr)
        sys.exit(2)
