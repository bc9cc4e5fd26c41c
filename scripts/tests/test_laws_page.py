#!/usr/bin/python3
"""The list of laws in verification/subjects/LAWS.md: the laws of the program, in its order, with
what each needs. What a law needs is asked of the program: a solver that declines every scene is
given one capability after the other, until the law asks it for a scene.

Usage: scripts/tests/test_laws_page.py [--needs]     --needs prints the rows, without seconds
"""
from __future__ import annotations

import json
import re
import shlex
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "build" / "foldproof"
SUBJECTS = ROOT / "verification" / "subjects"
ROW = re.compile(r"^\| `([\w.-]+)` \| (.*) \| (\S+) \|$", re.M)
DECLINES = """
import sys
sys.path.insert(0, sys.argv[1])
sys.dont_write_bytecode = True
from foldproof_solver import Declined, Solver, serve

class Declines(Solver):
    name, version, scheme, level = "declines", "1", "none", "L0"
    precision = "f8" if "double precision" in sys.argv else "f4"
    order = int("a claimed order" in sys.argv)
    capabilities = tuple(word[1:-1] for word in sys.argv if word.startswith("`"))

    def prepare(self, scene):
        bends = scene.header["scene"]["material"]["bending_rigidity"] > 0
        raise Declined("bending" if bends else "scenes")

for word in sys.argv:
    Declines.level = word if word in ("L1", "L2") else Declines.level
serve(Declines())
"""


def needed(note: str) -> str:
    """What a law misses, as the page says it; "" if it goes on to ask for a scene."""
    missing = note.removeprefix("the subject does not offer ")
    missing = re.sub(r"^level (L\d) .*", r"\1", missing)
    missing = re.sub(r"^capability '(\w+)'$", r"`\1`", missing)
    return "" if missing == "scenes" else missing


def notes_of(adapter: Path, offered: tuple[str, ...], laws: list[str]) -> dict[str, str]:
    """The notes of these laws on a solver that offers so much."""
    words = ["/usr/bin/python3", str(adapter), str(SUBJECTS / "adapters"), *offered]
    command = f"exec {shlex.join(words)}"
    done = subprocess.run([str(PROGRAM), "judge", "--json", "--solver", command, *laws],
                          capture_output=True, text=True, check=False)
    rows = json.loads(done.stdout)["findings"]
    judged = [row["name"] for row in rows if row["outcome"] != "not applicable"]
    if judged:
        raise ValueError(f"a verdict without any scene: {', '.join(judged)}")
    return {row["name"]: row["note"] for row in rows}


def needs_of_laws() -> dict[str, str]:
    """What each law needs, in the program's order."""
    listed = subprocess.run([str(PROGRAM), "list", "--json"], capture_output=True, check=True)
    needs: dict[str, tuple[str, ...]] = {
        law["name"]: () for law in json.loads(listed.stdout)["laws"]
    }
    asked = list(needs)
    with tempfile.TemporaryDirectory() as folder:
        adapter = Path(folder) / "declines.py"
        adapter.write_text(DECLINES, encoding="utf-8")
        while asked:
            offered = needs[asked[0]]
            alike = [law for law in asked if needs[law] == offered]
            asked = [law for law in asked if law not in alike]
            for law, note in notes_of(adapter, offered, alike).items():
                if more := needed(note):
                    needs[law] += (more,)
                    asked += [] if more == "bending" else [law]
    return {law: ", ".join(more) or "nothing" for law, more in needs.items()}


class LawsPage(unittest.TestCase):
    def test_the_page_lists_the_laws_and_what_each_needs(self) -> None:
        text = (SUBJECTS / "LAWS.md").read_text(encoding="utf-8")
        rows, needs = ROW.findall(text), needs_of_laws()
        self.assertEqual([(law, more) for law, more, _ in rows], list(needs.items()))
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
