#!/usr/bin/python3
"""Simulates a case file without any code of foldproof; compares the frames with those of a run.

usage: simulate.py CASE.toml [RUN.h5]      RUN.h5: what `foldproof simulate CASE.toml` wrote
"""

import math
import sys
import tomllib
from pathlib import Path
from typing import NamedTuple

import h5py
import numpy as np

sys.dont_write_bytecode = True

from model import Model, read_case  # noqa: E402
from schemes import SCHEMES  # noqa: E402
from state import State, Unsupported  # noqa: E402


def steps_to(start: float, end: float, longest: float) -> list[float]:
    """The ends of the fewest equal steps from start to end that are not longer than `longest`."""
    count = math.ceil((end - start) / longest * (1 - 1e-12))
    return [start + (end - start) * step / count for step in range(1, count)] + [end]


def frame_times(keys: dict) -> list[float]:
    rate = keys.get("frames_per_second", 30)
    return [frame / rate for frame in range(round(keys["end"] * rate) + 1)]


class Simulation(NamedTuple):
    frames: list[State]  # the start included
    step_ends: np.ndarray  # s


def simulate(model: Model) -> Simulation:
    keys = model.case["time"]
    step = SCHEMES[keys.get("integrator", "C")]
    state, frames, ends = model.start, [model.start], []
    times = frame_times(keys)
    model.update_bonds(state)
    for target in times[1:]:
        events = sorted(time for time in model.events if state.time < time < target)
        for start, end in zip([state.time, *events], [*events, target]):
            for time in steps_to(start, end, keys["step"]):
                _, x, v = step(model, state, time - state.time)
                state = State(time, x, model.prescribed_velocity(v, time, time))
                model.update_bonds(state)
                ends.append(time)
        frames.append(state)
    return Simulation(frames, np.array(ends))


class Run(NamedTuple):
    """Of a file that `foldproof simulate` wrote. T frames, S steps, N particles."""
    x: np.ndarray  # T x N x 3 [m]
    v: np.ndarray  # T x N x 3 [m/s]
    mass: np.ndarray  # N [kg]
    step_ends: np.ndarray  # S [s]


def read_run(file: Path) -> Run:
    with h5py.File(file) as run:
        return Run(run["frames/positions"][:], run["frames/velocities"][:], run["mesh/mass"][:],
                   run["diagnostics/time"][1:])  # the first row is the start


class Agreement(NamedTuple):
    """How far two simulations of one case are apart. Infinite where
    frames or particles are not as many."""
    steps: int
    size: float  # largest extent of the cloth at the start [m]
    x: float  # largest distance of a particle's positions [m]
    travel: float  # largest difference of a particle's velocities, times the longest step [m]
    mass: float  # largest relative difference of a particle's masses
    time: float  # largest difference of the ends of steps [s]


def largest(ours: np.ndarray, theirs: np.ndarray) -> float:
    """Of lengths of differences of vectors, or of differences of
    numbers; NaN counts as infinite."""
    if ours.shape != theirs.shape:
        return math.inf
    apart = ours - theirs
    apart = np.linalg.norm(apart, axis=-1) if apart.ndim == 3 else np.abs(apart)
    return float(np.nan_to_num(apart, nan=math.inf).max())


def compare(done: Simulation, mass: np.ndarray, run: Run) -> Agreement:
    x, v = np.array([frame.x for frame in done.frames]), np.array(
        [frame.v for frame in done.frames]
    )
    longest = np.diff(done.step_ends, prepend=0.0).max()
    return Agreement(len(done.step_ends), float(np.ptp(x[0], axis=0).max()), largest(x, run.x),
                     largest(v, run.v) * longest, largest(mass / run.mass, np.ones_like(mass)),
                     largest(done.step_ends, run.step_ends))


def main(words: list[str]) -> int:
    if len(words) not in (1, 2):
        print(__doc__, file=sys.stderr)
        return 2
    try:
        model = read_case(Path(words[0]))
        run = read_run(Path(words[1])) if len(words) == 2 else None
    except (OSError, KeyError, tomllib.TOMLDecodeError, Unsupported) as error:
        print(f"{words[0]}: {error}", file=sys.stderr)
        return 2
    done = simulate(model)
    print(f"{len(done.frames)} frames, {len(done.step_ends)} steps")
    if run:
        print(compare(done, model.mass, run))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
