#!/usr/bin/python3
"""Tests that a mesh file is read right or refused by its cause, and never misread in silence: some
hundred variants of three meshes, written here, through each command that reads meshes.

scripts/tests/test_damaged_meshes.py [--program FILE]
"""

import gzip
import json
import re
import struct
import unittest
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numpy as np

from program_case import ProgramCase, run

CASE = ('[cloth]\nmesh = "%s"\ndensity = 1\n[stretch]\nstiffness = 100\n'
        "[time]\nend = 1e-6\nstep = 1e-6\n")
MOVE = np.array([0, 0, 0.25])  # of the run that is compared [m]
COUNTS = "ends before|behind the last|fit the file"
VALUES = {
    "inspect": lambda answer, _: np.nan if answer["refusal"] else answer["volume"],
    "inspect --cloth": lambda answer, _: answer["area"],
    "crossings": lambda answer, _: answer[0]["pairs"] + answer[0]["repeated_faces"],
    "compare": lambda answer, _: answer["frames"][0]["rms"],
    "simulate": lambda _, message: float(re.search(r"([0-9.e+-]+) kg", message)[1])}


class Mesh(NamedTuple):
    x: np.ndarray           # N x 3 [m]
    faces: list[list[int]]  # polygons, from 0
    area: float = 0         # of a concave polygon [m^2]

    def measured(self) -> tuple[float, float, np.ndarray]:
        """Area [m^2], volume [m^3], the areas around each vertex [m^2]."""
        fans = np.array([(f[0], *two) for f in self.faces for two in zip(f[1:], f[2:])])
        a, b, c = self.x[fans].transpose(1, 0, 2)
        areas, around = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2, np.zeros(len(self.x))
        np.add.at(around, fans, areas[:, None])
        return self.area or areas.sum(), np.einsum("ij,ij", a, np.cross(b, c)) / 6, around

    def rms(self, places: np.ndarray) -> float:
        """Of the vertices' distances from these places, weighted with the areas around [m]."""
        return np.sqrt(np.average(((places - self.x) ** 2).sum(axis=1), weights=self.measured()[2]))


BASES = {
    "sheet": Mesh(np.array([(0.2 * i, 0.2 * j, 0) for j in range(5) for i in range(7)]),
                  [[k, k + 1, k + 8, k + 7] for k in range(28) if k % 7 < 6]),
    "box": Mesh(np.array([(i, 0.6 * j, 0.4 * k) for k in (0, 1)
                          for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))]),
                [[3, 2, 1, 0], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6],
                 [3, 0, 4, 7]]),
    "pyramid": Mesh(np.array([(0, 0, 0), (1, 0, 0), (1.3, 0.9, 0), (0.1, 1.1, 0), (0.4, 0.5, 0.8)]),
                    [[3, 2, 1, 0], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])}


def obj(mesh: Mesh, form: str = ".9g") -> str:
    return "# by hand\n" + "".join(
        "v " + " ".join(format(c, form) for c in place) + "\n" for place in mesh.x.tolist()
    ) + "".join("f " + " ".join(str(v + 1) for v in face) + "\n" for face in mesh.faces)


def ply(mesh: Mesh, order: str = "", more: tuple[int, int] = (0, 0)) -> bytes:
    """order: of bytes; "": text. more: what the header counts beyond vertices and faces."""
    form = {"": "ascii", "<": "binary_little_endian", ">": "binary_big_endian"}[order]
    axes = "".join(f"property float {axis}\n" for axis in "xyz")
    head = (f"ply\nformat {form} 1.0\nelement vertex {len(mesh.x) + more[0]}\n{axes}"
            f"element face {len(mesh.faces) + more[1]}\nproperty list int int vertex_indices\n"
            "end_header\n").encode()
    faces = [(len(face), *face) for face in mesh.faces]
    if order:
        return head + mesh.x.astype(order + "f4").tobytes() + b"".join(
            struct.pack(f"{order}{len(face)}i", *face) for face in faces)
    rows = [" ".join(map("{:.9g}".format, row)) + "\n" for row in [*mesh.x.tolist(), *faces]]
    return head + "".join(rows).encode()


class Variant(NamedTuple):
    kind: str
    name: str          # of the file
    data: str | bytes
    mesh: Mesh         # what it holds
    base: str          # what it was made of; "": none
    said: str = ""     # of the cause of a refusal or warning; "": neither
    must: bool = True  # be refused, if anything is said
    seams: float = 0   # [m]


