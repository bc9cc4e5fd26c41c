#!/usr/bin/python3
"""Solvers that break the protocol or themselves, each in one way, in the
third step or so: broken.py KIND

The client must name the cause of each and survive it. Without a KIND it lists them.
"""
from __future__ import annotations

import os
import resource
import signal
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "adapters"))
from foldproof_solver import Pipe, Solver, answer, open_pipe, serve  # noqa: E402
from toy_solver import ToySolver  # noqa: E402


class Broken(ToySolver):
    """A toy that goes wrong in `advance`; a method for each kind does it."""

    def __init__(self, kind: str, pipe: Pipe) -> None:
        self.kind, self.pipe = kind, pipe

    def advance(self, dt: float, steps: int) -> None:
        super().advance(dt, steps)
        wreck = getattr(self, self.kind, None)
        if wreck:
            wreck()

    def crash(self) -> None:
        print("about to touch address 0", flush=True)
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        os.kill(os.getpid(), signal.SIGSEGV)

    def late_crash(self) -> None:
        self.calls = getattr(self, "calls", 0) + 1
        if self.calls == 3:
            self.crash()

    def tells_progress(self) -> None:
        for k in range(32):  # 3.2 s
            time.sleep(0.1)
            self.progress(k / 32)

    def last_lines(self) -> None:
        print("".join(f"line {k}\n" for k in range(12)) + "\n  indented", flush=True)
        os._exit(3)

    def exit_3(self) -> None:
        print("giving up", file=sys.stderr, flush=True)
        os._exit(3)

    def hang(self) -> None:
        print("thinking", flush=True)
        time.sleep(3600)

    def exception(self) -> None:
        raise ValueError("a matrix is singular")

    def nan(self) -> None:
        self.x[1, 2] = np.nan

    def fill_memory(self) -> None:
        kept = []
        while True:
            kept.append(np.ones(1 << 24))

    def fill_disk(self) -> None:
        with open(os.path.join(os.environ["FOLDPROOF_FOLDER"], "big"), "wb") as file:
            while True:
                file.write(bytes(1 << 20))
                file.flush()

    def fork_and_exit(self) -> None:
        if os.fork() == 0:
            time.sleep(3600)
        os._exit(4)


def send_raw(pipe: Pipe, data: bytes) -> None:
    pipe.sink.write(data)
    pipe.sink.flush()


def header_of(identity: int, particles: int) -> bytes:
    entries = ", ".join(
        f'{{"name": "{name}", "type": "f8", "shape": [{particles}, 3]}}' for name in "xv"
    )
    return f'{{"id": {identity}, "arrays": [{entries}]}}\n'.encode()


def spoiled(identity: int, n: int) -> dict[str, bytes]:
    """Wrong answers to `advance`, by kind; n particles are due."""
    state, right = np.zeros((2 * n, 3)).tobytes(), header_of(identity, n)
    return {
        "truncated": right + state[:100],
        "short_array": header_of(identity, n - 1) + state,
        "oversized": header_of(identity, 10**12),
        "too_many_bytes": right + state + bytes(8),
        "wrong_shape": right.replace(b", 3]", b", 2]") + state,
        "invalid_json": b'{"id": 5, "arrays": [}\n',
        "noise_on_the_pipe": b"iteration 1: residual 0.3\n",
        "endless_header": b"x" * 65536,
        "wrong_id": header_of(identity + 1, n) + state,
    }


WRECKED = [kind for kind in vars(Broken) if not kind.startswith("_") and kind != "advance"]
SPOILED = list(spoiled(1, 1))


def serve_spoiled(kind: str, solver: Solver, pipe: Pipe) -> None:
    while (message := pipe.receive()) is not None:
        header, arrays = message
        if header["op"] != "advance":
            reply, sent = answer(solver, header, arrays)
            pipe.send({"id": header["id"], **reply}, sent)
            continue
        wrong = spoiled(header["id"], len(solver.x))[kind]
        send_raw(pipe, wrong)
        while kind == "endless_header":
            send_raw(pipe, wrong)
        if kind == "truncated":
            os._exit(0)


def main() -> int:
    kind = sys.argv[1] if len(sys.argv) == 2 else ""
    pipe = open_pipe() if "FOLDPROOF_IN" in os.environ else None
    if kind == "noise_on_stdout":  # allowed: the pipe is another descriptor
        print("x" * 100_000, flush=True)
        serve(ToySolver(), pipe)
    elif kind == "silent_start":
        time.sleep(3600)
    elif kind in WRECKED and pipe:
        serve(Broken(kind, pipe), pipe)
    elif kind in SPOILED and pipe:
        serve_spoiled(kind, ToySolver(), pipe)
    else:
        print(
            "usage: broken.py KIND, below foldproof;", *WRECKED, *SPOILED, "noise_on_stdout",
            "silent_start"
        )
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
