#!/usr/bin/python3
"""Tests that nothing is trusted: damaged files, input without end, names that lead elsewhere."""

import json
import os
import random
import re
import resource
import shutil
import subprocess
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import h5py

from file_tests import LED_CASE, SEED, SMALL_CASE, TRIANGLES, FileTest, content_of
from program_case import CLOCK, PROGRAM, ROOT, run, run_until


def damage(content: bytes, chance: random.Random) -> bytes:
    """The bytes cut off somewhere, or with some flipped, zeroed or turned into the largest number;
    structures, which lie at the start of an HDF5 file, are hit as often as data."""
    if chance.random() < 0.25:
        return content[:chance.randrange(len(content))]
    result = bytearray(content)
    reach = len(content) if chance.random() < 0.5 else min(len(content), 6000)
    for _ in range(chance.choice((1, 1, 2, 5, 20))):
        at = chance.randrange(reach)
        kind = chance.randrange(3)
        if kind == 0:
            result[at] ^= 1 << chance.randrange(8)
        else:
            result[at:at + 8] = (b"\x00" if kind == 1 else b"\xff") * len(result[at:at + 8])
    return bytes(result)


class DamagedFiles(FileTest):
    """HDF5 files with flipped bytes or cut short: an error or an answer, never a crash or a
    hang."""

    TRIALS = 100

    def judge(self, done: subprocess.CompletedProcess[str], number: int) -> int:
        self.assertIn(done.returncode, (0, 1, 2), f"damage {number}: {done.stderr[-300:]}")
        if done.returncode == 2:
            self.assertTrue(done.stderr.strip())
            self.assertLess(len(done.stderr.strip().splitlines()[-1]), 2000)
        return done.returncode

    def trials(self, source: Path, target: Path, count: int, *commands: list[str]) -> None:
        chance = random.Random(SEED)
        content, refused = source.read_bytes(), 0
        for number in range(count):
            target.write_bytes(damage(content, chance))
            for command in commands:
                done = run(*command, limits={resource.RLIMIT_CORE: 0})
                refused += self.judge(done, number) == 2
        print(f"\n{source.name}: {count} damages, {count * len(commands)} commands, {refused}"
              " refused, the others answered", flush=True)

    def store_small_run(self) -> Path:
        self.assert_holds(self.simulate(self.write("small.toml", SMALL_CASE)))
        return self.path / "out/small.h5"

    def test_stored_runs(self) -> None:
        hurt = str(self.path / "hurt.h5")
        project = ["project", hurt, "--map", "plain", "--tau", "0.01", "--out", self.out]
        self.trials(self.store_small_run(), Path(hurt), self.TRIALS, ["crossings", hurt], project)

    def test_runs_and_cases_in_reports(self) -> None:
        first = self.store_small_run().parent
        self.assert_holds(run("check", "bending.forces-sum-to-zero", "--out", first))
        for name in ("run.h5", "small.h5"):
            out = self.path / f"of {name}"
            out.mkdir()
            self.trials(first / name, out / name, self.TRIALS // 20, ["report", str(out)])

    def test_level_sets_that_are_kept(self) -> None:
        shutil.copy(ROOT / "cases/statue.ply", self.path)
        case = self.write("draped.toml", (ROOT / "cases/drape_statue.toml").read_text())
        command = ["simulate", case, "--set", "time.end=0.001", "--set", "object.cells=10",
                   "--cache", str(self.path / "kept"), "--out", self.out]
        self.assertIn(run(*command).returncode, (0, 1))
        kept = next((self.path / "kept").iterdir())
        whole = content_of(self.path / "out/draped.h5")
        source = Path(shutil.copy(kept, self.path / "source.h5"))
        self.trials(source, kept, self.TRIALS // 5, command)
        self.assertEqual(content_of(self.path / "out/draped.h5"), whole)

    def test_checkpoints(self) -> None:
        case, out = self.write("led.toml", LED_CASE), self.path / "out"
        run_until(lambda _: (out / "led.checkpoints/000020.h5").exists(), "simulate", case, "--out",
                  out)
        shutil.copytree(out, self.path / "source")
        chance, content = random.Random(SEED), None
        for number in range(self.TRIALS // 10):
            shutil.rmtree(out)
            shutil.copytree(self.path / "source", out)
            hurt = out / f"led.checkpoints/{chance.randrange(21):06}.h5"
            hurt.write_bytes(damage(hurt.read_bytes(), chance))
            self.assertEqual(self.judge(self.simulate(case, "--resume"), number), 0)
            content = content or content_of(out / "led.h5")
            self.assertEqual(content_of(out / "led.h5"), content)


class Limits(FileTest):
    """Input without end is refused soon, in bounded memory, with file and line."""

    MOST = 2 << 30  # bytes of address space

    def assert_soon(self, words: str, file: str, *mentions: str) -> None:
        """The command with this file is refused soon, with a mention of the file by default."""
        start = os.times()
        done = run(*words.split(), file,
                   limits={resource.RLIMIT_AS: self.MOST, resource.RLIMIT_CORE: 0})
        end = os.times()
        self.assert_refused(done, *(mentions or [file]))
        self.assertLess(end.children_user + end.children_system
                        - start.children_user - start.children_system, 20)

    def long_file(self, name: str, line: bytes, lines: int, first: bytes = b"") -> str:
        with open(self.path / name, "wb") as file:
            file.write(first)
            for _ in range(lines // 10000):
                file.write(line * 10000)
        return str(self.path / name)

    def test_a_case_of_100_megabytes(self) -> None:
        case = self.long_file("huge.toml", b"# nothing\n", 10_000_000)
        self.assert_soon("simulate", case, "huge.toml", "1048576 bytes")
        case = self.write("wide.toml", "# " + "x" * 70000 + "\n")
        self.assert_soon("simulate", case, "wide.toml:1", "65536 bytes")

    def test_a_case_nested_without_end(self) -> None:
        for text in (
            "a" + ".a" * 30000 + " = 1\n", "a = " + "[" * 60000 + "\n",
            "a = " + "{b = " * 12000 + "\n", "[a" + ".a" * 30000 + "]\n",
            "x = [ \"\"\"\n\"\"\", {" + '",".' * 12000 + "a = 1, b = \"\" } ]\n",
            "1.1" + " . 1.1" * 9000 + " = 1\n",
            "[a" + ".a" * 2000 + "]\nb" + ".b" * 2000 + " = 1\nx\n"
        ):
            with self.subTest(text[:20]):
                self.assert_soon("simulate", self.write("nested.toml", text), "nested.toml")

    def test_a_mesh_of_ten_million_faces(self) -> None:
        mesh = self.long_file("faces.obj", b"f 1 2 3\n", 10_000_000, b"v 0 0 0\nv 1 0 0\nv 0 1 0\n")
        self.assert_soon("inspect", mesh, "faces.obj:4000004", "more than 4000000 triangles")
        self.assert_soon("crossings", mesh, "faces.obj:4000004")
        vertices = self.long_file("vertices.obj", b"v 0 0 0\n", 3_000_000)
        self.assert_soon("inspect", vertices, "vertices.obj:2000001", "more than 2000000 vertices")
        fan = self.write("fan.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf " + "1 2 3 \\\n" * 1_500_000)
        self.assert_soon("inspect", fan, "fan.obj", "more than 4000000 triangles")

    def test_lines_rows_and_groups_without_end(self) -> None:
        names = " ".join(f"g{k}" for k in range(40))
        self.assert_soon("inspect", self.write("groups.obj", f"g {names}\n{TRIANGLES}"),
                         "groups.obj:1", "16 names of groups")
        mesh = self.long_file("endless.obj", b"1.0 " * 10, 2_500_000, b"\n")
        self.assert_soon("inspect", mesh, "endless.obj", "without a record v or f")
        table = self.path / "endless.csv"
        os.link(mesh, table)
        for kind in ("bending", "crossings --kind edge-edge"):
            self.assert_soon(f"evaluate {kind}", str(table), "endless.csv:2", "65536 bytes")
        big = self.long_file("big.obj", b"# " + b"x" * 998 + b"\n", 300_000)
        self.assert_soon("inspect", big, "big.obj", "268435456 bytes")
        row = b"1,2,3,4,5,6,7,8,9,1,2,3,1,2,3,1,2,3,1,2,3,1,2,3,1,2,3\n"
        table = self.long_file("rows.csv", row, 1_010_000)
        self.assert_soon("evaluate bending", table, "rows.csv:1000001", "1000000 rows")

    def test_what_is_no_file(self) -> None:
        os.mkfifo(self.path / "pipe.obj")
        for name in ("/dev/zero", str(self.path / "pipe.obj"), str(self.path)):
            for words in ("inspect", "evaluate bending", "simulate"):
                self.assert_soon(words, name)
            self.assert_soon("simulate any_mesh --set", f"cloth.mesh={name}", name)


class Names(FileTest):
    """Names lead nowhere but where they seem to, and say nothing but themselves."""

    def test_names_of_cases_are_plain(self) -> None:
        for name in ("two words", "caf\u00e9", ".hidden", "-option", "dots..twice", "new\nline",
                     "tab\there", "<b>", "quo'te", "x" * 101):
            with self.subTest(name=name):
                self.assert_refused(self.simulate(self.write(f"{name}.toml", SMALL_CASE)),
                                    "a case is named after its file")
        self.assertFalse((self.path / "out").exists() and list((self.path / "out").iterdir()))
        for name in ("a", "x" * 100, "Case_1.2-b"):
            self.assert_holds(self.simulate(self.write(f"{name}.toml", SMALL_CASE)))

    def test_a_stored_name_leads_nowhere(self) -> None:
        self.assert_holds(self.simulate(self.write("small.toml", SMALL_CASE)))
        stored, projected = self.path / "out/small.h5", self.path / "projected"
        for name in ("../../escaped", "/tmp/escaped", "", "..", "a/../../b"):
            with h5py.File(stored, "r+") as file:
                file.attrs["case_name"] = name
            done = run("project", stored, "--map", "plain", "--tau", "0.01", "--out", projected)
            if done.returncode != 2:
                self.assertEqual({path.parent for path in self.path.rglob("*_projected.h5")},
                                 {projected})
        self.assertFalse(list(self.path.parent.glob("escaped*")))

    def case_with_mesh(self, mesh: str) -> str:
        text = f'[cloth]\nmesh = "{mesh}"\ndensity = 0.1\n[time]\nend = 0.001\n'
        return self.write("case/own.toml", text)

    def test_meshes_lie_beside_their_case_or_below(self) -> None:
        outside = self.write("outside.obj", TRIANGLES)
        self.write("case/beside.obj", TRIANGLES)
        self.write("case/sub/below.obj", TRIANGLES)
        (self.path / "case/inner.obj").symlink_to("sub/below.obj")
        (self.path / "case/outer.obj").symlink_to(outside)
        (self.path / "case/up").symlink_to("..")
        for mesh in ("beside.obj", "sub/below.obj", "inner.obj", "./beside.obj"):
            self.assert_holds(self.simulate(self.case_with_mesh(mesh)))
        for mesh in (outside, "../outside.obj", "sub/../beside.obj", "outer.obj", "up/outside.obj",
                     "/etc/passwd", ".."):
            with self.subTest(mesh=mesh):
                self.assert_refused(self.simulate(self.case_with_mesh(mesh)), "own.toml:2",
                                    "case file's folder", "--set")
        self.assert_refused(self.simulate(self.case_with_mesh("none.obj")),
                            "there is no mesh file")
        self.assert_holds(self.simulate(self.case_with_mesh("beside.obj"), "--set",
                                        f"cloth.mesh={outside}"))

    def test_animations_too(self) -> None:
        shutil.copy(ROOT / "cases/skirt.obj", self.path / "outside.obj")
        for name in ("frames", "case/linked"):
            (self.path / name).mkdir(parents=True)
        (self.path / "case/linked/0.obj").symlink_to(self.path / "outside.obj")
        for frames in ("../frames", str(self.path / "frames"), "linked"):
            text = SMALL_CASE + f'[[object]]\nframes = "{frames}"\n'
            self.assert_refused(self.simulate(self.write("case/own.toml", text)),
                                "case file's folder")

    def test_what_is_printed_and_written_is_valid_whatever_the_names(self) -> None:
        out = os.fsencode(self.path) + b"/out \xff\xfe<&\"'>\x01"
        printed = self.output_of(b"check", b"bending.forces-sum-to-zero", b"--json", b"--out",
                                 out).decode("utf-8")  # strictly
        self.assertIn("\ufffd", json.loads(printed)["program"]["command"])
        with open(out + b"/verdicts.json", "rb") as file:
            self.assertEqual(json.loads(file.read().decode("utf-8")), json.loads(printed))
        ElementTree.parse(out + b"/junit.xml")
        case, scene = self.write("small.toml", SMALL_CASE), out + b"/scene"
        printed = self.output_of(b"simulate", os.fsencode(case), b"--json", b"--out", scene)
        json.loads(printed.decode("utf-8"))
        ElementTree.parse(scene + b"/small.xdmf")
        for folder in (out, scene):
            self.output_of(b"report", folder)
            page = Path(os.fsdecode(folder + b"/report.html")).read_bytes().decode("utf-8")
            self.assertIsNone(re.search("[\x00-\x08\x0b\x0c\x0e-\x1f]", page))
        self.assertTrue("Small &lt;script&gt;alert(1)&lt;/script&gt; &amp; &#39;one&#39;" in page,
                        "the title is not on the page")
        self.assertTrue("<script>alert" not in page and "<b>\ufffdball" not in page,
                        "a name of the case is code on the page")

    def output_of(self, *arguments: bytes) -> bytes:
        """Of a command of any bytes, with exit code 0."""
        done = subprocess.run([str(PROGRAM).encode(), *arguments], capture_output=True,
                              timeout=CLOCK, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout


if __name__ == "__main__":
    unittest.main()