def variants_of(base: str, mesh: Mesh) -> list[Variant]:
    text, rows, found = obj(mesh), ply(mesh), []
    second = text.split("\n")[2]

    def add(kind: str, name: str, data: str | bytes, said: str = "", must: bool = True,
            of: Mesh = mesh, seams: float = 0) -> None:
        found.append(Variant(kind, name, data, of, base, said, must, seams))

    for form in ("+.9g", ".9e", ".40f"):
        add("numbers", "form.obj", obj(mesh, form))
    for said, numbers in (
        ("finite", "nan inf -nan(ind)"), ("too large", "1e160 -3e99"), ("fit a double", "1e400"),
        ("not a number", "0x1p0 1,5 1_0 1d0 1.#QNAN O --1 1.0.0")
    ):
        for number in numbers.split():
            add("numbers", "n.obj", text.replace(second, f"v {number} 0 0", 1), said)
            add("numbers", "n.ply", rows.replace(b"header\n0", b"header\n" + number.encode()), said)
    for scale, said in ((1e-3, ""), (39.37, ""), (1e3, ""), (1e160, "too large"),
                        (1e-170, "would vanish")):
        large = mesh._replace(x=mesh.x * scale)
        add("scaled", "units.obj", obj(large), said, of=mesh if said else large)
    for order in ("", "<", ">"):
        whole = ply(mesh, order)
        start = whole.index(b"end_header") + 11
        add("binary", "whole.ply", whole)
        add("binary", "behind.ply", whole + b"7 7\n", COUNTS)
        for k in range(1, 5):
            add("binary", "cut.ply", whole[:start + (len(whole) - start) * k // 5], COUNTS)
        for more in ((1, 0), (-1, 0), (3, 0), (0, 1), (0, -1)):
            add("binary", "counts.ply", ply(mesh, order, more), COUNTS)
    for name, data, said in (
        *(("cut.obj", text[:text.index("f") * k // 4], "face|without|numbers") for k in (1, 2, 3)),
        ("missing.obj", text.replace(second + "\n", "", 1), "out of range"),
        ("beyond.obj", text + "f 1 2 99999\n", "out of range"),
        ("zero.obj", text + "f 0 1 2\n", "counted from 1"), ("two.obj", text + "f 1 2\n", "2 vert"),
        ("plane.obj", text.replace(second, "v 1 1", 1), "2 numbers"),
        ("nul.obj", text.replace(" ", "\0", 1), "zero bytes"),
        ("stl.obj", "solid a\nfacet normal 0 0 1\n", "'solid'"),
        ("page.obj", "<!DOCTYPE html>\n<html></html>\n", "DOCTYPE"),
        ("packed.obj", gzip.compress(text.encode(), mtime=0), "zero bytes"),
        ("upper.obj", text.upper(), "'V'"), ("blank.ply", "", "empty")
    ):
        add("damaged", name, data, said)
    turned = [face[::-1] for face in mesh.faces]
    for kind, name, faces, said in (
        ("damaged", "twice.obj", mesh.faces + [mesh.faces[0][:3]], "given twice"),
        ("damaged", "back.obj", mesh.faces + [mesh.faces[0][2::-1]], "given twice"),
        ("damaged", "all_twice.obj", mesh.faces * 2, "given twice"),
        ("damaged", "line.obj", mesh.faces + [[0, 1, 1]], "no area|without area"),
        ("inverted", "whole.obj", turned, "inside out"),
        ("inverted", "face.obj", turned[:1] + mesh.faces[1:], "opposite orientation")
    ):
        add(kind, name, obj(mesh._replace(faces=faces)), said, must=False)
    add("damaged", "unused.obj", text + "v 9 9 9\n", "in no triangle", must=False)
    ends = np.cumsum([len(face) for face in mesh.faces]).tolist()
    apart = Mesh(mesh.x[np.concatenate(mesh.faces)], [
        list(range(end - len(face), end)) for face, end in zip(mesh.faces, ends)])
    for name, data in (("soup.obj", obj(apart)), ("soup.ply", ply(apart, "<"))):
        add("unsewn", name, data, "coincide", must=False)
        add("unsewn", name, data, seams=1e-5)
    for name in ("BIG.OBJ", "two words.obj", "größe.obj", "服.obj", "a'b#%20.obj", "text.ply"):
        add("renamed", name, text)
    add("renamed", "rows.obj", rows)
    for name, data in (
        ("mark", b"\xef\xbb\xbf" + text.encode()), ("cr", text.replace("\n", "\r")),
        ("crlf", text.replace("\n", "\r\n")), ("tabs", text.replace(" ", "\t")),
        ("latin", ("# Größe\n" + text).encode("latin-1")),
        ("joined", text.replace("\nf 1 ", "\nf 1 \\\n"))
    ):
        add("encoded", name + ".obj", data)
    for code in ("utf-16", "utf-16-le", "utf-16-be", "utf-32"):
        add("encoded", code + ".obj", text.encode(code), "UTF-16")
    return found


def polygons() -> list[Variant]:
    ell = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
    comb = [(0, 0), (40, 0)] + [(40 - k, 2 - k % 2) for k in range(41)]
    turns = np.arange(20000) * np.pi / 10000
    found = []
    for name, places, area, said in (
        *((f"ell{k}", ell[k:] + ell[:k], 3, "") for k in range(6)), ("comb", comb, 60, ""),
        ("circle", list(zip(np.cos(turns), np.sin(turns))), np.pi, ""),
        ("bow", [(0, 0), (1, 1), (1, 0), (0, 1)], 0.5, "sides cross"),
        ("star", [ell[k] for k in (0, 2, 4, 1, 5)], 1, "sides cross")
    ):
        mesh = Mesh(np.array([(*place, 0) for place in places]), [list(range(len(places)))], area)
        for ending, data in ((".obj", obj(mesh)), (".ply", ply(mesh))):
            found.append(Variant("n-gon", name + ending, data, mesh, "", said))
    return found


class DamagedMeshes(ProgramCase):
    def setUp(self) -> None:
        super().setUp()
        for name, mesh in BASES.items():
            self.write(f"{name}.obj", obj(mesh, ".17g"))
            self.assert_holds(self.simulate(self.write(f"{name}.toml", CASE % f"{name}.obj"),
                                            "--set", f"cloth.move={MOVE.tolist()}"))

    def verdict(self, variant: Variant, command: str, words: list[str], wanted: float) -> str:
        """"right" or "refused", or what is wrong."""
        done = run(command.split()[0], *words, "--json")
        message = (done.stderr + done.stdout).replace(str(self.path), "")
        answer = json.loads(done.stdout) if done.stdout.strip() else None
        value = VALUES[command](answer, message) if answer else np.nan
        said = variant.said
        if command == "inspect" and variant.base in ("", "sheet"):  # no solids
            said = "|".join(filter(None, [said, "a hole", "coincide"]))
        if command == "compare" and said:  # a file cut before its faces is compared, and says so
            said += "|points without faces"
        is_named = bool(said and re.search(said, message.replace(variant.name, "")))
        if command == "compare" and answer and answer["difference"]:
            wanted = min(wanted, value)  # a surface is no farther than its vertices
        if abs(value - wanted) <= 6e-3 * abs(wanted):
            is_due = variant.kind == "unsewn" and not variant.seams and not is_named
            is_due = is_due or bool(variant.said and variant.must and not is_named)
            return f"SILENT: {message}" if is_due else "right"
        if is_named and (variant.name in message or value == value):
            return "refused"
        return (f"SILENT: {value}, not {wanted}: " if value == value else "MISLEADING: ") + message

    def verdicts(self, number: int, variant: Variant) -> dict[str, str]:
        folder, data, mesh = self.path / str(number), variant.data, variant.mesh
        folder.mkdir()
        (folder / variant.name).write_bytes(data.encode() if isinstance(data, str) else data)
        case = self.write(f"{number}.toml", CASE % f"{number}/{variant.name}")
        sew = ["--seams", str(variant.seams)] if variant.seams else []
        keys = ["--set", f"cloth.seams={variant.seams}"] if variant.seams else []
        file, (area, volume, _) = str(folder / variant.name), mesh.measured()
        commands = {
            "inspect": ([file, "--cells", "8", *sew], volume),
            "inspect --cloth": ([file, "--cloth", *sew], area), "crossings": ([file, *sew], 0),
            "simulate": ([case, "--threads", "1", "--out", str(folder / "out"), *keys], area)}
        if variant.base:
            stored = str(self.path / f"out/{variant.base}.h5")
            commands["compare"] = ([stored, str(folder), "--rate", "30", *sew],
                                   BASES[variant.base].rms(mesh.x - MOVE))
        return {f"{variant.kind}: {variant.base} {variant.name} [{command}]":
                self.verdict(variant, command, words, wanted)
                for command, (words, wanted) in commands.items()}

    def test_meshes_are_read_right_or_refused_by_their_cause(self) -> None:
        variants = [each for base in BASES.items() for each in variants_of(*base)] + polygons()
        self.assertGreaterEqual(len(variants), 200)
        with ThreadPoolExecutor(2) as pool:
            done = list(pool.map(self.verdicts, range(len(variants)), variants))
        found = [row for each in done for row in each.items()]
        counts = Counter(verdict.partition(":")[0] for _, verdict in found)
        print(f"\n{len(variants)} variants, {len(found)} answers: {dict(counts)}", flush=True)
        wrong = [f"{name}: {verdict}" for name, verdict in found if ":" in verdict]
        self.assertFalse(wrong, "\n".join(wrong))


if __name__ == "__main__":
    unittest.main()
