"""Small made-up runs for the tests of the report generator."""
from __future__ import annotations

from pathlib import Path
from typing import Any

import h5py
import numpy as np

HOSTILE = (
    '<script>alert("1")</script> & <img src=x onerror=alert(1)> \' onload=alert(1) ]]> -->'
    ' \x01\x1b\x7f\ufffe'
)
NAMES = (
    "bending.forces-sum-to-zero", "bending.damping-dissipates", "springs.limit",
    "time-order.hinge.C.x", "bench.bending-elastic", "sticking.<img src=x onerror=alert(1)>",
    "case.fold.stays-outside", "case.sharp_fold.runs-to-its-end"
)
TEXT = h5py.string_dtype()


def put(item: h5py.Group | h5py.Dataset, **said: Any) -> None:
    """Sets attributes; lists become arrays of strings."""
    for key, value in said.items():
        item.attrs[key] = (
            np.array(value, dtype=TEXT) if isinstance(value, list) and value else value
        )


def put_finding(file: h5py.File, order: int, name: str, kind: str, **said: Any) -> None:
    """Adds one finding with a little evidence."""
    group = file.create_group(f"findings/{name}")
    usual = dict(
        order=order, kind=kind, study="", claim=f"Claim of {name}.", source="BMF03 section 4",
        measured=3.2e-15, bound=4.4e-14, uncertainty=0.0, unit="N", why_bound="200 roundings",
        outcome="holds", note="", seconds=0.1, faults=["flipped-sign"]
    )
    put(group, **(usual | said))
    angles = group.create_dataset("evidence/angle", data=np.linspace(-3, 3, 40))
    put(angles, order=0, unit="rad")
    mesh = group.create_dataset(
        "evidence/mesh", data=np.array([HOSTILE] * 40, dtype=object), dtype=TEXT
    )
    put(mesh, order=1, unit="")


def put_study(file: h5py.File) -> None:
    """Adds a study with one figure of two curves, one of them partly NaN."""
    study = file.create_group("studies/time-order")
    put(study, order=1, claim="Second order.", source="BMF03", about=HOSTILE, seconds=1.0)
    figure = file.create_group("studies/time-order/figures/x")
    put(
        figure, order=1, title=f"Error of the position {HOSTILE}", x_label=f"step {HOSTILE}",
        x_unit="s<b>\x02", y_label="error $x$ <b>", y_unit="m", x_scale="log", y_scale="log",
        slope=2.0, caption=HOSTILE
    )
    h = 0.02 / 2.0 ** np.arange(5)
    for k in range(2):
        curve = figure.create_group(f"curves/{k}")
        put(curve, order=k, label=f"scheme {k} {HOSTILE}", floor=1e-9)
        curve["x"], curve["y"] = h, np.where((h > 0.01) & (k == 1), np.nan, h ** 2)
        curve["pair_orders"] = np.full(4, 2.0)
        if k == 1:
            put(curve, slope=2.0)
            curve["marks"] = np.array(
                ["diverged"] * 1 + ["unfinished"] + ["measured"] * 3, dtype=TEXT
            )


def put_map(file: h5py.File, study: str) -> None:
    """Adds a study with one map of 5 x 4 points, two of them NaN and one
    negative on its logarithmic scale."""
    put(
        file.require_group(f"studies/{study}"), order=9, claim="Stable.", source="BMF03", about="",
        seconds=0.004
    )
    group = file.create_group(f"studies/{study}/maps/radius")
    put(
        group, order=0, title="Radius", x_label="step", x_unit="s", x_scale="linear",
        y_label="damping", y_unit="1", y_scale="log", quantity=f"spectral radius {HOSTILE}",
        unit="1", scale="log", caption=HOSTILE
    )
    values = np.linspace(0.5, 2.0, 20).reshape(4, 5)
    values[0, 1:3], values[3, 4] = np.nan, -1.0
    group["x"], group["y"], group["values"] = (
        np.linspace(0.1, 0.5, 5), np.logspace(-2, 1, 4), values
    )
    limit = group.create_group("curves/0")
    put(limit, order=0, label=f"limit {HOSTILE}", floor=np.nan)
    limit["x"], limit["y"] = np.array([0.1, 0.5, np.nan]), np.array([0.02, 5.0, 1.0])


