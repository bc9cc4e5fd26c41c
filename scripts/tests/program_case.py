"""What the tests of the program share: the program, a folder for each test, small cases, runs under
limits or cut off."""

import json
import resource
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from collections.abc import Callable
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "build" / "foldproof"
if sys.argv[1:2] == ["--program"]:  # --program FILE: instead of build/foldproof
    PROGRAM = Path(sys.argv[2])
    del sys.argv[1:3]
CLOCK = 300  # s: what takes longer hangs

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
SPINNING_PLANE = """
[[object]]
shape = "half_space"
move = [0, 0, -1]
angular_velocity = [0, 0, 90]
"""


def run(*arguments: str | Path, folder: Path | None = None, limits: dict[int, int] | None = None,
        user: int | None = None,
        stdout: int = subprocess.PIPE) -> subprocess.CompletedProcess[str]:
    """Runs the program under limits (of `resource`), or as another user; one
    that hangs raises TimeoutExpired."""
    def set_limits() -> None:
        for what, most in (limits or {}).items():
            resource.setrlimit(what, (most, most))

    as_user = {} if user is None else {"user": user, "group": user, "extra_groups": []}
    return subprocess.run(
        [PROGRAM, *arguments], cwd=folder, stdout=stdout, stderr=subprocess.PIPE, text=True,
        errors="replace", timeout=CLOCK if limits else None, check=False,
        preexec_fn=set_limits if limits else None, **as_user)


def run_until(ready: Callable[[int], object], *arguments: str | Path, how: int = signal.SIGKILL,
              folder: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Runs the program until ready(its process), and sends it the signal."""
    end = time.monotonic() + CLOCK
    with subprocess.Popen([PROGRAM, *arguments], cwd=folder, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True) as process:
        while process.poll() is None and not ready(process.pid) and time.monotonic() < end:
            time.sleep(0.002)
        process.send_signal(how)
        printed, said = process.communicate()
    return subprocess.CompletedProcess(arguments, process.returncode, printed, said)


class ProgramCase(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory(prefix="foldproof test ")
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name)
        self.out = str(self.path / "out")

    def write(self, name: str, text: str) -> str:
        (self.path / name).parent.mkdir(parents=True, exist_ok=True)
        (self.path / name).write_text(text)
        return str(self.path / name)

    def simulate(self, *arguments: str, out: str = "out",
                 **how: Any) -> subprocess.CompletedProcess[str]:
        return run("simulate", *arguments, "--out", str(self.path / out), **how)

    def told(self, *arguments: str, codes: tuple[int, ...] = (0, 1), **how: Any) -> Any:
        """The answer of a command as JSON."""
        done = run(*arguments, "--json", **how)
        self.assertIn(done.returncode, codes, done.stderr)
        return json.loads(done.stdout)

    def page_of(self, *folders: str | Path, name: str = "report.html") -> str:
        """The page that `report` makes of folders of results, in the last of them."""
        done = run("report", *map(str, folders))
        self.assertEqual(done.returncode, 0, done.stderr)
        return (Path(folders[-1]) / name).read_text(encoding="utf-8")

    def assert_holds(self, done: subprocess.CompletedProcess[str]) -> None:
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def assert_refused(self, done: subprocess.CompletedProcess[str], *mentions: str) -> None:
        """The exit code is 2, and the last line of standard error is an error that mentions
        this."""
        self.assertEqual(done.returncode, 2, done)
        self.assertNotIn("Traceback", done.stderr)
        last = done.stderr.strip().rpartition("\n")[2]
        for part in mentions:
            self.assertIn(part, last)

    def assert_rejected(self, *arguments: str) -> str:
        """The one line on standard error of a command that is refused and leaves nothing behind."""
        before = sorted(self.path.rglob("*"))
        done = run(*arguments, folder=self.path)
        self.assert_refused(done)
        self.assertEqual((done.stdout, done.stderr.count("\n")), ("", 1), (arguments, done))
        self.assertEqual(sorted(self.path.rglob("*")), before, arguments)
        return done.stderr
