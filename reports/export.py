#!/usr/bin/python3
"""Writes a simulation for other programs: a file for each frame (OBJ, PLY), one for all frames
(PC2, NPZ, USD as text), or one XDMF with its HDF5.

    reports/export.py results/grab.h5 --format ply --out grab_ply     -> grab.0000.ply, ...,
                                                                 and grab-object-0.0000.ply, ...

Cloth and objects are written in world coordinates [m], each object to files of its own. PLY and
XDMF hold, for each particle, the velocity [m/s] and the fields that the report can colour the cloth
by: speed [m/s], strain [1], angle [rad], phi [m]. USD holds the velocity.
"""
from __future__ import annotations

import io
import re
import struct
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from xml.sax.saxutils import escape, quoteattr

sys.dont_write_bytecode = True

from data.command_line import OneLineParser, refusing_damage, require_modules  # noqa: E402

require_modules("export", "numpy", "h5py")
import h5py  # noqa: E402
import numpy as np  # noqa: E402

from data.cloth_values import all_values  # noqa: E402
from data.results import Case, load_case  # noqa: E402
from data.unreadable import Unreadable  # noqa: E402
from data.whole_file import write_whole  # noqa: E402


@dataclass
class Body:
    """The cloth or an object in all T frames: N points, M triangles."""
    name: str                       # of its files
    triangles: np.ndarray           # M x 3
    x: np.ndarray                   # T x N x 3 [m]
    values: dict[str, np.ndarray]   # T x N, or T x N x 3


def main() -> int:
    """Returns 0 when all is written, 2 when it cannot be."""
    parser = OneLineParser(description="Write a simulation for other programs.")
    parser.add_argument("case", metavar="CASE.h5", type=Path, help="the file of a simulation")
    parser.add_argument("--format", choices=WRITERS, required=True)
    parser.add_argument(
        "--out", metavar="DIR", type=Path, required=True,
        help="folder for the files; made if it is not there"
    )
    parser.add_argument("--like", metavar="FILE.obj", type=Path, help="OBJ file of the cloth")
    options = parser.parse_args()
    with refusing_damage("export", options.case):
        options.out.mkdir(parents=True, exist_ok=True)
        files = export(load_case(options.case), options.format, options.out, options.like)
    print(f"{options.out}: {len(files)} files")
    return 0


def export(case: Case, kind: str, folder: Path, like: Path | None = None) -> list[Path]:
    """Writes all frames; returns the files."""
    if like:
        return write_obj(case, bodies_of(case), folder, Template(like, case.triangles))
    return WRITERS[kind](case, bodies_of(case), folder)


def bodies_of(case: Case) -> list[Body]:
    """The cloth first, then the objects in their order."""
    name, frames = case.path.stem, range(len(case.frame_times))
    values = all_values(case)
    velocities = case.every_frame("velocities")
    if velocities is not None:
        values = {"velocity": velocities} | values
    cloth = Body(name, case.triangles, case.every_frame("positions"), values)
    return [cloth] + [
        Body(
            f"{name}-object-{k}", part.triangles,
            np.stack([part.positions(frame) for frame in frames]), {}
        )
        for k, part in enumerate(case.objects)
    ]


class Template:
    """An OBJ file of the cloth, before sewing: its records serve all frames, but v and vn."""

    def __init__(self, path: Path, triangles: np.ndarray) -> None:
        text = path.read_text(encoding="utf-8-sig", errors="surrogateescape").replace("\\\n", " ")
        self.records: list[tuple[str, str]] = []  # the first word, and the line
        fans: list[tuple[int, ...]] = []
        count = 0  # of vertices so far
        for line in text.split("\n"):
            kind, *words = line.partition("#")[0].split() or [""]
            count += kind == "v"
            if kind == "f":
                corners = [int(word.partition("/")[0]) for word in words]
                corners = [corner - 1 if corner > 0 else count + corner for corner in corners]
                fans += [(corners[0], *two) for two in zip(corners[1:], corners[2:])]
                line = " ".join(["f"] + ["/".join(w.split("/")[:2]).rstrip("/") for w in words])
            self.records.append((kind, line))
        ends = list(zip(np.ravel(fans).tolist(), triangles.ravel().tolist()))
        self.particles = dict(ends)  # of each vertex that a face uses
        if np.shape(fans) != triangles.shape or set(ends) != set(self.particles.items()):
            raise Unreadable(f"{path}: its faces are not the cloth's triangles; give the file that "
                             "the run read, without concave polygons, copies, refine or repair")

    def lines(self, x: np.ndarray) -> Iterator[str]:
        """x: N x 3 [m]. Vertices of no face stay."""
        vertex = -1
        for kind, line in self.records:
            vertex += kind == "v"
            if kind == "v" and vertex in self.particles:
                line = "v {:.17g} {:.17g} {:.17g}".format(*x[self.particles[vertex]].tolist())
            if kind != "vn":  # of another shape
                yield line


