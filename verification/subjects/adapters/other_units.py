#!/usr/bin/python3
"""Asks a solver the suite's scenes in other units: its sheets then are of another material.

Usage: other_units.py DENSITY YOUNG RIGIDITY COMMAND...

A sheet of the suite has 0.2 kg/m^2, 5 N/m and, where it bends, 0.001 N m. Units of length, time and
mass are chosen such that the solver is given the same motion of a sheet of DENSITY [kg/m^2], YOUNG
[N/m] and RIGIDITY [N m]; answers go back to the suite's units. A law that reads 0.00101 N m has
found 1.01 RIGIDITY.
"""
from __future__ import annotations

import os
import subprocess
import sys
from typing import Any

import numpy as np

from foldproof_solver import Pipe, open_pipe

SUITE = {"density": 0.2, "young": 5.0, "rigidity": 1e-3}
PASSED = ("set_state", "held", "masses", "damping")  # without obstacles


def units(density: float, young: float, rigidity: float) -> dict[str, float]:
    """Metres, seconds and kilograms of the solver in those of the suite: from M/L^2, M/T^2 and
    M L^2/T^2."""
    metre = ((rigidity / SUITE["rigidity"]) / (young / SUITE["young"]))**0.5
    kilogram = density / SUITE["density"] * metre**2
    return {"m": metre, "kg": kilogram, "s": (kilogram / (young / SUITE["young"]))**0.5}


def child(command: str) -> Pipe:
    """The solver, in a pipe of its own."""
    (its_in, to_it), (from_it, its_out) = os.pipe(), os.pipe()
    environment = os.environ | {"FOLDPROOF_IN": str(its_in), "FOLDPROOF_OUT": str(its_out)}
    subprocess.Popen(["sh", "-c", command], env=environment, pass_fds=(its_in, its_out))
    os.close(its_in), os.close(its_out)
    return Pipe(os.fdopen(from_it, "rb"), os.fdopen(to_it, "wb"))


def times(values: dict[str, Any], by: dict[str, float], way: int) -> dict[str, Any]:
    """The values with each that has a unit in `by` multiplied by it, or divided (way -1)."""
    def one(value: Any, factor: float) -> Any:
        if isinstance(value, np.ndarray):
            return (value * factor).astype(value.dtype)
        return [factor * each for each in value] if isinstance(value, list) else factor * value

    return {name: one(value, by[name]**way) if name in by else value
            for name, value in values.items()}


def scaled(message: tuple[dict[str, Any], dict[str, np.ndarray]], of: dict[str, float],
           way: int) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """A message in the solver's units (way 1), or back in the suite's (-1)."""
    m, kg, s = of["m"], of["kg"], of["s"]
    header = times(message[0], {"dt": s, "time": s, "energy": kg * m**2 / s**2}, way)
    header.pop("arrays", None)
    if "scene" in header:
        scene = header["scene"] = times(header["scene"], {"dt": s, "gravity": m / s**2}, way)
        scene["material"] = times(scene["material"], {
            "density": kg / m**2, "young": kg / s**2, "stretch_damping": kg / s,
            "bending_rigidity": kg * m**2 / s**2, "bending_damping": kg * m / s}, way)
    return header, times(message[1], {
        "x": m, "rest": m, "rest_lengths": m, "v": m / s, "mass": kg, "f": kg * m / s**2,
        "edge_stiffness": kg / s**2}, way)


def main() -> None:
    of = units(*map(float, sys.argv[1:4]))
    judge, solver = open_pipe(), child(" ".join(sys.argv[4:]))
    while (message := judge.receive()) is not None:
        solver.send(*scaled(message, of, 1))
        while (answer := solver.receive()) is not None:
            reply, arrays = scaled(answer, of, -1)
            if "capabilities" in reply:
                reply["capabilities"] = [c for c in reply["capabilities"] if c in PASSED]
            judge.send(reply, arrays)
            if "progress" not in reply:
                break
        if message[0]["op"] == "stop":
            return


if __name__ == "__main__":
    main()
