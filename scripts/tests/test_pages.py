#!/usr/bin/python3
"""The pages of the project (*.md): short enough to read, linked to what exists, and
complete on the keys of cases.

Usage: scripts/tests/test_pages.py
"""
from __future__ import annotations

import re
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGES = sorted(page for page in ROOT.rglob("*.md")
               if "build" not in page.relative_to(ROOT).parts[0])
FENCE = re.compile(r"^```.*?^```$", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\(([^)\s]*)\)")


def prose_of(text: str) -> str:
    """The text with the content of its code blocks left out, line by line."""
    return FENCE.sub(lambda block: "\n" * block.group().count("\n"), text)


def anchors_of(text: str) -> set[str]:
    """Valid link anchors for the headings of the page."""
    headings = re.findall(r"^#+ (.*)$", prose_of(text), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


class Pages(unittest.TestCase):
    """Every page."""

    def test_lines_of_prose_end_at_100_and_rows_of_tables_at_160(self) -> None:
        for page in PAGES:
            text = prose_of(page.read_text(encoding="utf-8"))
            for number, line in enumerate(text.splitlines(), 1):
                if "http" not in line:
                    width = 160 if line.startswith("|") else 100
                    self.assertLessEqual(len(line), width, f"{page.relative_to(ROOT)}:{number}")

    def test_a_readme_is_one_page(self) -> None:
        for page in PAGES:
            if page.name == "README.md":
                text = page.read_text(encoding="utf-8")
                most, words = 650 if page.parent == ROOT else 450, re.findall(r"\S*\w\S*", text)
                self.assertLessEqual(len(text.splitlines()), 60, page.relative_to(ROOT))
                self.assertLessEqual(len(words), most, page.relative_to(ROOT))

    def test_links_lead_to_files_and_headings_that_exist(self) -> None:
        for page in PAGES:
            for link in LINK.findall(prose_of(page.read_text(encoding="utf-8"))):
                if link.startswith("http"):
                    continue
                path, _, anchor = link.partition("#")
                target = page.parent / path if path else page
                self.assertTrue(target.exists(), f"{page.relative_to(ROOT)}: {link}")
                if anchor:
                    text = target.read_text(encoding="utf-8")
                    self.assertIn(anchor, anchors_of(text), f"{page.relative_to(ROOT)}: {link}")

    def test_files_that_are_named_exist(self) -> None:
        folders = "reference|verification|convergence|cases|reports|scripts"
        named = re.compile(rf"`((?:{folders})/[\w/.]*\w\.(?:cpp|h|py|toml|json|md|obj|csv))`")
        for page in PAGES:
            for name in named.findall(prose_of(page.read_text(encoding="utf-8"))):
                self.assertTrue((ROOT / name).exists(), f"{page.relative_to(ROOT)}: {name}")


class Keys(unittest.TestCase):
    """cases/KEYS.md."""

    def setUp(self) -> None:
        self.text = (ROOT / "cases/KEYS.md").read_text(encoding="utf-8")

    def test_every_key_that_is_read_is_documented(self) -> None:
        asked = re.compile(
            r'(?:has|number|number_or|integer|integer_or|flag_or|text|text_or|'
            r'vector|vector_or|vectors|'
            r'integers|texts|table|tables)\("(\w+)"|(?:choice<[^>]*>*|_or|positive|count|path_of)\('
            r'\*?\w+, "(\w+)"'
        )
        files = [*(ROOT / "reference/scene").glob("read_*.cpp"),
                 ROOT / "reference/scene/key_values.cpp",
                 ROOT / "verification/cases/measurement.cpp"]
        keys = {a or b for path in files
                for a, b in asked.findall(path.read_text(encoding="utf-8"))}
        self.assertGreater(len(keys), 90)
        self.assertEqual({key for key in keys if not re.search(rf"\b{key}\b", self.text)}, set())

    def test_every_quantity_is_documented(self) -> None:
        keys = {key for path in (ROOT / "verification/cases").glob("*.cpp")
                for key in re.findall(r'^ +\{"(\w+)", "', path.read_text(encoding="utf-8"), re.M)}
        self.assertGreater(len(keys), 35)
        self.assertEqual({key for key in keys if f"`{key}`" not in self.text}, set())


class Cases(unittest.TestCase):
    """cases/CASES.md."""

    def test_every_shipped_case_is_listed(self) -> None:
        text = (ROOT / "cases/CASES.md").read_text(encoding="utf-8")
        # data of cases
        files = [path for path in (ROOT / "cases").rglob("*.toml")
                 if not path.name.endswith(".campaign.toml")]
        cases = {path.stem for path in files} - {"fabrics", "engines"}
        self.assertEqual({case for case in cases if f"`{case}`" not in text}, set())

    def test_the_tunic_is_as_its_script_draws_it(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([ROOT / "cases/draw_tunic", folder], check=True)
            for name in ("tunic.obj", "tunic_flat.obj"):
                self.assertEqual((Path(folder) / name).read_bytes(),
                                 (ROOT / "cases" / name).read_bytes(), name)


if __name__ == "__main__":
    unittest.main()