def write_obj(case: Case, bodies: list[Body], folder: Path,
              like: Template | None = None) -> list[Path]:
    """Wavefront OBJ: positions with all their digits, triangles; times.txt for what OBJ lacks."""
    def lines(body: Body, frame: int) -> Iterator[str]:
        if like and body is bodies[0]:
            yield from like.lines(body.x[frame])
            return
        yield f"o {body.name}"
        yield from (f"v {x:.17g} {y:.17g} {z:.17g}" for x, y, z in body.x[frame].tolist())
        yield from (f"f {a} {b} {c}" for a, b, c in (body.triangles + 1).tolist())
    return [_write_times(case, folder)] + [
        _write(
            folder / f"{body.name}.{frame:04d}.obj",
            ("\n".join(lines(body, frame)) + "\n").encode("utf-8", "surrogateescape"),
        )
        for body in bodies
        for frame in range(len(body.x))
    ]


def write_ply(case: Case, bodies: list[Body], folder: Path) -> list[Path]:
    """PLY, binary, little endian, double precision; the fields are properties of the vertices."""
    files = []
    for body in bodies:
        faces = np.zeros(len(body.triangles), dtype=[("count", "u1"), ("corners", "<i4", 3)])
        faces["count"], faces["corners"] = 3, body.triangles
        for frame, time in enumerate(case.frame_times):
            columns = {"x": body.x[frame, :, 0], "y": body.x[frame, :, 1], "z": body.x[frame, :, 2]}
            for name, values in body.values.items():
                columns |= (
                    {name: values[frame]}
                    if values.ndim == 2
                    else dict(zip(("vx", "vy", "vz"), values[frame].T))
                )
            points = np.zeros(body.x.shape[1], dtype=[(name, "<f8") for name in columns])
            for name, column in columns.items():
                points[name] = column
            head = [
                "ply", "format binary_little_endian 1.0", f"comment time {time:.17g} s",
                f"element vertex {len(points)}", *(f"property double {name}" for name in columns),
                f"element face {len(faces)}", "property list uchar int vertex_indices",
                "end_header\n"
            ]
            files.append(
                _write(
                    folder / f"{body.name}.{frame:04d}.ply",
                    "\n".join(head).encode("ascii") + points.tobytes() + faces.tobytes(),
                )
            )
    return files


def write_pc2(case: Case, bodies: list[Body], folder: Path) -> list[Path]:
    """3ds Max point caches: float32 points of all frames, without faces; times.txt for the times.
    """
    return [_write_times(case, folder)] + [
        _write(
            folder / f"{body.name}.pc2",
            struct.pack("<12siiffi", b"POINTCACHE2", 1, body.x.shape[1], 0, 1, len(body.x))
            + body.x.astype("<f4").tobytes(),
        )
        for body in bodies
    ]


def write_npz(case: Case, bodies: list[Body], folder: Path) -> list[Path]:
    """NumPy archives, stored: vertices [F, N, 3] [m], faces [M, 3], fps, and times [F] [s]."""
    files = []
    for body in bodies:
        content = io.BytesIO()
        np.savez(
            content, vertices=body.x, faces=body.triangles.astype("<i4"), fps=_rate_of(case),
            times=case.frame_times
        )
        files.append(_write(folder / f"{body.name}.npz", content.getvalue()))
    return files


