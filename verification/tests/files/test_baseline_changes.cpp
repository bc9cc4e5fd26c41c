// Kept verdicts: where worse begins, the words for each change, and each refusal.
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/types.h"
#include "verification/files/baseline_file.h"
#include "verification/specimens/scratch_folder.h"

namespace foldproof {

namespace {

using Lines = std::vector<std::string>;

Record now_is(const std::string& name, std::optional<Outcome> outcome, double measured,
              double bound) {
  Record record;
  record.name = name, record.kind = "check";
  record.finding.verdict = {measured, bound, 0, "1", ""};
  record.outcome = outcome;
  return record;
}

BaselineChanges changes(const std::vector<KeptVerdict>& kept, const std::vector<Record>& now) {
  RunRecord run;
  run.records = now;
  return changes_since({kept, {}}, run);
}

/// 'w' worse, 'b' better, 'o' other, '-' as it was: of a failure of measured/bound.
char change_of_failure(double was, double was_bound, double is, double is_bound) {
  const BaselineChanges all =
      changes({{"law", "fails", was, was_bound}}, {now_is("law", Outcome::fails, is, is_bound)});
  CHECK(all.worse_names.size() == all.worse.size());
  if (!all.worse.empty()) return 'w';
  return !all.better.empty() ? 'b' : !all.other.empty() ? 'o' : '-';
}

/// What is said of a file of this text.
std::string refusal(const std::string& text) {
  const ScratchFolder scratch;
  const std::string path = scratch.write("kept.json", text);
  try {
    read_baseline(path);
  } catch (const InputError& error) {
    const std::string said = error.what(), begin = path + ": no verdicts.json of a finished run: ";
    CHECK(said.substr(0, begin.size()) == begin);
    return said.substr(begin.size());
  }
  return "it is read";
}

std::string row(const std::string& name, const std::string& outcome,
                const std::string& kind = "check") {
  return "{\"name\":\"" + name + "\",\"kind\":\"" + kind + "\",\"outcome\":\"" + outcome +
         "\",\"measured\":3.5,\"bound\":7.25}";
}

std::string file_of(const std::string& rows, const std::string& rest = "") {
  return "{\"findings\":[" + rows + "]" + rest + "}";
}

}  // namespace

TEST_CASE("baseline changes: a failure is worse beyond twice, and better below half") {
  CHECK(change_of_failure(3, 0.5, 12, 1) == '-');  // 6 and 12
  CHECK(change_of_failure(3, 0.5, 12.01, 1) == 'w');
  CHECK(change_of_failure(3, 0.5, 9, 3) == '-');  // 6 and 3
  CHECK(change_of_failure(3, 0.5, 8.99, 3) == 'b');
  CHECK(change_of_failure(3, 0.5, 20, 4) == '-');
}

TEST_CASE("baseline changes: what holds is as it was by whatever margin, what is in doubt is not") {
  for (const double is : {0.5, 40.0}) {
    const BaselineChanges all = changes(
        {{"held", "holds", 4, 50}, {"doubt", "inconclusive", 4, 50}},
        {now_is("held", Outcome::holds, is, 50), now_is("doubt", Outcome::inconclusive, is, 50)});
    CHECK(all.worse_names == (is > 4 ? std::set<std::string>{"doubt"} : std::set<std::string>{}));
    CHECK(all.better.size() == (is < 4 ? 1 : 0));
    CHECK(all.other.empty());
  }
}

TEST_CASE("baseline changes: without a bound above zero the numbers themselves are compared") {
  CHECK(change_of_failure(3, 0, 6, 0) == '-');
  CHECK(change_of_failure(3, 0, 6.01, 0) == 'w');
  CHECK(change_of_failure(3, 0, 1.49, 0) == 'b');
  CHECK(change_of_failure(3, -4, 6, -4) == '-');
  CHECK(change_of_failure(3, std::nan(""), 6.01, std::nan("")) == 'w');
  CHECK(change_of_failure(3, 0.5, 6, 0) == '-');
}

TEST_CASE("baseline changes: each is reported with its new and its old value") {
  const BaselineChanges all =
      changes({{"worse", "holds", 0.25, 2},
               {"better", "fails", 9, 4},
               {"doubt", "inconclusive", 5, 0},
               {"same", "holds", 1, 3},
               {"number", "fails", 7, 2},
               {"gone", "did not run", 5, 2},
               {"absent", "not applicable", 5, 2}},
              {now_is("worse", Outcome::fails, 32100, 1), now_is("better", Outcome::holds, 2, 4),
               now_is("doubt", Outcome::fails, 2.5, 0), now_is("same", Outcome::holds, 2, 3),
               now_is("fresh", Outcome::inconclusive, 3, 1.5),
               now_is("number", Outcome::fails, std::nan(""), 2)});
  CHECK(all.worse == Lines{"worse: fails, measured/bound 3.21e+04; was: holds",
                           "doubt: fails, measured 2.5; was: inconclusive, measured 5",
                           "number: fails without a number; was: fails, measured/bound 3.5"});
  CHECK(all.worse_names == std::set<std::string>{"worse", "doubt", "number"});
  CHECK(all.better == Lines{"better: holds; was: fails, measured/bound 2.25"});
  CHECK(all.other == Lines{"fresh: inconclusive, measured/bound 2; not in the baseline",
                           "absent: not asked any more; was: not applicable",
                           "gone: not asked any more; was: did not run"});
  CHECK(all.looser.empty());
}

TEST_CASE("baseline changes: each reduced declaration is reported") {
  RunRecord run;
  const auto against = [&](const std::optional<Declared>& kept, const Declared& now) {
    run.declared = now;
    return changes_since({{}, kept}, run);
  };
  const Declared strict{3, "f8", 4, 1e-6, {"held", "planes", "spheres"}};
  const BaselineChanges less = against(strict, {1, "f4", 2, 2.5e-6, {"planes"}});
  CHECK(less.looser ==
        Lines{"the solver declares f4; the baseline f8: bounds are wider",
              "the solver declares order 2; the baseline order 4: bounds are wider",
              "the solver declares solve_tolerance 2.5e-06; the baseline 1e-06: bounds are wider"});
  CHECK(less.worse == less.looser);
  CHECK(less.worse_names.empty());
  const std::string no_more = "the solver no longer declares '",
                    which = "', which the baseline does: fewer laws apply";
  CHECK(less.other == Lines{"the solver declares level L1; the baseline L3: fewer laws apply",
                            no_more + "held" + which, no_more + "spheres" + which});
  for (const BaselineChanges& none :
       {against({{1, "f4", 2, 2.5e-6, {"planes"}}}, strict), against(strict, strict),
        against({}, {1, "f4", 2, 2.5e-6, {}}), against({{3, "f4", 4, 0, {}}}, {3, "f4", 4, 0, {}}),
        against({{3, "f8", 4, 0, {}}}, {3, "", 4, 0, {}})})
    CHECK((none.worse.empty() && none.looser.empty() && none.other.empty() && none.better.empty()));
  run.declared.reset();
  CHECK(changes_since({{}, strict}, run).other.empty());
}

TEST_CASE("baseline file: findings and the declaration are read, claims are not") {
  const ScratchFolder scratch;
  std::string rows;
  for (const std::string outcome : {"holds", "fails", "inconclusive", "not applicable"})
    rows += row("law." + outcome, outcome) + ",";
  rows += row("claim.a", "undecided", "claim") + "," + row("claim.a", "undecided", "claim") + ",";
  rows += R"({"name":"b","kind":"bench","outcome":"did not run","measured":null,"bound":null})";
  const std::string declaration =
      R"(,"declaration":{"level":3,"precision":"f4","order":5,"solve_tolerance":1e-7,)"
      R"("capabilities":["held","planes"]})";
  const Baseline baseline = read_baseline(scratch.write("a", file_of(rows, declaration)));
  REQUIRE(baseline.verdicts.size() == 5);
  const char* const outcomes[] = {"holds", "fails", "inconclusive", "not applicable"};
  for (size_t k = 0; k < 4; ++k) {
    CHECK(baseline.verdicts[k].name == std::string("law.") + outcomes[k]);
    CHECK(baseline.verdicts[k].outcome == outcomes[k]);
    CHECK((baseline.verdicts[k].measured == 3.5 && baseline.verdicts[k].bound == 7.25));
  }
  CHECK((baseline.verdicts[4].name == "b" && baseline.verdicts[4].outcome == "did not run"));
  CHECK((std::isnan(baseline.verdicts[4].measured) && std::isnan(baseline.verdicts[4].bound)));
  REQUIRE(baseline.declared);
  CHECK((baseline.declared->level == 3 && baseline.declared->precision == "f4"));
  CHECK((baseline.declared->order == 5 && baseline.declared->solve_tolerance == 1e-7));
  CHECK(baseline.declared->capabilities == Lines{"held", "planes"});
  CHECK_FALSE(read_baseline(scratch.write("b", file_of(row("a", "holds")))).declared);
}

TEST_CASE("baseline file: each refusal names the file and says why") {
  CHECK(refusal(file_of(row("a", "holds"))) == "it is read");
  CHECK(refusal(file_of(row("a", "holds") + "," + row("a", "fails"))) == "it has a twice");
  CHECK(refusal(file_of(row("a", "measured"))) == "the outcome of a is 'measured'");
  CHECK(refusal(file_of("")) == "it has no findings");
  CHECK(refusal(file_of(row("a", "did not run"))) == "it has no findings");
  CHECK(refusal(file_of(row("a", "holds", "claim"))) == "it has no findings");
  CHECK(refusal(file_of(row("a", "holds"), ",\"declaration\":{}")) != "it is read");
  const std::string path = ScratchFolder().file("none.json");
  CHECK_THROWS_WITH(read_baseline(path),
                    path + ": no verdicts.json of a finished run: it cannot be opened");
  CHECK_THROWS_AS(read_baseline(path), InputError);
}

}  // namespace foldproof
