#!/usr/bin/python3
"""The list of laws in verification/subjects/LAWS.md: the laws of the program, in its order, with
what each needs.

Usage: scripts/tests/test_laws_page.py [--needs]     --needs prints the rows, without seconds
"""
from __future__ import annotations

import json
import re
import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SUBJECTS = ROOT / "verification" / "subjects"
ROW = re.compile(r"^\| `([\w.-]+)` \| (.*) \| (\S+) \|$", re.M)
PLAIN = {"L1": "L1", "L2": "L2", "bending": "bending", "order": "a claimed order",
         "f8": "double precision"}  # words of the program that are no capability


def needs_of_laws() -> dict[str, str]:
    """What each law needs, in the program's order, as the page says it."""
    program = [str(ROOT / "build" / "foldproof"), "list", "--json"]
    listed = json.loads(subprocess.run(program, capture_output=True, check=True).stdout)
    return {
        law["name"]: ", ".join(PLAIN.get(word, f"`{word}`") for word in law["needs"].split())
        or "nothing"
        for law in listed["laws"]
    }


class LawsPage(unittest.TestCase):
    def test_the_page_lists_the_laws_and_what_each_needs(self) -> None:
        text = (SUBJECTS / "LAWS.md").read_text(encoding="utf-8")
        rows = ROW.findall(text)
        self.assertEqual([(law, more) for law, more, _ in rows], list(needs_of_laws().items()))
        for law, _, seconds in rows:
            self.assertRegex(seconds, r"^(<0\.1|0\.[1-9]|[1-9]\d?)$", law)

    def test_adapters_are_as_short_as_the_page_says(self) -> None:
        text = " ".join((SUBJECTS / "PROTOCOL.md").read_text(encoding="utf-8").split())
        self.assertIn("takes under sixty lines in [Python]", text)
        self.assertIn("about a hundred in [C++]", text)
        for name, least, most in (("py", 40, 59), ("mjs", 40, 59), ("cpp", 90, 110)):
            lines = (SUBJECTS / f"adapters/toy_solver.{name}").read_text().count("\n")
            self.assertTrue(least <= lines <= most, (name, lines))


if __name__ == "__main__":
    if sys.argv[1:] == ["--needs"]:
        print("\n".join(f"| `{law}` | {more} | ? |" for law, more in needs_of_laws().items()))
    else:
        unittest.main()
