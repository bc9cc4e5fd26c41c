#!/usr/bin/python3
"""Tests of the adapters of other engines, of those that are installed:
`scripts/engines bullet` installs one."""
from __future__ import annotations

import json
import subprocess
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
RECORDED = "3.24"  # the version whose findings adapters/bullet/README.md records


def run(*words: str | Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=False)


class Bullet(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        built = run("scripts/engines", "--no-install", "bullet")
        if built.returncode == 3:
            print("bullet: skipped: not installed")
            raise unittest.SkipTest(built.stderr.strip())
        if built.returncode:
            raise AssertionError(built.stderr)

    def judged(self, name: str, *options: str) -> dict:
        return json.loads(
            run(
                "build/foldproof", "judge", "--solver", f"build/engines/{name}", "--json", *options
            ).stdout
        )

    def require(self, judged: dict, failing: set[str]) -> None:
        """The smoke laws hold, 60 % of the suite applies, and what fails is what was recorded."""
        outcomes = {row["name"]: row["outcome"] for row in judged["findings"]}
        smoke = {outcome for name, outcome in outcomes.items() if name.startswith("smoke.")}
        self.assertEqual(smoke, {"holds"})
        applicable = [outcome for outcome in outcomes.values() if outcome in ("holds", "fails")]
        self.assertGreaterEqual(len(applicable), 0.6 * len(outcomes))
        if run("dpkg-query", "-W", "-f", "${Version}", "libbullet-dev").stdout.startswith(
            f"{RECORDED}+"
        ):
            self.assertEqual(
                {name for name, outcome in outcomes.items() if outcome == "fails"}, failing
            )

    def test_the_adapters_keep_to_the_protocol(self) -> None:
        for name in ("bullet_deformable", "bullet_position_based"):
            done = run("build/foldproof", "subject", "--check", f"build/engines/{name}")
            self.assertEqual(done.returncode, 0, done.stdout)

    def test_deformable_bodies_meet_every_law(self) -> None:
        self.require(self.judged("bullet_deformable"), set())

    def test_explicit_deformable_bodies_remember_more_than_their_state(self) -> None:
        self.require(self.judged("bullet_deformable", "--settings", "implicit=0"),
                     {"repeat.step-depends-on-its-state-alone"})

    def test_position_based_bodies_depend_on_the_numbering(self) -> None:
        self.require(self.judged("bullet_position_based"),
                     {"inertia.free-sheet-keeps-its-velocity", "gravity.speed-grows-by-g-t",
                      "gravity.fall-is-as-exact-as-the-order-claims", "symmetry.renumbering"})

    def test_an_unknown_engine_is_refused(self) -> None:
        done = run("scripts/engines", "bulet")
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertEqual(done.stderr, "scripts/engines: unknown engine 'bulet'; known: bullet\n")


if __name__ == "__main__":
    unittest.main()
