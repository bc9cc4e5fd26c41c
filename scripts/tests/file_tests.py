"""Shared by tests of the program on files: a folder, small cases, runs under limits."""

import resource
import subprocess
import tempfile
import unittest
from pathlib import Path

import h5py

from program_case import PROGRAM, ROOT

SEED = 20030726
CLOCK = 300  # s: what takes longer hangs

LED_CASE = """
[cloth]
shape = "sheet"
pattern = "jittered"
jitter = 0.2
width = 0.3
height = 0.3
columns = 9
rows = 9
density = 0.2
[gravity]
[stretch]
stiffness = 20.0
damping = 0.03
[bending]
stiffness = 2e-5
damping = 1e-6
[[hold]]
particles = [0, 1]
amplitude = [0.02, 0.01, 0.03]
frequency = 3.1
from = 0.0505
until = 0.131
[[hold]]
top = 0.05
[time]
end = 0.4
frames_per_second = 60
step = 0.001
integrator = "BDF2"
[solver]
tolerance = 1e-8
[expect.takes_steps]
at_least = 3
why = "a trial"
[expect.never_crosses_itself]
at_most = 0
why = "a trial"
"""

SMALL_CASE = """
title = "Small <script>alert(1)</script> & 'one'"
[cloth]
shape = "sheet"
pattern = "one_diagonal"
width = 0.4
height = 0.4
columns = 10
rows = 10
density = 0.2
move = [-0.2, -0.2, 0.23]
[stretch]
stiffness = 20.0
damping = 0.03
[[object]]
shape = "sphere"
radius = 0.25
name = "<b>\\u0001ball\\" onload='x'"
[[sticky]]
surface = { of = "cloth", triangles = [0, 1] }
particles = { particles = [60, 61, 62] }
stiffness = 10
forecast_time = 0.01
near = 1.0
far = 2.0
[time]
end = 0.02
frames_per_second = 200
step = 0.001
"""

TRIANGLES = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n"


def run(*arguments: str, limits: dict[int, int] | None = None, user: int | None = None,
        stdout: int = subprocess.PIPE) -> subprocess.CompletedProcess[str]:
    """Runs the program under limits (of `resource`), or as another user; one
    that hangs raises TimeoutExpired."""
    def set_limits() -> None:
        for what, most in (limits or {}).items():
            resource.setrlimit(what, (most, most))
    as_user = {} if user is None else {"user": user, "group": user, "extra_groups": []}
    return subprocess.run(
        [str(PROGRAM), *arguments], stdout=stdout, stderr=subprocess.PIPE, text=True,
        errors="replace", timeout=CLOCK, check=False, preexec_fn=set_limits if limits else None,
        **as_user
    )


def content_of(path: Path) -> dict[str, bytes]:
    """All datasets of an HDF5 file but clock times, by name, with shape and type."""
    found: dict[str, bytes] = {}

    def see(name: str, item: h5py.Group | h5py.Dataset) -> None:
        if isinstance(item, h5py.Dataset) and name != "diagnostics/seconds":
            found[name] = repr((item.shape, item.dtype)).encode() + item[()].tobytes()
    with h5py.File(path, "r") as file:
        file.visititems(see)
        for key in ("case_name", "case_text", "integrator", "stopped"):
            found[f"@{key}"] = str(file.attrs[key]).encode()
    return found


class FileTest(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = tempfile.TemporaryDirectory(prefix="foldproof durability ")
        self.path = Path(self.folder.name)
        self.path.chmod(0o755)  # for the tests as another user

    def tearDown(self) -> None:
        self.folder.cleanup()

    def write(self, name: str, text: str) -> str:
        (self.path / name).parent.mkdir(parents=True, exist_ok=True)
        (self.path / name).write_text(text)
        return str(self.path / name)

    def simulate(
        self, case: str, *arguments: str, out: str = "out", **how: object
    ) -> subprocess.CompletedProcess[str]:
        return run("simulate", case, *arguments, "--out", str(self.path / out), **how)

    def assert_rejected(self, done: subprocess.CompletedProcess[str], *mentions: str) -> None:
        """The exit code is 2, and the last line of standard error
        is an error that mentions this."""
        self.assertEqual(done.returncode, 2, done.stderr)
        last = done.stderr.strip().splitlines()[-1] if done.stderr.strip() else ""
        self.assertNotIn("Traceback", done.stderr)
        for part in mentions:
            self.assertIn(part, last)

    def skip_and_say(self, why: str) -> None:
        print(f"\nskipped: {self.id()}: {why}", flush=True)
        self.skipTest(why)
