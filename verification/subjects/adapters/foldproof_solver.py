"""The solver's side of the protocol (PROTOCOL.md): derive from Solver,
then call serve(). Needs numpy.

    class Mine(Solver):
        name, version, level, precision = "mine", "1.0", "L1", "f8"
        scheme, order = "symplectic Euler", 1
        capabilities = ("set_state", "held", "masses")
        def prepare(self, scene): ...          # keeps what it needs; returns the mapping in words
        def advance(self, dt, steps): ...      # moves self.x and self.v, both (N, 3)
    serve(Mine())
"""
from __future__ import annotations

import json
import os
import sys
import time
import traceback
from typing import Any, BinaryIO, Callable

import numpy as np

PROTOCOL = 2
SECONDS_BETWEEN_PROGRESS = 1.0
TYPES = {"f8": "<f8", "f4": "<f4", "i4": "<i4"}


class Declined(Exception):
    """Raised for what the solver does not offer; the message is the
    reason that the report prints."""


def between(times: np.ndarray, time: float) -> tuple[int, float]:
    """The interval that holds a time, and the part of it that has passed; at rest outside."""
    k = int(np.clip(np.searchsorted(times, time, "right") - 1, 0, max(len(times) - 2, 0)))
    if len(times) == 1:
        return -1, 0.0
    return k, float(np.clip((time - times[k]) / (times[k + 1] - times[k]), 0, 1))


def turned(one: np.ndarray, other: np.ndarray, part: float) -> np.ndarray:
    """The rotation (3, 3) between two quaternions (w, x, y, z), at a constant rate."""
    other = other if one @ other >= 0 else -other
    angle = np.arccos(min(one @ other, 1.0))
    if angle > 1e-9:
        one = (np.sin((1 - part) * angle) * one + np.sin(part * angle) * other) / np.sin(angle)
    w, x, y, z = one / np.linalg.norm(one)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


class Scene:
    """A scene: arrays as attributes (triangles (M, 3), rest, x, v (N,
    3) ...), `header` for the rest."""

    def __init__(self, header: dict[str, Any], arrays: dict[str, np.ndarray]) -> None:
        self.header, self.arrays = header, arrays

    def __getattr__(self, name: str) -> np.ndarray:
        try:
            return self.__dict__["arrays"][name]
        except KeyError:
            raise AttributeError(f"the scene has no array '{name}'") from None

    def held_at(self, time: float) -> np.ndarray:
        """Where the held particles are at a time [s]: (H, 3) [m]; those that stay, too."""
        if "held_times" not in self.arrays:
            return self.arrays["x"][self.arrays["held"]]
        k, part = between(self.arrays["held_times"], time)
        return (1 - part) * self.arrays["held_x"][k] + part * self.arrays["held_x"][k + 1]

    def pose_at(self, obstacle: dict[str, Any], time: float) -> tuple[np.ndarray, np.ndarray]:
        """R (3, 3), T [m]: the obstacle's point X is at R X + T at that time [s]."""
        if "motion" not in obstacle:
            return np.eye(3), np.zeros(3)
        name = f"motion_{obstacle['motion']}"
        poses = self.arrays[name + "_poses"]
        k, part = between(self.arrays[name + "_times"], time)
        return turned(poses[k, 3:], poses[k + 1, 3:], part), \
            (1 - part) * poses[k, :3] + part * poses[k + 1, :3]


class Solver:
    """What an adapter overrides. x [m] and v [m/s] are (N, 3); forces [N] too; energies in J."""

    name, version, level, precision = "unnamed", "0", "L1", "f8"
    scheme, order = "unnamed", 1
    capabilities: tuple[str, ...] = ()
    solve_tolerance = 0.0  # relative residual of linear systems; 0 where none is solved
    more: dict[str, Any] = {}  # further fields of the declaration, as {"contact_offset": 0.001}
    # by name: {"kind": "iterations", "range": [1, 1000], "value": 10, "proportional": True}
    tunables: dict[str, dict[str, Any]] = {}
    x: np.ndarray
    v: np.ndarray
    tell: Callable[[float], None] | None = None  # set by serve()

    def progress(self, part: float) -> None:
        """To be called after each step of a long `advance`, with the part that is done, 0 to 1.
        Says at most once a second that the solver is at work, so that it is not taken to hang."""
        if self.tell:
            self.tell(part)

    def tuned(self, scene: Scene, name: str) -> float:
        """The value of a tunable in a scene."""
        return scene.header["scene"].get("tunables", {}).get(name, self.tunables[name]["value"])

    def prepare(self, scene: Scene) -> dict[str, str]:
        raise Declined("scenes")

    def advance(self, dt: float, steps: int) -> None:
        raise Declined("steps")

    def set_state(self, x: np.ndarray, v: np.ndarray, time: float) -> None:
        self.x, self.v = x, v

    def forces(self) -> np.ndarray:
        raise Declined("forces")

    def damping(self) -> np.ndarray:
        raise Declined("damping forces")

    def contact_forces(self) -> np.ndarray:
        """Of the obstacles, the mean over the last `advance`."""
        raise Declined("contact forces")

    def energy(self) -> float:
        raise Declined("energy")


