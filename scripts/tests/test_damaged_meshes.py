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

CASE = """[cloth]
mesh = "%s"
density = 1
[stretch]
stiffness = 100
[time]
end = 1e-6
step = 1e-6
"""
MOVE = np.array([0, 0, 0.25])  # of the run that is compared [m]
FORMS = ("ascii", "binary_little_endian", "binary_big_endian")
COUNTS = "ends before|behind the last|fit the file|by the header"


class Mesh(NamedTuple):
    x: np.ndarray           # N x 3 [m]
    faces: list[list[int]]  # polygons, from 0
    area: float = 0         # of a concave polygon [m^2]
    is_closed: bool = True


BASES = {
    "sheet": Mesh(np.array([(0.2 * i, 0.2 * j, 0) for j in range(5) for i in range(7)]),
                  [[k, k + 1, k + 8, k + 7] for k in range(28) if k % 7 < 6], is_closed=False),
    "box": Mesh(np.array([(i, 0.6 * j, 0.4 * k) for k in (0, 1)
                          for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))]),
                [[3, 2, 1, 0], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6],
                 [3, 0, 4, 7]]),
    "pyramid": Mesh(np.array([(0, 0, 0), (1, 0, 0), (1.3, 0.9, 0), (0.1, 1.1, 0), (0.4, 0.5, 0.8)]),
                    [[3, 2, 1, 0], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])}


def triangles(mesh: Mesh) -> np.ndarray:
    return np.array([(face[0], *two) for face in mesh.faces for two in zip(face[1:], face[2:])])


def areas(mesh: Mesh) -> np.ndarray:
    a, b, c = mesh.x[triangles(mesh)].transpose(1, 0, 2)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def volume(mesh: Mesh) -> float:
    a, b, c = mesh.x[triangles(mesh)].transpose(1, 0, 2)
    return np.einsum("ij,ij", a, np.cross(b, c)) / 6


def rms(mesh: Mesh, places: np.ndarray) -> float:
    """Of the vertices' distances from these places, weighted with the areas around them [m]."""
    weights = np.zeros(len(mesh.x))
    np.add.at(weights, triangles(mesh), areas(mesh)[:, None])
    return np.sqrt(weights @ ((places - mesh.x) ** 2).sum(axis=1) / weights.sum())


def obj(mesh: Mesh, form: str = ".9g") -> str:
    return "# by hand\n" + "".join(
        "v " + " ".join(format(c, form) for c in place) + "\n" for place in mesh.x.tolist()
    ) + "".join("f " + " ".join(str(v + 1) for v in face) + "\n" for face in mesh.faces)


def ply(mesh: Mesh, form: str = "ascii", more: tuple[int, int] = (0, 0)) -> bytes:
    """more: vertices and faces that the header counts beyond those of the file."""
    axes = "".join(f"property float {axis}\n" for axis in "xyz")
    head = (f"ply\nformat {form} 1.0\nelement vertex {len(mesh.x) + more[0]}\n{axes}"
            f"element face {len(mesh.faces) + more[1]}\nproperty list int int vertex_indices\n"
            "end_header\n").encode()
    if form == "ascii":
        rows = [[format(c, ".9g") for c in place] for place in mesh.x.tolist()]
        rows += [[str(v) for v in (len(face), *face)] for face in mesh.faces]
        return head + "".join(" ".join(row) + "\n" for row in rows).encode()
    order = ">" if "big" in form else "<"
    return head + mesh.x.astype(order + "f4").tobytes() + b"".join(
        struct.pack(f"{order}{1 + len(face)}i", len(face), *face) for face in mesh.faces)


class Variant(NamedTuple):
    kind: str
    name: str         # of the file
    data: str | bytes
    mesh: Mesh        # what it holds
    base: str         # what it was made of; "": none
    said: str = ""    # of the cause of a refusal or warning; "": neither
    must: bool = True  # be refused, if anything is said
    seams: float = 0  # [m]