def write_usda(case: Case, bodies: list[Body], folder: Path) -> list[Path]:
    """USD as text: a Mesh with time samples of its points, float32, a time code a frame."""
    rate = _rate_of(case)
    codes = [round(code) if abs(code - round(code)) < 1e-6 else code
             for code in (case.frame_times * rate).tolist()]

    def samples(kind: str, name: str, values: np.ndarray) -> Iterator[str]:
        yield f"    {kind}[] {name}.timeSamples = {{"
        for code, rows in zip(codes, values.astype("<f4").astype(str).tolist()):
            points = ", ".join(f"({x}, {y}, {z})" for x, y, z in rows)
            yield f"        {code:.17g}: [{points}],"
        yield "    }"

    def lines(body: Body) -> Iterator[str]:
        prim = re.sub(r"\W|^(?=\d)", "_", body.name, flags=re.ASCII)
        yield f'#usda 1.0\n(\n    defaultPrim = "{prim}"\n    endTimeCode = {codes[-1]:.17g}'
        yield f"    framesPerSecond = {rate:.17g}\n    metersPerUnit = 1\n    startTimeCode = 0"
        yield f'    timeCodesPerSecond = {rate:.17g}\n    upAxis = "Y"\n)\n\ndef Mesh "{prim}"\n{{'
        yield f"    int[] faceVertexCounts = [{', '.join('3' for _ in body.triangles)}]"
        yield f"    int[] faceVertexIndices = [{', '.join(map(str, body.triangles.ravel()))}]"
        yield from samples("point3f", "points", body.x)
        yield '    uniform token subdivisionScheme = "none"'
        if "velocity" in body.values:
            yield from samples("vector3f", "velocities", body.values["velocity"])
        yield "}"
    return [
        _write(folder / f"{body.name}.usda", ("\n".join(lines(body)) + "\n").encode("ascii"))
        for body in bodies
    ]


def write_xdmf(case: Case, bodies: list[Body], folder: Path) -> list[Path]:
    """An XDMF for the cloth and for each object, a collection in time,
    and the one HDF5 that they name."""
    data, partial = (
        folder / f"{case.path.stem}.data.h5", folder / f"{case.path.stem}.data.h5.partial"
    )
    with h5py.File(partial, "w", track_order=True) as file:
        for body in bodies:
            file[f"{body.name}/triangles"] = body.triangles.astype("<i4")
            for frame in range(len(body.x)):
                for name, values in {"x": body.x, **body.values}.items():
                    file[f"{body.name}/{frame}/{name}"] = values[frame]
    partial.replace(data)
    return [data] + [
        _write(
            folder / f"{body.name}.xdmf", _xdmf(body, data.name, case.frame_times).encode("utf-8")
        )
        for body in bodies
    ]


def _xdmf(body: Body, file: str, times: np.ndarray) -> str:
    grids = "\n".join(
        _xdmf_grid(body, escape(f"{file}:/{body.name}"), frame, time)
        for frame, time in enumerate(times)
    )
    return (
        '<?xml version="1.0"?>\n<Xdmf Version="3.0">\n<Domain>\n<Grid'
        f' Name={quoteattr(body.name)} GridType="Collection"'
        f' CollectionType="Temporal">\n{grids}\n</Grid>\n</Domain>\n</Xdmf>\n'
    )


def _xdmf_grid(body: Body, place: str, frame: int, time: float) -> str:
    def item(
        name: str, shape: tuple[int, ...], kind: str = 'NumberType="Float" Precision="8"'
    ) -> str:
        return (
            f'<DataItem Dimensions="{" ".join(map(str, shape))}"'
            f' {kind} Format="HDF">{place}/{name}</DataItem>'
        )
    triangles = body.triangles.shape
    attributes = [
        f'<Attribute Name="{name}" AttributeType="{"Vector" if values.ndim == 3 else "Scalar"}"'
        f' Center="Node">{item(f"{frame}/{name}", values.shape[1:])}</Attribute>\n'
        for name, values in body.values.items()
    ]
    return (
        f'<Grid Name="frame {frame}" GridType="Uniform"><Time Value="{time:.17g}"/>\n'
        f'<Topology TopologyType="Triangle" NumberOfElements="{triangles[0]}">'
        + item("triangles", triangles, 'NumberType="Int" Precision="4"')
        + '</Topology>\n<Geometry GeometryType="XYZ">'
        + item(f"{frame}/x", body.x.shape[1:])
        + "</Geometry>\n"
        + "".join(attributes)
        + "</Grid>"
    )


def _rate_of(case: Case) -> float:
    """Frames a second, on average."""
    times = case.frame_times
    return round((len(times) - 1) / (times[-1] - times[0]), 9) if len(times) > 1 else 1.0


def _write_times(case: Case, folder: Path) -> Path:
    times = "".join(f"{time:.17g}\n" for time in case.frame_times)
    return _write(folder / "times.txt", f"# s, one a frame\n{times}".encode("ascii"))


def _write(path: Path, content: bytes) -> Path:
    write_whole(path, content)
    return path


WRITERS = {
    "obj": write_obj, "ply": write_ply, "pc2": write_pc2, "npz": write_npz, "usda": write_usda,
    "xdmf": write_xdmf
}

if __name__ == "__main__":
    sys.exit(main())