class Pipe:
    """Messages over two descriptors: a JSON line, then the arrays that it lists."""

    def __init__(self, source: BinaryIO, sink: BinaryIO) -> None:
        self.source, self.sink = source, sink
        self.told = time.monotonic()  # when something was received, or progress was sent

    def send_progress(self, identity: int, part: float) -> None:
        if time.monotonic() - self.told >= SECONDS_BETWEEN_PROGRESS:
            self.told = time.monotonic()
            self.send({"id": identity, "progress": min(max(float(part), 0.0), 1.0)})

    def receive(self) -> tuple[dict[str, Any], dict[str, np.ndarray]] | None:
        line = self.source.readline()
        if not line:
            return None
        header = json.loads(line)
        self.told = time.monotonic()
        arrays = {}
        for entry in header.get("arrays", []):
            kind, shape = np.dtype(TYPES[entry["type"]]), entry["shape"]
            data = self.source.read(kind.itemsize * int(np.prod(shape)))
            arrays[entry["name"]] = np.frombuffer(data, kind).reshape(shape).copy()
        return header, arrays

    def send(self, header: dict[str, Any], arrays: dict[str, np.ndarray] | None = None) -> None:
        data = {name: np.ascontiguousarray(value) for name, value in (arrays or {}).items()}
        listed = [
            {"name": name, "type": value.dtype.str[1:], "shape": list(value.shape)}
            for name, value in data.items()
        ]
        text = json.dumps({**header, "arrays": listed}) + "\n"
        self.sink.write(text.encode() + b"".join(value.tobytes() for value in data.values()))
        self.sink.flush()


def declaration(solver: Solver) -> dict[str, Any]:
    return {
        "protocol": PROTOCOL, "name": solver.name, "version": solver.version, "level": solver.level,
        "precision": solver.precision, "scheme": {"name": solver.scheme, "order": solver.order},
        "capabilities": list(solver.capabilities), "solve_tolerance": solver.solve_tolerance,
        **({"tunables": solver.tunables} if solver.tunables else {}), **solver.more
    }


def state_of(solver: Solver) -> dict[str, np.ndarray]:
    kind = TYPES[solver.precision]
    return {"x": np.asarray(solver.x, kind), "v": np.asarray(solver.v, kind)}


def run_frames(solver: Solver, scene: Scene) -> dict[str, np.ndarray]:
    """The states at steps 'frames', ascending, counted in steps of dt: x, v (F, N, 3)."""
    solver.prepare(scene)
    done, frames = 0, []
    for steps in scene.header["frames"]:
        solver.advance(scene.header["scene"]["dt"], steps - done)
        done = steps
        frames.append(state_of(solver))
    return {name: np.stack([frame[name] for frame in frames]) for name in ("x", "v")}


def answer(
    solver: Solver, header: dict[str, Any], arrays: dict[str, np.ndarray]
) -> tuple[dict, dict]:
    operation = header["op"]
    if operation == "start":
        return declaration(solver), {}
    if operation == "prepare":
        return {"mapping": solver.prepare(Scene(header, arrays)) or {}}, {}
    if operation == "run":
        return {}, run_frames(solver, Scene(header, arrays))
    if operation == "advance":
        solver.advance(header["dt"], header["steps"])
        return {}, state_of(solver)
    if operation == "get_state":
        return {}, state_of(solver)
    if "x" in arrays:
        solver.set_state(arrays["x"], arrays["v"], header.get("time", 0.0))
    if operation == "step":
        solver.advance(header["dt"], 1)
        return {}, state_of(solver)
    if operation in ("forces", "damping", "contact_forces"):
        return {}, {"f": np.asarray(getattr(solver, operation)(), TYPES[solver.precision])}
    if operation == "energy":
        return {"energy": float(solver.energy())}, {}
    raise Declined(f"operation '{operation}'")


def open_pipe() -> Pipe:
    return Pipe(
        os.fdopen(int(os.environ["FOLDPROOF_IN"]), "rb"),
        os.fdopen(int(os.environ["FOLDPROOF_OUT"]), "wb"),
    )


def serve(solver: Solver, pipe: Pipe | None = None) -> None:
    """Answers until 'stop' or the end of the pipe. An exception is
    told, and the next call answered."""
    pipe = pipe or open_pipe()
    while (message := pipe.receive()) is not None:
        header, arrays = message
        if header["op"] == "stop":
            pipe.send({"id": header["id"]})
            return
        solver.tell = lambda part, identity=header["id"]: pipe.send_progress(identity, part)
        try:
            reply, sent = answer(solver, header, arrays)
        except Declined as reason:
            reply, sent = {"declined": str(reason)}, {}
        except Exception as error:  # told to the client, which calls it a failure
            traceback.print_exc(file=sys.stderr)
            reply, sent = {"error": f"{type(error).__name__}: {error}"}, {}
        pipe.send({"id": header["id"], **reply}, sent)
