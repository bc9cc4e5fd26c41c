#!/usr/bin/python3
"""Tests of the adapters of other engines, of those that are installed:
`scripts/engines bullet jolt blender calculix` installs them."""
from __future__ import annotations

import json
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import h5py

ROOT = Path(__file__).resolve().parents[2]
RECORDED = "3.24"  # the version whose findings adapters/bullet/README.md records
MODULUS = "calibration.young-s-modulus-is-the-scene-s"
MODULI = {MODULUS, "calibration.modulus-survives-refinement"}
ADAPTERS = ROOT / "verification/subjects/adapters"
JOLT = "exec node build/engines/jolt/jolt.mjs"
BLENDER = f"exec blender -b --factory-startup --python {ADAPTERS}/blender/cloth.py"
SMOKE = {"smoke.sheet-at-rest-stays", "smoke.free-fall-within-5-percent"}


def run(*words: str | Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=False)


def require_engine(*words: str) -> None:
    """Builds the engine's adapters; skips the tests where it is not installed."""
    built = run("scripts/engines", "--no-install", *words)
    if built.returncode == 3:
        print(f"{' '.join(words)}: skipped: not installed")
        raise unittest.SkipTest(built.stderr.strip())
    if built.returncode:
        raise AssertionError(built.stderr)


def judge(command: str, *options: str) -> dict[str, str]:
    """The outcome of each law."""
    done = run("build/foldproof", "judge", "--solver", command, "--json", *options)
    return {row["name"]: row["outcome"] for row in json.loads(done.stdout)["findings"]}


def those(outcomes: dict[str, str], wanted: str) -> set[str]:
    return {name for name, outcome in outcomes.items() if outcome == wanted}


class Engine(unittest.TestCase):
    """An engine of which a page records by command and setting which laws fail."""

    engine, version = (), ""  # words for scripts/engines; the version that it pins
    recorded: dict[tuple[str, str], set[str]] = {}

    @classmethod
    def setUpClass(cls) -> None:
        require_engine(*cls.engine)

    def is_recorded_version(self) -> bool:
        return True

    def test_the_adapters_keep_to_the_protocol(self) -> None:
        for command in {command for command, _ in self.recorded}:
            done = run("build/foldproof", "subject", "--check", command)
            self.assertEqual(done.returncode, 0, done.stdout)
            self.assertIn(f" {self.version}: " if self.version else "", done.stdout)

    def test_they_meet_the_laws_but_those_that_their_page_records(self) -> None:
        for (command, setting), failing in self.recorded.items():
            # laws that are newer than the record are not asked
            outcomes = judge(command, "smoke", "rest.no-force", *sorted(failing),
                             *(["--settings", setting] if setting else []))
            self.assertLessEqual(SMOKE, those(outcomes, "holds"))
            if self.is_recorded_version():
                self.assertEqual(those(outcomes, "fails"), failing, (command, setting))


class Bullet(Engine):
    engine = ("bullet", )
    DEFORMABLE = MODULI | {"capstan.slips-at-euler-s-ratio"}
    recorded = {
        ("build/engines/bullet_deformable", "implicit=1"): DEFORMABLE,
        ("build/engines/bullet_deformable", "implicit=0"): DEFORMABLE,
        ("build/engines/bullet_position_based", ""): DEFORMABLE | {
            "inertia.free-sheet-keeps-its-velocity", "gravity.speed-grows-by-g-t",
            "gravity.fall-is-as-exact-as-the-order-claims", "symmetry.renumbering",
            "momentum.angular-drift-falls-with-the-step", "order.halved-steps-approach-a-limit",
            "game-step.static-stretch-is-that-of-short-steps", "vibration.undamped-goes-on",
            "contact.slides-as-coulomb-says", "contact.slips-at-coulomb-s-slope",
            "ball.slides-as-coulomb-says"
        },
    }

    def is_recorded_version(self) -> bool:
        installed = run("dpkg-query", "-W", "-f", "${Version}", "libbullet-dev").stdout
        return installed.startswith(f"{RECORDED}+")

    def lines_without_the_adapter(self, *words: str) -> list[str]:
        """What a program of Bullet alone prints, below its heading."""
        program = ROOT / "build" / "engines" / "bullet_laws"
        libraries = ("BulletSoftBody", "BulletDynamics", "BulletCollision", "LinearMath")
        built = run(
            "g++", "-std=c++17", "-w", "-DBT_USE_DOUBLE_PRECISION", "-isystem",
            "/usr/include/bullet", ADAPTERS / "bullet/reproductions/laws.cpp", "-o",
            program, *(f"-l{name}-float64" for name in libraries)
        )
        self.assertEqual(built.returncode, 0, built.stderr)
        return run(program, *words).stdout.splitlines()[1:]

    def test_what_its_page_records_is_seen_without_the_adapter(self) -> None:
        lines = self.lines_without_the_adapter()
        numbers, speed, drift, twice = (float(line.rsplit(" by ")[1].split()[0]) for line in lines)
        self.assertGreater(numbers, 1e-6)  # m
        self.assertAlmostEqual(speed, 4.75e-8, delta=1e-9)  # g t
        self.assertGreater(drift, 1e-15)  # of the velocity
        self.assertEqual(twice, 0)

    def test_its_friction_takes_a_share_of_the_speed_without_the_adapter(self) -> None:
        rows = [line.split() for line in self.lines_without_the_adapter("friction")[1:]]
        self.assertEqual(len(rows), 28)
        for row in rows:
            _, mu, over, coulomb, way, _ = map(float, row)
            share = 2 * (1 - mu) / mu / 200 if over > 0.6 else 0  # the same for all slopes
            self.assertAlmostEqual(way, share, delta=0.03 * share + 1e-4)
            if over > 1:
                self.assertLess(way, coulomb / 2)