def put_claim(
    file: h5py.File, order: int, name: str, ruling: str, decided_by: list[str], **place: Any
) -> None:
    """Adds a claim, each of whose findings supports it. `place` in the paper:
    files of older programs have none."""
    put(
        file.create_group(f"claims/{name}"), order=order, section="3",
        statement=f"Statement {HOSTILE}", ruling=ruling, recorded="confirmed", condition="",
        why=f"Why {name}: {HOSTILE}", decided_by=decided_by, roles=["supports"] * len(decided_by),
        **place
    )


def made_up_verdicts() -> dict[str, Any]:
    """A made-up verdicts.json: a finding of every outcome, one of them NaN, and two claims."""
    program = dict(
        name="foldproof", version="0.2.0", commit="0123456789" * 4, tree="dirty",
        compiler="GNU 12.2.0", flags=" -O3", cpu=HOSTILE, date="2026-11-22T06:51:18Z",
        command="build/foldproof verify", tier="quick", seed=0, subject="foldproof reference"
    )
    usual = dict(
        kind="check", study="", claim=HOSTILE, source="", measured=3.2e-15, uncertainty=0,
        bound=4.4e-14, unit="N", why_bound="200 roundings", note="", seconds=0.1,
        faults=["flipped-sign"]
    )
    nothing = dict(measured=None, uncertainty=None, bound=None)
    findings = [
        usual | dict(name="a", outcome="holds"),
        usual | nothing | dict(name="b", outcome="fails"),
        usual | dict(name="c", outcome="inconclusive", kind="study", study="time-order"),
        usual | dict(name="d", outcome="not applicable"),
        usual | nothing | dict(name="e", outcome="did not run"),
        usual
        | dict(name="f", outcome="measured", kind="bench", measured=2e7, bound=1e7, unit="1/s"),
    ]
    ruled = dict(
        kind="claim", section="3", source="BMF03 section 3", statement=HOSTILE,
        recorded="confirmed", condition="", why=HOSTILE,
        decided_by=[dict(finding="a", role="supports", outcome="holds")]
    )
    claims = [ruled | dict(name="claim.T1", id="T1", ruling="confirmed", outcome="holds"),
              ruled | dict(name="claim.T2", id="T2", ruling="undecided", outcome="fails",
                           decided_by=[dict(finding="g", role="limits", outcome="missing")])]
    return {"schema": 1, "program": program, "findings": findings + claims}


def put_object(file: h5py.File, frames: int) -> None:
    """Adds a tetrahedron that turns by 90 degrees about z and rises by 0.1 m a frame."""
    group = file.create_group("objects/0")
    put(group, name=HOSTILE, shape="mesh", friction=0.3)
    group["vertices"] = np.array([[0, 0, 0], [0.5, 0, 0], [0, 0.5, 0], [0, 0, 0.5]])
    group["triangles"] = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], dtype=np.int32)
    angles = np.pi / 4 * np.arange(frames)
    group["rotation"] = np.stack([np.cos(angles), 0 * angles, 0 * angles, np.sin(angles)], axis=1)
    group["translation"] = np.outer(np.arange(frames), [0, 0, 0.1])


def put_deforming_object(file: h5py.File, frames: int) -> None:
    """Adds a triangle one of whose corners rises by 0.2 m a frame."""
    group = file.create_group("objects/1")
    put(group, name="flap", shape="animation", friction=0.0)
    group["vertices"] = np.array([[0, 0, 0], [0.5, 0, 0], [0, 0.5, 0]])
    group["triangles"] = np.array([[0, 1, 2]], dtype=np.int32)
    rise = np.zeros((frames, 3, 3))
    rise[:, 2, 2] = 0.2 * np.arange(frames)
    group["positions"] = group["vertices"][:] + rise


