#!/usr/bin/python3
"""Tests of the mutator: what it edits, and what it leaves alone."""

import shutil
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from unittest import mock

from script_module import ROOT
from clocked import run
from edits import apply, changes_of, place_of, sample, tokens_of
from mutant_trials import sample_of

KERNEL = (ROOT / "reference/forces/springs.cpp").read_text(encoding="utf-8")

QUIET = r'''#include "a - b.h"
#define TWICE(x) \
  2 * (x) + 1
// a + b < 1, and so on: x1 - x2
/* 0.5 * min(a, b) */
using Rows = Eigen::Matrix<double, 3, 12>;
template <int N = 2, class T = std::array<double, 4>>
void add(const std::vector<T>& rows, T&& last, const T* first);
const char* text = "1 + 2 \" - 3" R"(4 * 5)";
'''


def code_of(text: str) -> list[str]:
    return [token.text for token in tokens_of(text)]


class EditsTest(unittest.TestCase):
    def test_comments_texts_preprocessor_lines_and_template_arguments_are_left_alone(self) -> None:
        self.assertEqual([place_of(QUIET, change) for change in changes_of(QUIET)], [])

    def test_the_same_seed_gives_the_same_edits_and_none_twice(self) -> None:
        changes = changes_of(KERNEL)
        self.assertGreater(len(changes), 100)
        self.assertEqual(sample(changes, 7), sample(changes_of(KERNEL), 7))
        self.assertNotEqual(sample(changes, 7), sample(changes, 8))
        self.assertEqual(sorted(sample(changes, 7)), changes)
        edited = [apply(KERNEL, change) for change in changes]
        self.assertEqual(len(edited), len(set(edited)))
        self.assertFalse(KERNEL in edited)

    def test_each_edit_changes_one_token_or_takes_out_one_statement(self) -> None:
        def common(a: list[str], b: list[str]) -> int:
            return next((k for k, (one, other) in enumerate(zip(a, b)) if one != other),
                        min(len(a), len(b)))

        original = code_of(KERNEL)
        for change in changes_of(KERNEL):
            edited = code_of(apply(KERNEL, change))
            head = common(original, edited)
            tail = common(original[head:][::-1], edited[head:][::-1])
            gone, come = original[head:len(original) - tail], edited[head:len(edited) - tail]
            if change.kind == "removal":
                self.assertIn(";", code_of(change.before)[-1:], change)
                self.assertLessEqual(len(gone), len(code_of(change.before)), change)
            elif change.kind == "bound":
                self.assertEqual((gone, come), ([], ["-", "1"]), change)
            else:
                self.assertLessEqual(max(len(gone), len(come)), 1, change)

    def test_every_kind_of_slip_is_made(self) -> None:
        text = """
double f(const Points& x, int n, double a, double b) {
  double sum = -a;
  for (int i = 0; i < n; ++i) {
    if (x[i] > 0.5 && !skipped(i)) continue;
    sum += std::min(a, 1e-9) * x1 - x2;
    record(sum);
  }
  return sum;
}
"""
        def made_of(text: str) -> set[tuple[str, str, str]]:
            return {(change.kind, change.before, change.after) for change in changes_of(text)}

        expected = {
            ("sign", "-", ""), ("number", "0", "1"), ("operator", "<", "<="),
            ("bound", "n", "n - 1"), ("sign", "++", "--"), ("operator", ">", "<"),
            ("number", "0.5", "0.6"), ("operator", "&&", "||"), ("sign", "!", ""),
            ("name", "continue", "break"), ("operator", "+=", "-="), ("name", "min", "max"),
            ("name", "a", "b"), ("number", "1e-9", "1e-06"), ("operator", "*", "/"),
            ("name", "x1", "x2"), ("operator", "-", "+"), ("removal", "record(sum);", ";"),
            ("removal", "continue;", ";"),
            ("removal", "if (x[i] > 0.5 && !skipped(i)) continue;", ";")
        }
        self.assertEqual(expected - made_of(text), set())
        compared = "bool operator<(A o) const { return a < o.a; }\nint k = 0;\n"
        self.assertLessEqual({("operator", "<", ">"), ("number", "0", "1")}, made_of(compared))
        self.assertEqual([change for change in changes_of(text)
                          if place_of(text, change)[0] == 2 and change.kind != "removal"], [])

    def test_memory_that_is_asked_for_is_no_slip(self) -> None:
        self.assertEqual(changes_of("void f() {\n  list.reserve(list.size() + n);\n}\n"), [])
        rows = "PerParticle3 q(3, n), r(3, 2);\nstd::vector<int> s(3, 2);\n"
        numbers = [place_of(rows, change)[0] for change in changes_of(rows) if change.before == "3"]
        self.assertEqual(numbers, [2])

    def test_a_folder_is_sampled_over_all_its_files(self) -> None:
        drawn = sample_of("reference/motion", 3)
        files = sorted((ROOT / "reference/motion").glob("*.*"))
        sources = {f"reference/motion/{file.name}": file.read_text(encoding="utf-8")
                   for file in files if file.suffix in (".cpp", ".h")}
        self.assertEqual({one.file for one in drawn},
                         {file for file, text in sources.items() if changes_of(text)})
        self.assertEqual(len(drawn), sum(len(changes_of(text)) for text in sources.values()))
        self.assertEqual(drawn, sample_of("reference/motion", 3))
        self.assertNotEqual([one.file for one in drawn], sorted(one.file for one in drawn))

    def test_the_clock_of_a_mutant_is_the_processors(self) -> None:
        run(["sleep", "1.5"], ROOT, 1)
        with self.assertRaises(subprocess.TimeoutExpired):
            run([sys.executable, "-c", "while True: pass"], ROOT, 1)

    def test_what_stands_still_is_ended_with_all_that_it_started(self) -> None:
        start = time.monotonic()
        with mock.patch.multiple("clocked", LOOK=0.2, STILL=1.0):
            with self.assertRaises(subprocess.TimeoutExpired):
                run(["sh", "-c", "sleep 60; true"], ROOT, 100)
            run(["sh", "-c", "sleep 0.7; seq 10000000 > /dev/null; sleep 0.7"], ROOT, 100)
        self.assertLess(time.monotonic() - start, 30)

    def test_a_program_that_is_still_written_to_is_waited_for(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            program = shutil.copy("/bin/true", folder)
            writer = open(program, "ab")
            threading.Timer(0.5, writer.close).start()
            self.assertEqual(run([program], ROOT, 1).returncode, 0)


if __name__ == "__main__":
    unittest.main()
