"""Shared by tests of the program on files: small cases that are written, and what a run stores."""

from pathlib import Path

import h5py

from program_case import ProgramCase

SEED = 20030726

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


class FileTest(ProgramCase):
    def setUp(self) -> None:
        super().setUp()
        self.path.chmod(0o755)  # for the tests as another user

    def skip_and_say(self, why: str) -> None:
        print(f"\nskipped: {self.id()}: {why}", flush=True)
        self.skipTest(why)
