#!/usr/bin/python3
"""Tests of scripts/format: which comments it fills, keeps or moves, and which literals it joins."""
from __future__ import annotations

import sys
import unittest
from pathlib import Path

sys.dont_write_bytecode = True

from script_module import script  # noqa: E402
from comments import filled, put_back, shortened, trailing_comments  # noqa: E402

FORMAT = script("format")
ROOT = Path(__file__).resolve().parents[2]

KEPT = r"""
//      x1
//     /  \      E  = x4 - x3
//   x3 -- x4    N1 = (x1 - x3) x (x1 - x4)
//     \  /
//      x2
//
//   d -- c
// |    |
// a -- b

/// Reads the table into the scene:
///   folder   where relative files are looked for
///   - one
///     and its second line
/// "plain":  f = max(phi, eps)
/// "blend":  linear

// ---- a heading

// | one | two |
// |-----|-----|

#if 0  // never
#endif
// Throws what make_octree throws.
// InputError for a sequence without frames.
"""


class Filling(unittest.TestCase):
    def test_drawings_tables_lists_and_raw_texts_stay(self) -> None:
        raw = 'R"(\n// ' + "word " * 30 + '\n)";\n'
        self.assertEqual(filled(KEPT + raw), KEPT + raw)

    def test_a_paragraph_is_filled_up_to_what_is_kept(self) -> None:
        words = ("one two three four five six seven eight nine ten eleven twelve thirteen "
                 "fourteen fifteen sixteen")
        long = f"  /// {words} {words}\n  /// {words}:\n  ///   x = y   [m]\n  /// short.\n"
        lines = filled(long).split("\n")
        self.assertEqual([line for line in lines if len(line) > 100], [])
        self.assertEqual(lines[-3:], ["  ///   x = y   [m]", "  /// short.", ""])
        self.assertEqual(" ".join(line[6:] for line in lines[:-3]), f"{words} {words} {words}:")
        self.assertEqual(filled("\n".join(lines)), "\n".join(lines))

    def test_no_line_begins_with_an_operator(self) -> None:
        for line in filled("// " + "a - b + 12. " * 30).split("\n"):
            self.assertNotRegex(line, r"^// ([-+]|\d+\.)")

    def test_the_last_line_is_no_single_word(self) -> None:
        text = "// " + "word " * 19 + "word.\n"
        lines = filled(text).split("\n")
        self.assertEqual(len(lines), 3)
        self.assertGreater(len(lines[1].split()), 2)

    def test_comments_of_two_kinds_do_not_mix(self) -> None:
        text = "/// A promise.\n// A remark\n  // further in\n"
        self.assertEqual(filled(text), text)


class Trailing(unittest.TestCase):
    def moved(self, text: str) -> str:
        return put_back(shortened(text), [comment.text for comment in trailing_comments(text)])

    def test_what_fits_stays_behind_its_code(self) -> None:
        for text in ("int a;  // m\n", "f(a,  // first\n  b);\n", '"//";  // a text\n',
                     "}  // namespace\n", "}  // namespace foldproof\n"):
            self.assertEqual(self.moved(text), text)

    def test_what_does_not_fit_goes_above_its_statement(self) -> None:
        comment = "// " + "long " * 20 + "end"
        for before, indent, statement in (("int b;\n", "  ", "int a = 1 +\n      2;"),
                                          ("void f() {\n", "  ", "const V v{1,\n            2};"),
                                          ("f({1,\n", "   ", "g(2,\n     3),"),
                                          (" public:\n", "  ", "int a;"),
                                          ("enum A {\n", "  ", "b,")):
            self.assertEqual(self.moved(f"{before}{indent}{statement}  {comment}\n}}"),
                             f"{before}{indent}{comment}\n{indent}{statement}\n}}")

    def test_in_another_branch_it_goes_below(self) -> None:
        comment = "// " + "long " * 20 + "end"
        self.assertEqual(self.moved(f"if (a) {{\n}} else {{  {comment}\n}}"),
                         f"if (a) {{\n}} else {{\n{comment}\n}}")

    def test_lines_that_go_on_below_belong_to_it(self) -> None:
        text = "int a;  // one\n        // two\n// three\n"
        self.assertEqual([comment.text for comment in trailing_comments(text)], ["// one two"])


class Literals(unittest.TestCase):
    def test_literals_in_a_row_become_one_but_at_a_line_end(self) -> None:
        self.assertEqual(FORMAT.joined('f("a "\n  "b" "c");'), 'f("a bc");')
        for text in ('f("a\\n"\n  "b");', 'f("\\x1b"\n  "b");', 'f("a", "b");', 'R"(a)" "b"',
                     'f("a"\n  // why\n  "b");'):
            self.assertEqual(FORMAT.joined(text), text)

    def test_lines_that_nothing_shortens_are_named_but_those_of_raw_texts(self) -> None:
        word = "a" * 101
        self.assertEqual(FORMAT.too_long(f'short\n// {word}\nR"(\n{word}\n)";\n'), [2])


def sources() -> list[Path]:
    """The scripts in Python, and the files of CMake."""
    folders = ("cases", "convergence", "reference", "reports", "scripts", "verification")
    files = [path for folder in folders for path in (ROOT / folder).rglob("*") if path.is_file()]
    return [path for path in [ROOT / "CMakeLists.txt", *files]
            if path.suffix in (".py", ".cmake") or path.name == "CMakeLists.txt"
            or (not path.suffix and path.read_bytes().startswith(b"#!/usr/bin/python3"))]


class Widths(unittest.TestCase):
    def test_lines_of_python_and_cmake_end_at_100(self) -> None:
        files = sources()
        self.assertGreater(len(files), 100)
        for path in files:
            for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
                self.assertLessEqual(len(line), 100, f"{path.relative_to(ROOT)}:{number}")


if __name__ == "__main__":
    unittest.main()
