#!/usr/bin/python3
"""Statics by CalculiX, which shares nothing with us: a heavy cantilever seen from its side, and the
plane stress of a stretched sheet with clamped ends. One line of JSON for each answer.

  static.py cantilever GAMMA...    weight over stiffness, rho_A g L^3 / B
  static.py clamped ASPECT...      length over width, Poisson's ratio 1/3

Needs `ccx` (`scripts/engines calculix`), version 2.20 for the numbers of README.md.
"""
from __future__ import annotations

import argparse
import json
import subprocess
import tempfile
from collections.abc import Iterable
from pathlib import Path

Node = tuple[int, int]  # indices of the half-edges along and across
THICKNESS = 0.003  # of the cantilever's length
POISSON = 1 / 3  # of the stretched sheet
STRAIN = 1e-3
THIN = 0.001  # of the width: elements of plane stress are solids, which resist as such if thick


def mesh_of(columns: int, rows: int, x: list[float], y: list[float], kind: str) -> str:
    """Eight-node rectangles; x and y are the places of the 2 columns + 1 and 2 rows + 1 lines of
    nodes."""
    lines = ["*NODE, NSET=ALL"]
    for i in range(2 * columns + 1):
        for j in range(2 * rows + 1):
            if i % 2 == 0 or j % 2 == 0:
                lines.append(f"{number((i, j))}, {x[i]:.12g}, {y[j]:.12g}, 0.")
    lines.append(f"*ELEMENT, TYPE={kind}, ELSET=SHEET")
    corners = ((0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1))
    for i in range(columns):
        for j in range(rows):
            nodes = [str(number((2 * i + a, 2 * j + b))) for a, b in corners]
            lines.append(f"{1 + i * rows + j}, {', '.join(nodes)}")
    return "\n".join(lines)


def number(node: Node) -> int:
    return 1 + node[0] * 10_000 + node[1]


def held(nodes: Iterable[Node], first: int, last: int, value: float = 0) -> str:
    return "\n".join(f"{number(node)}, {first}, {last}, {value:.12g}" for node in nodes)


def solved(text: str) -> dict[str, dict[int, list[float]]]:
    """Runs ccx; the last block of each result, by node."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "job.inp").write_text(text, encoding="utf-8")
        frd, quiet = Path(folder) / "job.frd", {"capture_output": True, "text": True}
        ran = subprocess.run(["ccx", "job"], cwd=folder, check=False, **quiet)
        if ran.returncode or "*ERROR" in ran.stdout or not frd.is_file():
            raise SystemExit(f"static.py: ccx failed:\n{ran.stdout[-1500:]}")
        return results_of(frd.read_text(encoding="utf-8"))


def results_of(frd: str) -> dict[str, dict[int, list[float]]]:
    found: dict[str, dict[int, list[float]]] = {}
    rows: dict[int, list[float]] = {}
    for line in frd.splitlines():
        if line.startswith(" -4"):
            rows = found[line.split()[1]] = {}
        elif line.startswith(" -1") and found:
            values = [float(line[k:k + 12]) for k in range(13, len(line.rstrip()), 12)]
            rows[int(line[3:13])] = values
    return found


def cantilever(gamma: float, columns: int = 40) -> dict[str, float]:
    """Where the middle of the tip of a strip of length 1 hangs, seen from its side: clamped level
    at x = 0, B = 1, so that its weight is gamma."""
    x = [i / (2 * columns) for i in range(2 * columns + 1)]
    clamp = [(0, j) for j in range(3)]
    text = f"""{mesh_of(columns, 1, x, [-THICKNESS / 2, 0, THICKNESS / 2], "CPS8R")}
*MATERIAL, NAME=CLOTH
*ELASTIC
{12 / THICKNESS**3:.12g}, 0.
*DENSITY
{gamma / THICKNESS:.12g}
*SOLID SECTION, ELSET=SHEET, MATERIAL=CLOTH
1.
*BOUNDARY
{held(clamp, 1, 2)}
*STEP, NLGEOM, INC=10000
*STATIC
0.01, 1., 1e-9, 0.1
*DLOAD
SHEET, GRAV, 1., 0., -1., 0.
*NODE FILE, OUTPUT=2D
U
*END STEP
"""
    moved = solved(text)["DISP"][number((2 * columns, 1))]
    return {"gamma": gamma, "height": moved[1], "reach": 1 + moved[0]}


def graded(cells: int, length: float) -> list[float]:
    """Places of the nodes from 0 to `length`, closer near 0."""
    corners = [length * (k / cells) ** 2 for k in range(cells + 1)]
    middles = [(a + b) / 2 for a, b in zip(corners, corners[1:])]
    return sorted(corners + middles)


def clamped(aspect: float, cells: int = 48) -> dict[str, float | None]:
    """The stress across on the middle line of a sheet of width 1, over the mean tension along.
    A quarter is solved: the clamp at x = 0 draws it out, x = aspect/2 and y = 0 are mirrors."""
    x = graded(cells, aspect / 2)
    y = [0.5 - place for place in reversed(graded(cells, 0.5))]
    last = 2 * cells
    clamp = [(0, j) for j in range(last + 1)]
    middle = [(last, j) for j in range(last + 1)]
    axis = [(i, 0) for i in range(1, last + 1)]
    text = f"""{mesh_of(cells, cells, x, y, "CPS8")}
*MATERIAL, NAME=CLOTH
*ELASTIC
1., {POISSON:.12g}
*SOLID SECTION, ELSET=SHEET, MATERIAL=CLOTH
{THIN:.12g}
*STEP
*STATIC
*BOUNDARY
{held(clamp, 1, 1, -STRAIN * aspect / 2)}
{held(clamp, 2, 2)}
{held(middle, 1, 1)}
{held(axis, 2, 2)}
*EL FILE
S
*NODE FILE
U
*END STEP
"""
    stress = solved(text)["STRESS"]
    tension = mean_tension(stress, y, last)
    across = [(x[i], stress[number((i, 0))][1] / tension) for i in range(0, last + 1, 2)]
    place, least = min(across, key=lambda point: point[1])
    return {
        "aspect": aspect, "tension": tension / STRAIN, "most_compression": -least,
        "at": place / aspect, "begins": first_zero(across, aspect),
    }


def mean_tension(stress: dict[int, list[float]], y: list[float], last: int) -> float:
    """Simpson's rule over the sheet's middle section."""
    along = [stress[number((last, j))][0] for j in range(last + 1)]
    pieces = (
        (y[j + 2] - y[j]) / 6 * (along[j] + 4 * along[j + 1] + along[j + 2])
        for j in range(0, last, 2)
    )
    return 2 * sum(pieces)


def first_zero(across: list[tuple[float, float]], aspect: float) -> float | None:
    """Where compression begins, over the length; None if nowhere."""
    for (a, before), (b, after) in zip(across, across[1:]):
        if before >= 0 > after:
            return (a + (b - a) * before / (before - after)) / aspect
    return None


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("what", choices=("cantilever", "clamped"))
    parser.add_argument("values", nargs="+", type=float)
    asked = parser.parse_args()
    for value in asked.values:
        answer = cantilever(value) if asked.what == "cantilever" else clamped(value)
        print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main()
