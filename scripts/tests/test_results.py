#!/usr/bin/python3
"""Tests of law sets, bundles and the pages of standing results, as users type them."""
from __future__ import annotations

import copy
import gzip
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from collections.abc import Callable
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "reports"))
from data.bundle import PARTS, Bundle, read_bundle, text_of  # noqa: E402
from standing.measured import (  # noqa: E402
    COLUMNS, COST_LAW, MESHES, PARAMETERS, by_mesh, columns_of, cost_rows
)

PROGRAM = ROOT / "build/foldproof"
TOY = f"/usr/bin/python3 {ROOT}/verification/subjects/adapters/toy_solver.py"
SET = "2026.1"
MOST_BYTES, MOST_SECONDS = 500_000, 20
LAW = "smoke.sheet-at-rest-stays"
MODULUS = "calibration.modulus-survives-refinement"
Parts = dict[str, Any]


def run(*words: str | Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([PROGRAM, *words], capture_output=True, text=True, check=False, cwd=ROOT)


def edited(edit: Callable[[Parts], Any]) -> Callable[[Parts], bytes]:
    """A bundle with consistent digests whose content is another."""
    def made(parts: Parts) -> bytes:
        edit(parts)
        return text_of(parts).encode()
    return made


def set_in(part: str, *way: Any) -> Callable[[Parts], bytes]:
    """way: keys, and the value last."""
    def edit(parts: Parts) -> None:
        inner = parts[part]
        for key in way[:-2]:
            inner = inner[key]
        inner[way[-2]] = way[-1]
    return edited(edit)


def text(parts: Parts) -> str:
    return text_of(parts)


# What is sent, and the words of the refusal.
HOSTILE: dict[str, tuple[Callable[[Parts], bytes], str]] = {
    "a name that leads out of the folder": (
        set_in("adapter", "file", "../../etc/passwd"), "no plain name of a file"),
    "an engine that is a path": (set_in("about", "engine", "a\0/../b"), "no plain name"),
    "an archive": (lambda p: b"PK\3\4" + bytes(99), "does not begin with '{'"),
    "a compressed bomb": (lambda p: gzip.compress(bytes(10**8)), "does not begin with '{'"),
    "more than fits": (lambda p: b"{" + b" " * 2_100_000, "is larger than"),
    "10^9 rows": (
        lambda p: b'{"laws":{' + b",".join(b'"%d":[]' % k for k in range(300_000)), "is larger"),
    "NaN": (lambda p: text(p).replace("null", "NaN", 1).encode(), "NaN, which is no number"),
    "a number beyond all": (
        lambda p: re.sub(r"(:\[\"holds\",)[^,]+", r"\g<1>1e999", text(p), count=1).encode(),
        "not finite"),
    "another law set": (set_in("about", "law_set", "2031.7"), "'2031.7' is not one of this"),
    "a law set that is a path": (set_in("about", "law_set", "../2026.1"), "is not one of this"),
    "an unknown field": (set_in("about", "score", 100), "unknown field 'score'"),
    "a field twice": (lambda p: text(p).replace("{", '{"bundle":1,', 1).encode(), "field twice"),
    "a law that is none": (set_in("laws", "a.b", ["holds", 0, 1, "", 1, ""]), "no law 'a.b'"),
    "a law left out": (
        edited(lambda p: p["laws"].pop(LAW)), f"lacks {LAW}, and 0 more"),
    "a number that does not hold": (set_in("laws", LAW, 1, 7e9), "holds, but 7000000000.0 is not"),
    "a row that is none": (set_in("laws", LAW, ["holds"]), "no row of outcome and five"),
    "a reference that fails": (
        set_in("yardstick", LAW, ["fails", 2, 1, "", 1, ""]), "does not hold " + LAW),
    "wider bounds": (set_in("yardstick", LAW, 2, 0.5), "has bound 0.5; the law set 0.01"),
    "no yardstick": (set_in("yardstick", LAW, None), "no row of outcome"),
    "another source": (set_in("adapter", "source", "print()"), "not that of its sha256"),
    "an integer beyond all": (
        lambda p: text(p).replace('"seed":0', f'"seed":{10**400}').encode(), "which is too large"),
    "a table with a short column": (
        set_in("evidence", "laws", MODULUS, [["a", "", [1]], ["b", "", []]]), "columns of one"),
    "a table of 10^4 cells": (
        set_in("evidence", "laws", MODULUS, [["a", "", [1] * 10**4]]), "columns of one"),
    "a text of a megabyte": (set_in("about", "mapping", {"a": "b" * 10**6}), "more than 400"),
    "ten thousand brackets": (lambda p: b'{"bundle":' + b"[" * 10**5, "nested too deeply"),
    "bytes that are no text": (lambda p: b"{\xff\xfe", "no UTF-8 text at byte 1"),
}


class Links(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.found: set[str] = set()
        self.ids: set[str] = set()

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        values = dict(attributes)
        self.ids.add(values.get("id") or "")
        if "href" in values or "src" in values:
            self.found.add(values.get("href") or values.get("src") or "")


class Results(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.TemporaryDirectory(prefix="foldproof results ")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        cls.file = cls.folder / "toy.bundle.json"
        cls.judged = run("judge", "--solver", TOY, "--laws", SET, "--out", cls.folder / "out",
                         "--bundle", cls.file)
        if not cls.file.is_file():
            raise AssertionError(cls.judged.stdout + cls.judged.stderr)
        whole = json.loads(cls.file.read_text())
        cls.parts = {name: whole[name] for name in PARTS}

    def setUp(self) -> None:
        self.bundle = Bundle(*copy.deepcopy(list(self.parts.values())))

    def add(self, content: bytes) -> subprocess.CompletedProcess[str]:
        sent = self.folder / "sent.json"
        sent.write_bytes(content)
        return run("results", "add", sent, "--in", self.folder / "kept")

    def test_the_law_set_is_as_frozen_and_alone_asked(self) -> None:
        self.assertRegex(self.judged.stdout, rf"laws {SET}: \d+ laws, as frozen")
        rows = (ROOT / f"verification/subjects/law_sets/{SET}.tsv").read_text().splitlines()
        self.assertEqual({row.split("\t")[0] for row in rows[1:]}, set(self.parts["laws"]))
        self.assertIn("known: 2026.1", run("judge", "--solver", TOY, "--laws", "1").stderr)

    def test_a_bundle_is_added_and_each_byte_of_it_counts(self) -> None:
        data = self.file.read_bytes()
        done = self.add(data)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("toy springs (Python) 1.0, submitted", done.stdout)
        other = self.folder / "altered.json"
        for at in range(0, len(data), max(1, len(data) // 997)):
            other.write_bytes(data[:at] + bytes([data[at] ^ 1]) + data[at + 1:])
            with self.assertRaisesRegex(Exception, "altered.json: ", msg=f"byte {at}"):
                read_bundle(other)
        done = self.add(data.replace(b'"holds"', b'"fails"', 1))
        self.assertIn("'laws' is not what its sha256 says: altered, or damaged", done.stderr)

    def test_hostile_bundles_end_in_one_line(self) -> None:
        for name, (made, words) in HOSTILE.items():
            with self.subTest(name):
                done = self.add(made(copy.deepcopy(self.parts)))
                self.assertEqual(done.returncode, 2, done.stdout)
                self.assertIn(words, done.stderr)
                self.assertLessEqual(len(done.stderr.splitlines()), 1)
                self.assertLess(len(done.stderr), 400)
        (self.folder / "link.json").symlink_to(self.file)
        done = run("results", "add", self.folder / "link.json", "--in", self.folder / "kept")
        self.assertIn("is no file of its own", done.stderr)

    def test_a_second_run_that_agrees_makes_a_re_run(self) -> None:
        again = copy.deepcopy(self.parts)
        again["about"]["date"] = "2030-01-01T00:00:00Z"
        for row in again["laws"].values():
            row[4] = row[4] * 1.1
        again["laws"]["cost.growth-is-below-quadratic"][1] *= 0.7
        worse = copy.deepcopy(again)
        row = worse["laws"]["gravity.speed-grows-by-g-t"]
        row[1] = 0.9 * row[2]
        stands = ((again, ["re-run"]), (worse, ["submitted"] * 2), (self.parts, ["submitted"] * 2))
        for second, wanted in stands:
            folder = self.folder / "two"
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir()
            (folder / "a.json").write_text(text_of(self.parts))
            (folder / "b.json").write_text(text_of(second))
            self.assertEqual(run("results", "site", folder / "pages", "--in", folder).returncode, 0)
            rows = json.loads((folder / "pages/results.json").read_text())["runs"]
            self.assertEqual([row["status"] for row in rows], wanted)

    def test_moduli_by_mesh_are_over_those_of_the_scene(self) -> None:
        bundle = read_bundle(ROOT / "reports/standing/jolt-1.1.0.json")
        for parameter, law, name in zip(
                PARAMETERS, ("young-s-modulus", "bending-rigidity"),
                ("Young's modulus", "bending rigidity")):
            table = columns_of(bundle, f"calibration.{law}-is-the-scene-s")
            for value, differs in zip(table[name], table["difference from the scene's"]):
                self.assertAlmostEqual(abs(value / parameter.scale - 1), differs, places=4)
            cells = by_mesh(bundle, parameter)
            self.assertEqual(len(cells), len(MESHES) * len(COLUMNS))
            self.assertTrue(all(0.5 < cell < 1.5 for cell in cells), cells)

    def test_cost_is_in_steps_of_the_reference(self) -> None:
        ratios = [cost / steps for steps, _, _, cost in cost_rows(self.bundle, "yardstick")]
        self.assertAlmostEqual(min(ratios), 1)  # of the reference itself
        _, _, seconds, cost = cost_rows(self.bundle, "yardstick")[0]
        mine = cost_rows(self.bundle)[0]
        self.assertAlmostEqual(mine[3] / mine[2] * seconds / cost, 1)
        self.bundle.laws[COST_LAW][0] = "fails"
        self.assertEqual(cost_rows(self.bundle), [])

    def test_ten_runs_become_pages_in_time(self) -> None:
        many = self.folder / "many"
        many.mkdir()
        for k in range(10):
            parts = copy.deepcopy(self.parts)
            parts["about"] |= {"engine": f"engine {k // 4}", "version": f"1.{k % 4}"}
            parts["laws"][LAW] = ["fails", 3.0 + k, 0.01, "m", 1.0, "<script>alert(1)</script>"]
            (many / f"{k}.json").write_text(text_of(parts))
        begin = time.monotonic()
        done = run("results", "site", many / "pages", "--in", many)
        self.assertEqual(done.returncode, 0, done.stderr)
        seconds = time.monotonic() - begin
        self.assertLess(seconds, MOST_SECONDS)
        pages = {file.name: file.read_text() for file in (many / "pages").glob("*.html")}
        print(f"{len(pages)} pages in {seconds:.1f} s, the largest of "
              f"{max(map(len, pages.values()))} bytes")
        self.check_pages(many / "pages", pages)

    def check_pages(self, folder: Path, pages: dict[str, str]) -> None:
        read: dict[str, Links] = {}
        for name, page in pages.items():
            read[name] = Links()
            read[name].feed(page)
        for name, page in pages.items():
            self.assertLess(len(page.encode()), MOST_BYTES, name)
            self.assertNotIn("<script>", page, name)
            for link in read[name].found:
                self.assertNotRegex(link, "^[a-z]+:", name)
                file, _, anchor = link.partition("#")
                self.assertTrue((folder / (file or name)).is_file(), f"{name}: {link}")
                if anchor:
                    self.assertIn(anchor, read[file or name].ids, name)

    def test_shipped_bundles_have_pages_and_the_picture_of_the_readme(self) -> None:
        pages = self.folder / "shipped"
        done = run("results", "site", pages)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.check_pages(pages, {file.name: file.read_text() for file in pages.glob("*.html")})
        table = (pages / "table.svg").read_text()
        self.assertEqual(table, (ROOT / "reports/standing/table.svg").read_text(),
                         "type: scripts/record_standing --picture")
        self.assertLess(len(table), 60_000)
        linked = {page for file in pages.glob("run-*.html")
                  for page in re.findall(r'shown by <a href="([^"]*)', file.read_text())}
        self.assertGreaterEqual(len(linked), 2, "no failure names the script that shows it")


class TheirCi(unittest.TestCase):
    """verification/subjects/judge.yml, on an adapter of ours."""

    def step(self, name: str, folder: Path) -> int:
        lines = (ROOT / "verification/subjects/judge.yml").read_text().split(f"- name: {name}\n")[1]
        block = lines.split("        run: |\n")[1].split("      - ")[0]
        words = block.replace("--baseline", "gravity --baseline")  # some laws are enough
        path = f"{PROGRAM.parent}:{os.environ['PATH']}"
        done = subprocess.run(["bash", "-e", "-c", words], cwd=folder, capture_output=True,
                              env={**os.environ, "SOLVER": TOY, "PATH": path}, check=False)
        return done.returncode

    def test_the_job_comments_with_what_changed(self) -> None:
        with tempfile.TemporaryDirectory() as scratch:
            folder = Path(scratch)
            run("judge", "--solver", TOY, "gravity", "--out", folder / "kept")
            kept = json.loads((folder / "kept/verdicts.json").read_text())
            baseline = folder / "baseline.json"
            baseline.write_text(json.dumps(kept))
            self.assertEqual(self.step("judge", folder), 0)
            rows = {row["name"]: row for row in kept["findings"]}
            rows["gravity.speed-grows-by-g-t"] |= {"outcome": "fails", "measured": 9.0}
            rows["gravity.is-that-of-the-scene"]["name"] = "gravity.of-old"
            baseline.write_text(json.dumps(kept))
            self.step("judge", folder)
            self.assertEqual(self.step("table", folder), 0)
            table = (folder / "changes.md").read_text()
            self.assertIn("| better | `gravity.speed-grows-by-g-t` | holds | fails, ", table)
            self.assertIn("| `gravity.is-that-of-the-scene` | holds | |", table)
            self.assertIn("\n0 worse, 1 better", table)


@unittest.skipUnless(shutil.which("chromium"), "no chromium: the package chromium has it")
class Browsed(unittest.TestCase):
    def test_pages_fit_a_telephone_and_every_link_is_reached_by_keys(self) -> None:
        from pages.chromium import Browser
        browser = Browser()
        self.addCleanup(browser.close)
        with tempfile.TemporaryDirectory() as scratch:
            run("results", "site", scratch)
            for page in sorted(Path(scratch).glob("*.html"))[:12]:
                browser.open(page, width=400)
                wide = browser.evaluate("document.documentElement.scrollWidth")
                self.assertLessEqual(wide, 400, page.name)
                links = browser.evaluate("document.querySelectorAll('a[href], summary').length")
                reached = browser.evaluate(
                    "[...document.querySelectorAll('a[href], summary, .scroll')]"
                    ".filter((one) => one.tabIndex >= 0).length")
                self.assertGreaterEqual(reached, links, page.name)
            self.assertEqual(browser.complaints, [])
            self.assertTrue(all(one.startswith("file:") for one in browser.requests))


if __name__ == "__main__":
    unittest.main()