PAGE = ROOT / "verification/subjects/ENGINES.md"


def row_of_page(name: str) -> list[str]:
    """The cells of the first row of that name, of the page that compares engines."""
    for line in PAGE.read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if cells[0] == name:
            return cells[1:]
    raise AssertionError(f"{PAGE.name} has no row '{name}'")


class Page(unittest.TestCase):
    """Numbers of ENGINES.md, asked once more."""

    def compare_rigidities(self, name: str, *solver: str) -> None:
        least, largest, change = (float(cell.rstrip(" %")) for cell in row_of_page(name))
        law = "calibration.rigidity-survives-refinement"
        done = run("build/foldproof", "judge", law, "--json", "--solver", *solver)
        finding = json.loads(done.stdout)["findings"][0]
        self.assertAlmostEqual(100 * finding["measured"] / change, 1, delta=0.15)
        self.assertLess(least, largest)

    def test_bullet(self) -> None:
        require_engine("bullet")
        command, explicit = "build/engines/bullet_deformable", ("--settings", "implicit=0")
        self.compare_rigidities("Bullet deformable, `bending=1`", command, *explicit, "--settings",
                                "bending=1")

    def test_jolt(self) -> None:
        require_engine("jolt")
        self.compare_rigidities("Jolt, `iterations=1`", JOLT, "--settings", "iterations=1")

    def test_blender(self) -> None:
        require_engine("blender")
        self.compare_rigidities("Blender, `weigh=1`", BLENDER, "--settings", "weigh=1")

    def test_the_reference(self) -> None:
        self.compare_rigidities("reference", "build/foldproof serve")


class Jolt(Engine):
    engine, version = ("jolt", ), "1.1.0"
    recorded = {
        (JOLT, ""): {"contact.slips-at-coulomb-s-slope", "ball.slides-as-coulomb-says",
                     "capstan.slips-at-euler-s-ratio"},
        (JOLT, "iterations=1"): {"game-step.static-stretch-is-that-of-short-steps",
                                 "floor.pressed-strip-slips-as-the-elastica"},
    }


del Engine  # only the engines are run


