#!/usr/bin/python3
"""Tests of what is asked of a mutant: where functions begin and end, and who reaches them."""
from __future__ import annotations

import unittest

from script_module import ROOT
from edits import Change
from mutant_questions import faults_listed
from mutant_trials import Mutant, Questions, Target
from reach import Table, from_json, functions_of, missed_catchers, to_json

TEXT = """#include "x.h"
namespace a {
constexpr double k = 3;
const Vec origin = Vec{1, 2}.norm() + f(Vec{2});
constexpr double cube(double x) { return x * x * x; }
enum class Kind { a, b };
template <class T>
T twice(T x) {
  return x;
}
struct S : B {
  int n = 2;
  S(int m) : n{m}, B{1} {}

 private:
  bool operator==(const S&) const = default;
  S& operator=(const S& o) {
    n = o.n;
    return *this;
  }
};
double f(const A& a = {},
         int b) {
  const auto g = [&](int q) { return q; };
  return g(b);
}
}  // namespace a
TEST_CASE("x { (") {
  CHECK('{');
}
"""
FUNCTIONS = [range(7, 11), range(13, 14), range(17, 21), range(22, 27), range(28, 31)]
HEADS = {8: 0b001, 17: 0b000, 22: 0b010, 24: 0b100}  # of FUNCTIONS, and of the lambda
TABLE = Table(
    ["one", "two", "test: three", "fails"], {"fails"}, {"a.cpp": HEADS, "a.h": {8: 0b010}}
)
SECONDS = {"one": 1.0, "two": 0.1, "test: three": 2.0, "fails": 0.1}


def mutant(line: int, file: str = "a.cpp") -> Mutant:
    return Mutant(file, 0, Change(0, "", "", "sign"), line, "", "")


class Trial(Target):
    """Judges without compiling: each batch holds."""

    def __init__(self, table: Table | None) -> None:
        self.file, self.text, self.explained, self.asked = "a.cpp", TEXT, set(), []
        self.questions = Questions(SECONDS, set(), table)

    def first_failing(self, batch, link) -> None:
        self.asked += batch.names


class Functions(unittest.TestCase):
    def test_bodies_are_found_and_code_outside_of_them_is_not_taken_for_one(self) -> None:
        self.assertEqual(functions_of(TEXT), FUNCTIONS)

    def test_nearly_all_lines_that_return_are_in_a_function(self) -> None:
        lines, outside = 0, []
        for path in sorted((ROOT / "reference").rglob("*.cpp")):
            text = path.read_text(encoding="utf-8")
            for number, line in enumerate(text.splitlines(), 1):
                if line.strip().startswith("return "):
                    lines += 1
                    if not any(number in each for each in functions_of(text)):
                        outside.append(f"{path}:{number}")
        self.assertLess(len(outside), lines / 50, outside)


class Reaching(unittest.TestCase):
    def test_a_function_is_reached_by_who_reaches_it_or_a_lambda_in_it(self) -> None:
        self.assertEqual(TABLE.names_for("a.cpp", TEXT, 9), {"one"})
        self.assertEqual(TABLE.names_for("a.cpp", TEXT, 25), {"two", "test: three"})

    def test_code_outside_of_functions_is_of_the_file_but_in_a_header_of_all(self) -> None:
        for line in (3, 4, 5, 12, 13, 29):
            found = TABLE.names_for("a.cpp", TEXT, line)
            self.assertEqual(found, {"one", "two", "test: three"}, line)
            self.assertIsNone(TABLE.names_for("a.h", TEXT, line), line)
        self.assertEqual(TABLE.names_for("a.h", TEXT, 9), {"two"})
        self.assertIsNone(TABLE.names_for("b.cpp", TEXT, 9))

    def test_no_header_declares_a_constant_that_another_file_defines(self) -> None:
        for folder in ("reference", "verification", "convergence"):
            for path in (ROOT / folder).rglob("*.h"):
                for line in path.read_text(encoding="utf-8").splitlines():
                    self.assertFalse(line.strip().startswith("extern ") and '"C"' not in line, path)

    def test_a_stored_table_keeps_what_programs_of_the_same_build_were_asked(self) -> None:
        keys = {"foldproof": "f1", "tests": "t1"}
        text = to_json(TABLE, keys)
        self.assertEqual(from_json(text, keys), TABLE)
        self.assertEqual(from_json(text, {"foldproof": "f2", "tests": "t2"}), Table([], set(), {}))
        self.assertEqual(
            from_json(text, {**keys, "tests": "t2"}),
            Table(["one", "two", "fails"], {"fails"}, {"a.cpp": {8: 0b001, 22: 0b010},
                                                       "a.h": {8: 0b010}})
        )
        self.assertEqual(
            from_json(text, {**keys, "foldproof": "f2"}),
            Table(["test: three"], set(), {"a.cpp": {24: 0b001}})
        )

    def test_a_table_that_misses_who_notices_a_fault_is_found(self) -> None:
        file = "reference/forces/springs.cpp"
        text = (ROOT / file).read_text(encoding="utf-8")
        lines = functions_of(text)[0]
        find = "\n".join(text.splitlines()[lines[0] - 1:lines[-1]])
        fault = {"file": file, "find": find, "caught_by": ["one", "fails", "study.x"],
                 "caught_by_tests": ["three"]}
        for mask, missed in ((0b101, []), (0b001, ["test: three"]), (0, ["one", "test: three"])):
            table = TABLE._replace(reached={file: {lines[0]: mask}})
            self.assertEqual(missed_catchers(table, [fault]), missed)
        elsewhere = TABLE._replace(reached={})
        self.assertEqual(missed_catchers(elsewhere, [fault]), [])

    def test_every_seeded_fault_has_a_file(self) -> None:
        for fault in faults_listed():  # some name none: they have that of the row above
            self.assertTrue((ROOT / fault["file"]).is_file(), fault["name"])

    def test_a_mutant_is_asked_what_reaches_it_and_what_was_not_measured(self) -> None:
        for line, file, table, names, what in (
            (9, "a.cpp", TABLE, ["fails", "one"], ""),
            (18, "a.cpp", TABLE, ["fails"], "nothing reaches it"),
            (12, "a.h", TABLE, sorted(SECONDS), ""),  # a constant in a header
            (9, "a.h", None, sorted(SECONDS), "")
        ):
            trial = Trial(table)
            judged = trial.ask_who_reaches(mutant(line, file), lambda program: None)
            self.assertEqual(sorted(trial.asked), names)
            self.assertEqual((judged.outcome, judged.what, judged.left_out),
                             ("SURVIVED", what, len(SECONDS) - len(names)))


if __name__ == "__main__":
    unittest.main()
