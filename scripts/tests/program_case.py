"""What the tests of the program share: the program, and a folder for each test."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "build" / "foldproof"
if sys.argv[1:2] == ["--program"]:  # --program FILE: instead of build/foldproof
    PROGRAM = Path(sys.argv[2])
    del sys.argv[1:3]

# a sheet that hangs from its upper edge
SHEET = """
[cloth]
shape = "sheet"
width = 0.3
height = 0.2
columns = 6
rows = 4
density = 0.2
[gravity]
[stretch]
stiffness = 40.0
damping = 0.02
[bending]
stiffness = 1e-3
[[hold]]
box = [[-1, 0.19, -1], [1, 1, 1]]
[solver]
tolerance = 1e-12
[time]
end = 0.06
frames_per_second = 50
[[quantity]]
what = "lowest"
[[quantity]]
name = "swing"
what = "kinetic_energy"
when = "maximum"
"""


def run(*arguments: str, folder: Path | None = None) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [str(PROGRAM), *arguments], cwd=folder, capture_output=True, text=True, check=False
    )


class ProgramCase(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = tempfile.TemporaryDirectory(prefix="foldproof test ")
        self.path = Path(self.folder.name)

    def tearDown(self) -> None:
        self.folder.cleanup()

    def write(self, name: str, text: str) -> str:
        (self.path / name).write_text(text)
        return str(self.path / name)

    def simulate(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        return run("simulate", *arguments, "--out", str(self.path / "out"))

    def assert_rejected(self, *arguments: str) -> str:
        """The one line on standard error of a command that is refused and leaves nothing behind."""
        before = sorted(self.path.rglob("*"))
        done = run(*arguments, folder=self.path)
        self.assertEqual(
            (done.returncode, done.stdout, done.stderr.count("\n")), (2, "", 1), (arguments, done)
        )
        self.assertEqual(sorted(self.path.rglob("*")), before, arguments)
        return done.stderr