class Blender(unittest.TestCase):
    """Opt-in: 624 MB. A trial of all laws takes two minutes, so some are asked."""

    ADAPTER = ADAPTERS / "blender"

    @classmethod
    def setUpClass(cls) -> None:
        require_engine("blender")

    def test_the_adapter_keeps_to_the_protocol(self) -> None:
        done = run("build/foldproof", "subject", "--check", BLENDER)
        self.assertEqual(done.returncode, 0, done.stdout)

    def test_laws_end_as_its_page_records(self) -> None:
        others = {"momentum.linear-is-conserved", "calibration.bending-rigidity-is-the-scene-s",
                  "calibration.rigidity-survives-refinement"}
        asked = ("smoke", "rest", "gravity", "calibration", "momentum", "held", "order",
                 "contact.resting-sheet-is-still", "contact.slides-as-coulomb-says")
        outcomes = judge(BLENDER, *asked)
        self.assertLessEqual(SMOKE, those(outcomes, "holds"))
        self.assertEqual(those(outcomes, "fails"), MODULI | others)
        self.assertEqual(outcomes["contact.slides-as-coulomb-says"], "not applicable")
        rings = "strip.rings-take-the-elastica-s-shape"
        weighed = judge(BLENDER, rings, "--settings", "weigh=1")
        self.assertEqual(weighed, {rings: "holds"})

    def lines_without_the_adapter(self, name: str) -> list[list[str]]:
        script = self.ADAPTER / "reproductions" / f"{name}.py"
        ran = run("blender", "-b", "--factory-startup", "--python", script)
        return [line.split() for line in ran.stdout.splitlines()]

    def test_its_settings_mean_what_its_page_records(self) -> None:
        lines = self.lines_without_the_adapter("moduli")
        page = (self.ADAPTER / "FINDINGS.md").read_text(encoding="utf-8")
        stretched = [line for line in lines if line[:1] == ["stretched"]]
        self.assertEqual(len(stretched), 4)
        for _, cells, force, edge in stretched:
            self.assertIn(f"| {cells} | {edge} | {force} |", page)
        torques = [line for line in lines if line[:1] == ["torque"]]
        self.assertEqual(len(torques), 3)
        for _, share, torque in torques:
            self.assertIn(f"| {share} | {torque} |", page)
        for _, edge, force in (line for line in lines if line[:1] == ["bent"]):
            self.assertAlmostEqual(float(force), 100 / 3 * 50 * float(edge), delta=0.2)
        vertices, areas = next(line[1:] for line in lines if line[:1] == ["way"])
        self.assertLess(float(vertices), 1e-6)
        self.assertGreater(float(areas), 0.03)

    def test_a_frame_has_the_steps_that_its_page_records(self) -> None:
        lines = self.lines_without_the_adapter("steps")
        steps = {int(line[1]): float(line[2]) for line in lines if line[:1] == ["quality"]}
        self.assertEqual(len(steps), 9)
        for quality, count in steps.items():
            self.assertAlmostEqual(count, quality + (quality in (12, 40, 80)), delta=0.01)
        falls = [line[2] for line in lines if line[:1] == ["rate"]]
        self.assertEqual(falls, ["0.010000", "0.010000"])


class Template(unittest.TestCase):
    def test_adapters_are_as_short_as_the_page_says(self) -> None:
        folder = ROOT / "verification/subjects"
        text = " ".join((folder / "PROTOCOL.md").read_text(encoding="utf-8").split())
        self.assertIn("takes under sixty lines in [Python]", text)
        self.assertIn("about a hundred in [C++]", text)
        for name, least, most in (("py", 40, 59), ("mjs", 40, 59), ("cpp", 90, 110)):
            lines = (folder / f"adapters/toy_solver.{name}").read_text().count("\n")
            self.assertTrue(least <= lines <= most, (name, lines))

    def test_the_javascript_toy_meets_every_law(self) -> None:
        if not shutil.which("node"):
            print("JavaScript: skipped: not installed")
            self.skipTest("node is not installed")
        command = "exec node verification/subjects/adapters/toy_solver.mjs"
        done = run("build/foldproof", "subject", "--check", command)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertEqual(set(judge(command).values()), {"holds", "not applicable"})


class Script(unittest.TestCase):
    def test_an_unknown_engine_is_refused(self) -> None:
        done = run("scripts/engines", "bulet")
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("unknown engine 'bulet'; known: bullet, jolt,", done.stderr)


class Calculix(unittest.TestCase):
    """Statics by a program of others, beside our oracles."""

    @classmethod
    def setUpClass(cls) -> None:
        require_engine("calculix")

    def static(self, what: str, value: float) -> dict[str, float]:
        script = ROOT / "verification/subjects/adapters/calculix/static.py"
        ran = run("/usr/bin/python3", script, what, str(value))
        self.assertEqual(ran.returncode, 0, ran.stderr)
        return json.loads(ran.stdout)

    def should_be(self, study: str, finding: str) -> list[float]:
        """What an oracle says of a finding."""
        with tempfile.TemporaryDirectory() as folder:
            run("build/foldproof", "study", study, "--out", folder)
            with h5py.File(Path(folder) / "run.h5") as file:
                return list(file[f"findings/{study}.{finding}/evidence"]["should be D"][:])

    def test_the_heavy_cantilever_is_the_elastica_s(self) -> None:
        told = self.static("cantilever", 10)
        height, reach = self.should_be("heavy-cantilever", "tip-agrees.gamma-10")
        # the strip is 0.003 thick, so that it stretches by gamma 0.003^2/12 at the clamp: 8e-6
        self.assertAlmostEqual(told["height"], height, delta=1e-4)
        self.assertAlmostEqual(told["reach"], reach, delta=1e-4)

    def test_a_clamped_sheet_is_compressed_as_the_oracle_says(self) -> None:
        # on a mesh that is 2.00 widths long
        most = self.should_be("stretched-wrinkles", "clamps-compress-as-in-a-continuum")[0]
        # the elements' error is 2e-5, and a length that is off by 0.002 changes as little
        told = self.static("clamped", 2)
        self.assertAlmostEqual(told["most_compression"], -most, delta=5e-5)


if __name__ == "__main__":
    unittest.main()