def variants_of(base: str, mesh: Mesh) -> list[Variant]:
    text, rows, found = obj(mesh), ply(mesh), []
    second = text.split("\n")[2]

    def add(kind: str, name: str, data: str | bytes, said: str = "", must: bool = True,
            of: Mesh = mesh, seams: float = 0) -> None:
        found.append(Variant(kind, name, data, of, base, said, must, seams))

    for form in ("+.9g", ".9e", ".40f"):
        add("numbers", "form.obj", obj(mesh, form))
    for number, said in (
        ("nan", "finite"), ("inf", "finite"), ("-nan(ind)", "finite"), ("1e160", "too large"),
        ("-3e99", "too large"), ("1e400", "fit a double"), ("0x1p0", "not a number"),
        ("1,5", "not a number"), ("1_0", "not a number"), ("1d0", "not a number"),
        ("1.#QNAN", "not a number"), ("O", "not a number"), ("--1", "not a number")
    ):
        add("numbers", "one.obj", text.replace(second, f"v {number} 0 0", 1), said)
        add("numbers", "one.ply", rows.replace(b"header\n0", b"header\n" + number.encode()), said)
    for scale, said in ((1e-3, ""), (39.37, ""), (1e3, ""), (1e160, "too large"),
                        (1e-170, "areas would vanish")):
        large = mesh._replace(x=mesh.x * scale)
        add("scaled", "units.obj", obj(large), said, of=mesh if said else large)
    for form in FORMS:
        whole = ply(mesh, form)
        start = whole.index(b"end_header") + 11
        add("binary", "whole.ply", whole)
        add("binary", "behind.ply", whole + b"7 7\n", COUNTS)
        for k in range(1, 5):
            add("binary", "cut.ply", whole[:start + (len(whole) - start) * k // 5], COUNTS)
        for more in ((1, 0), (-1, 0), (3, 0), (0, 1), (0, -1)):
            add("binary", "counts.ply", ply(mesh, form, more), COUNTS)
    for k in range(1, 5):
        add("damaged", "cut.obj", text[:text.index("f") * k // 4], "no face|without|numbers")
    for name, data, said in (
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
    for face in (mesh.faces[0][:3], mesh.faces[0][2::-1]):
        add("damaged", "twice.obj", obj(mesh._replace(faces=mesh.faces + [face])),
            "given twice|three triangles", must=False)
    add("damaged", "all_twice.obj", obj(mesh._replace(faces=mesh.faces * 2)), "given twice",
        must=False)
    add("damaged", "line.obj", text + "f 1 2 2\n", "no area|without area", must=False)
    add("damaged", "unused.obj", text + "v 9 9 9\n", "in no triangle", must=False)
    turned = [face[::-1] for face in mesh.faces]
    add("inverted", "whole.obj", obj(mesh._replace(faces=turned)), "inside out", must=False)
    add("inverted", "face.ply", ply(mesh._replace(faces=turned[:1] + mesh.faces[1:])),
        "opposite orientation", must=False)
    ends = np.cumsum([len(face) for face in mesh.faces]).tolist()
    apart = mesh._replace(x=mesh.x[np.concatenate(mesh.faces)], faces=[
        list(range(end - len(face), end)) for face, end in zip(mesh.faces, ends)])
    for name, data in (("soup.obj", obj(apart)), ("soup.ply", ply(apart, FORMS[1]))):
        add("unsewn", name, data, "coincide", must=False)
        add("unsewn", name, data, seams=1e-5)
    for name in ("BIG.OBJ", "two words.obj", "größe.obj", "服.obj", "a'b#%20.obj", "text.ply"):
        add("renamed", name, text)
    add("renamed", "rows.obj", rows)
    for name, data in (
        ("mark", b"\xef\xbb\xbf" + text.encode()), ("cr", text.replace("\n", "\r")),
        ("crlf", text.replace("\n", "\r\n")), ("tabs", text.replace(" ", "\t")),
        ("latin", ("# Größe\n" + text).encode("latin-1")),
        ("joined", text.replace("\nf 1 ", "\nf 1 \\\n")),
        ("sorted", "\n".join(sorted(text.split("\n"), key=lambda line: line[:1] != "f")))
    ):
        add("encoded", name + ".obj", data)
    for code in ("utf-16", "utf-16-le", "utf-16-be", "utf-32"):
        add("encoded", code + ".obj", text.encode(code), "UTF-16")
    return found


def polygons() -> list[Variant]:
    ell = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
    comb = [(0, 0), (40, 0)] + [(40 - k, 2 - k % 2) for k in range(41)]
    turns = np.arange(20000) * np.pi / 10000
    shapes = [(f"ell{k}", ell[k:] + ell[:k], 3.0, "") for k in range(6)]
    shapes += [("comb", comb, 60.0, ""), ("circle", list(zip(np.cos(turns), np.sin(turns))), np.pi, ""),
               ("bow", [(0, 0), (1, 1), (1, 0), (0, 1)], 0.5, "sides cross"),
               ("star", [ell[k] for k in (0, 2, 4, 1, 5)], 1, "sides cross")]
    found = []
    for name, places, area, said in shapes:
        mesh = Mesh(np.array([(*place, 0) for place in places]), [list(range(len(places)))], area,
                    False)
        found += [Variant("n-gon", name + ".obj", obj(mesh), mesh, "", said),
                  Variant("n-gon", name + ".ply", ply(mesh), mesh, "", said)]
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
        done = run(*words, "--json")
        answer = json.loads(done.stdout) if done.stdout.strip() else {}
        message, value = done.stderr, np.nan
        if command == "simulate" and done.returncode != 2:
            value = float(re.search(r"([0-9.e+-]+) kg", message)[1])
        elif command == "inspect" and answer:
            message += answer["refusal"]
            value = np.nan if answer["refusal"] else answer["volume"]
        elif command == "inspect --cloth" and answer:
            message, value = message + answer["open_seams"], answer["area"]
        elif command == "crossings" and answer:
            value = answer[0]["pairs"] + answer[0]["repeated_faces"]
        elif command == "compare" and answer:
            message += answer["difference"] + answer["seams"]
            value = answer["frames"][0]["rms"]
            if answer["difference"] and answer["matching"] == "by nearest points":
                wanted = min(wanted, value)  # a surface is no farther than its vertices
        said = variant.said
        if command == "inspect" and not variant.mesh.is_closed:
            said = "|".join(filter(None, [said, "hole", "coincide"]))
        is_named = bool(said and re.search(said, message.replace(variant.name, "")))
        near = 6e-3 if command == "simulate" else 1e-5
        if abs(value - wanted) <= near * abs(wanted):
            if variant.said and variant.must:
                return f"SILENT: {value}: {message}"
            is_told = is_named or variant.kind != "unsewn" or variant.seams
            return "right" if is_told else f"SILENT: {message}"
        if is_named and (variant.name in message or value == value):
            return "refused"
        return (f"SILENT: {value}, not {wanted}: " if value == value else "MISLEADING: ") + message

    def verdicts(self, number: int, variant: Variant) -> dict[str, str]:
        folder = self.path / str(number)
        folder.mkdir()
        data = variant.data
        (folder / variant.name).write_bytes(data.encode() if isinstance(data, str) else data)
        mesh, base = variant.mesh, BASES.get(variant.base)
        case = self.write(f"{number}.toml", CASE % f"{number}/{variant.name}")
        sew = ["--seams", str(variant.seams)] if variant.seams else []
        keys = ["--set", f"cloth.seams={variant.seams}"] if variant.seams else []
        file, area = str(folder / variant.name), mesh.area or areas(mesh).sum()
        commands = [
            ("inspect", [file, "--cells", "8", *sew], volume(mesh)),
            ("inspect --cloth", [file, *sew], area), ("crossings", [file, *sew], 0),
            ("simulate", [case, "--threads", "1", "--out", str(folder / "out"), *keys], area)]
        if base:
            stored = str(self.path / f"out/{variant.base}.h5")
            commands.append(("compare", [stored, str(folder), "--rate", "30", *sew],
                             rms(base, mesh.x - MOVE)))
        return {f"{variant.kind}: {variant.base} {variant.name} [{command}]":
                self.verdict(variant, command, [*command.split(), *words], wanted)
                for command, words, wanted in commands}

    def test_meshes_are_read_right_or_refused_by_their_cause(self) -> None:
        variants = [variant for base in BASES.items() for variant in variants_of(*base)]
        variants += polygons()
        self.assertGreaterEqual(len(variants), 200)
        with ThreadPoolExecutor(2) as pool:
            done = list(pool.map(self.verdicts, range(len(variants)), variants))
        found = [(name, verdict) for each in done for name, verdict in each.items()]
        counts = Counter(verdict.partition(":")[0] for _, verdict in found)
        print(f"\n{len(variants)} variants, {len(found)} answers: {dict(counts)}", flush=True)
        wrong = [f"{name}: {verdict}" for name, verdict in found if ":" in verdict]
        self.assertFalse(wrong, "\n".join(wrong))


if __name__ == "__main__":
    unittest.main()
