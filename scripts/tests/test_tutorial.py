#!/usr/bin/python3
"""Runs the commands of reports/TUTORIAL.md from top to bottom, and
compares their output with the page.

Usage: scripts/tests/test_tutorial.py [--update]
--update prints the output of each command instead of comparing it
Exit code: 0 if all outputs match; 1 otherwise.
"""

import doctest
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
TUTORIAL = ROOT / "reports" / "TUTORIAL.md"
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
# a line now and then, where a command takes long
PROGRESS = re.compile(r".*: \d+ %(, .* left at this pace)?")


class Command(NamedTuple):
    line: int  # of the tutorial
    text: str
    expected: str  # its output, and its exit code in brackets if that is not 0


def commands_of(block: str, line: int) -> list[Command]:
    """Lines that begin with "$ ", each with the lines up to the next."""
    found: list[Command] = []
    for offset, row in enumerate(block.splitlines()):
        if row.startswith("$ "):
            found.append(Command(line + offset, row[2:], ""))
        else:
            found[-1] = found[-1]._replace(expected=found[-1].expected + row + "\n")
    return found


def answer(command: str, folder: Path) -> str:
    """Its output without progress lines, and its exit code if not 0."""
    done = subprocess.run(["bash", "-c", command], cwd=folder, capture_output=True, text=True,
                          check=False)
    lines = [row.rstrip() for row in (done.stderr + done.stdout).splitlines()
             if not PROGRESS.fullmatch(row)]
    if done.returncode:
        lines.append(f"[{done.returncode}]")
    return "".join(row + "\n" for row in lines)


def main() -> int:
    text = TUTORIAL.read_text(encoding="utf-8")
    wrong = ran = 0
    with tempfile.TemporaryDirectory(prefix="foldproof tutorial ") as name:
        folder = Path(name)
        for tree in ("build", "cases", "reports", "verification"):
            (folder / tree).symlink_to(ROOT / tree)
        for block in BLOCK.finditer(text):
            kind, content = block.groups()
            if kind in ("toml", "python"):  # its first line is a comment that names the file
                file = folder / content.splitlines()[0].removeprefix("# ")
                file.write_text(content, encoding="utf-8")
            if kind != "console":
                continue
            for command in commands_of(content, text.count("\n", 0, block.start()) + 2):
                ran += 1
                wrong += not is_as_it_stands(command, answer(command.text, folder))
    print(f"{ran} commands, {wrong} of them print something else")
    return 1 if wrong or not ran else 0


def is_as_it_stands(command: Command, said: str) -> bool:
    if "--update" in sys.argv:
        print(f"$ {command.text}\n{said}", end="")
        return True
    if doctest.OutputChecker().check_output(command.expected, said, doctest.ELLIPSIS):
        return True
    print(f"{TUTORIAL.name}:{command.line}: $ {command.text}\n--- stands there\n{command.expected}"
          f"--- is printed\n{said}---")
    return False


if __name__ == "__main__":
    sys.exit(main())