def put_case(folder: Path, name: str) -> None:
    """Writes a case of two triangles that fold over a few frames."""
    with h5py.File(folder / f"{name}.h5", "w") as file:
        put(file, case_name=name, title=HOSTILE, about="", built=["4 particles", "gravity"],
            case_text=f"[sheet]\n# {HOSTILE}\n", stopped="", seconds=1.0, commit="abcdef",
            command=f"build/foldproof run cases/{name}.toml")
        rest = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], dtype=float)
        file["mesh/triangles"] = np.array([[0, 1, 2], [1, 3, 2]], dtype=np.int32)
        file["mesh/held"] = np.array([1, 0, 0, 0], dtype=np.uint8)
        file["frames/time"] = np.arange(4.0)
        file["frames/positions"] = np.array(
            [rest + [0, 0, 0.1 * k] * rest[:, :1] for k in range(4)]
        )
        put_object(file, frames=4)
        put_deforming_object(file, frames=4)
        for key, values in dict(
            time=np.linspace(0, 3, 900), kinetic_energy=np.full(900, np.nan),
            gravity_energy=np.linspace(1, 0, 900), linear_momentum=np.ones((900, 3)),
            angular_momentum=np.zeros((900, 3)), cg_iterations=np.arange(900.0) % 3,
            cg_residual=np.zeros(900)
        ).items():
            unit = {"time": "s", "linear_momentum": "kg m/s", "angular_momentum": "kg m^2/s"}.get(
                key, "1"
            )
            put(file.create_dataset(f"diagnostics/{key}", data=values), unit=unit)


def put_run(folder: Path) -> None:
    """Writes a run with every kind of finding, a study, two cases (one missing) and faults."""
    with h5py.File(folder / "run.h5", "w") as file:
        put(file, schema=1, commit="abcdef", tree="dirty", cpu=HOSTILE, seconds=3.0,
            command="build/foldproof verify", compiler=np.bytes_(b"g++ \xff\xfe<i>"))
        put_finding(file, 1, NAMES[0], "check")
        put_finding(file, 2, NAMES[1], "check", measured=np.nan, outcome="fails", note=HOSTILE)
        put_finding(file, 3, NAMES[2], "check", outcome="inconclusive", why_bound=HOSTILE)
        put_finding(file, 4, NAMES[3], "study", study="time-order")
        put_finding(
            file, 5, NAMES[4], "bench", outcome="measured", better="higher", bound=1e7, measured=2e7
        )
        put_finding(
            file, 6, NAMES[5], "study", study="one that was not run", outcome="not applicable",
            note="written for another mesh", measured=np.nan
        )
        put_finding(file, 7, NAMES[6], "check", source=HOSTILE)
        put_finding(file, 8, NAMES[7], "check", source="A sharp fold", uncertainty=1.0)
        put_study(file)
        put_map(file, "stability-oscillator")
        put_claim(
            file, 1, "T1", "confirmed", [NAMES[0], "gone.finding"], paragraph=4,
            begins="Sums add up", printed="a - b", restored="a + b"
        )
        put_claim(file, 2, "T17", "refuted", [NAMES[3]])
        put_case(folder, "fold")
        put(file.create_group("cases/fold"), order=1, file="fold.h5", title=HOSTILE, about=HOSTILE,
            stopped="")
        put(
            file.create_group("cases/gone"), order=2, file="gone.h5", title="gone", about="",
            stopped=""
        )
        row = dict(
            name="flipped-sign", file="forces/bending.cpp", find="a < b && c", replace="a > b",
            law="momentum", caught_by=f"{NAMES[0]}, {NAMES[2]}, gone.check", outcome="caught"
        )
        for key, value in row.items():
            file.create_dataset(f"faults/{key}", data=np.array([value], dtype=object), dtype=TEXT)
