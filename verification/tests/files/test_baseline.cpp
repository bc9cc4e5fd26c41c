// Kept verdicts: what counts as worse, and which files are refused.
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/mesh/text_file.h"
#include "reference/types.h"
#include "verification/files/baseline_file.h"
#include "verification/files/verdicts_file.h"
#include "verification/specimens/scratch_folder.h"

using namespace foldproof;

namespace {

Record record_of(const std::string& name, Outcome outcome, double measured, double bound = 1) {
  Record record;
  record.name = name;
  record.kind = "check";
  record.finding.verdict = {measured, bound, 0, "1", ""};
  record.outcome = outcome;
  return record;
}

KeptVerdict kept_of(Outcome outcome, double measured, double bound = 1) {
  return {"law", std::string(name_of(outcome)), measured, bound};
}

BaselineChanges changes_between(const std::vector<KeptVerdict>& kept,
                                const std::vector<Record>& now) {
  RunRecord run;
  run.records = now;
  return changes_since({kept, {}}, run);
}

/// 'w' worse, 'b' better, 'o' other, '-' as it was.
char change(const KeptVerdict& kept, const Record& now) {
  const BaselineChanges changes = changes_between({kept}, {now});
  CHECK(changes.worse.size() + changes.better.size() + changes.other.size() <= 1);
  if (!changes.worse.empty()) return 'w';
  if (!changes.better.empty()) return 'b';
  return changes.other.empty() ? '-' : 'o';
}

constexpr auto holds = Outcome::holds, fails = Outcome::fails, inconclusive = Outcome::inconclusive,
               not_applicable = Outcome::not_applicable;

}  // namespace

TEST_CASE("baseline: a change of the outcome is worse, better or neither") {
  const Outcome outcomes[] = {holds, inconclusive, fails, not_applicable};
  const char* const expected[] = {"-www", "b-wo", "bb-o", "bww-"};  // rows: as it was
  for (int was = 0; was < 4; ++was)
    for (int is = 0; is < 4; ++is) {
      INFO(name_of(outcomes[was]) << " before, " << name_of(outcomes[is]) << " now");
      CHECK(change(kept_of(outcomes[was], 3), record_of("law", outcomes[is], 3)) ==
            expected[was][is]);
    }
}

TEST_CASE("baseline: what no longer runs is worse, and what runs again is better") {
  Record unrun = record_of("law", holds, std::nan(""));
  unrun.outcome.reset();
  const KeptVerdict kept{"law", "did not run", std::nan(""), std::nan("")};
  for (const Outcome was : {holds, inconclusive, fails})
    CHECK(change(kept_of(was, 3), unrun) == 'w');
  CHECK(change(kept_of(not_applicable, 3), unrun) == 'o');  // it might not apply today, either
  CHECK(change(kept, unrun) == '-');
  for (const Outcome is : {holds, inconclusive, fails})
    CHECK(change(kept, record_of("law", is, 3)) == 'b');
  CHECK(changes_between({kept_of(holds, 1)}, {unrun}).worse.at(0) ==
        "law: did not run; was: holds");
}

TEST_CASE("baseline: a failure is worse if it more than doubled or lost its number") {
  const KeptVerdict kept = kept_of(fails, 30, 3);
  CHECK(change(kept, record_of("law", fails, 60, 3)) == '-');
  CHECK(change(kept, record_of("law", fails, 61, 3)) == 'w');
  CHECK(change(kept, record_of("law", fails, 61, 4)) == '-');
  CHECK(change(kept, record_of("law", fails, 14, 3)) == 'b');
  CHECK(change(kept, record_of("law", fails, std::nan(""), std::nan(""))) == 'w');
  const KeptVerdict crashed = kept_of(fails, std::nan(""), std::nan(""));
  CHECK(change(crashed, record_of("law", fails, std::nan(""), std::nan(""))) == '-');
  CHECK(change(crashed, record_of("law", fails, 61, 3)) == 'b');
  CHECK(change(kept_of(fails, 3, 0), record_of("law", fails, 7, 0)) == 'w');
}

TEST_CASE("baseline: what only one run has is named and is not worse") {
  const BaselineChanges changes =
      changes_between({kept_of(fails, 3)}, {record_of("new", fails, 5, 2)});
  CHECK(changes.worse.empty());
  CHECK(changes.other ==
        std::vector<std::string>{"new: fails, measured/bound 2.5; not in the baseline",
                                 "law: not asked any more; was: fails, measured/bound 3"});
}

TEST_CASE("baseline: a written run is read as it was, and other files are refused") {
  const ScratchFolder folder;
  RunRecord run;
  run.records = {record_of("a", holds, 0.25), record_of("b", fails, std::nan(""))};
  run.declared = {1, "f8", 2, 0, {"held"}};
  write_verdicts(folder.file("."), run);
  const std::string path = folder.file("verdicts.json");
  const Baseline baseline = read_baseline(path);
  const std::vector<KeptVerdict>& kept = baseline.verdicts;
  REQUIRE(baseline.declared);
  CHECK((baseline.declared->precision == "f8" && baseline.declared->order == 2));
  REQUIRE(kept.size() == 2);
  CHECK((kept[0].name == "a" && kept[0].outcome == "holds" && kept[0].measured == 0.25));
  CHECK(std::isnan(kept[1].measured));
  CHECK(changes_since(baseline, run).worse.empty());
  CHECK_THROWS_AS(read_baseline(folder.file("none.json")), InputError);
  const char* const row = R"({"name":"a","kind":"check","outcome":"holds","measured":1,"bound":1})";
  for (const std::string& text :
       {std::string("{"), std::string("[]"), std::string(R"({"findings":[]})"),
        std::string(R"({"findings":[{"name":"a"}]})"),
        std::string(R"({"findings":[)") + row + "," + row + "]}",
        std::string(R"({"findings":[{"name":"a","kind":"check","outcome":"did not run",)") +
            R"("measured":null,"bound":null}]})"}) {
    folder.write("verdicts.json", text);
    CHECK_THROWS_AS(read_baseline(path), InputError);
  }
}

TEST_CASE("baseline: junit.xml fails where the exit code does") {
  const ScratchFolder folder;
  const std::string path = folder.file("");
  RunRecord run;
  run.records = {record_of("known", fails, 3), record_of("worse", fails, 3),
                 record_of("new", fails, 3), record_of("lost", not_applicable, 0),
                 record_of("good", holds, 0)};
  Baseline kept;
  for (const auto& [name, outcome] : {std::pair("known", fails), std::pair("worse", holds),
                                      std::pair("lost", holds), std::pair("good", holds)})
    kept.verdicts.push_back({name, std::string(name_of(outcome)), 3, 1});
  write_verdicts_since(path, run, changes_since(kept, run));
  const std::string xml = read_text_file(folder.file("junit.xml"), table_text_limits);
  CHECK_THAT(xml, Catch::Matchers::Contains("failures=\"2\" errors=\"0\" skipped=\"2\""));
  CHECK_THAT(xml, Catch::Matchers::Contains("no worse than the baseline"));
  write_verdicts(path, run);
  const std::string all = read_text_file(folder.file("junit.xml"), table_text_limits);
  CHECK_THAT(all, Catch::Matchers::Contains("failures=\"3\" errors=\"0\" skipped=\"1\""));
}

TEST_CASE("baseline: a declaration that widens bounds is worse, and fails junit.xml") {
  const Declared strict{2, "f8", 2, 1e-6, {"held", "planes"}};
  RunRecord run;
  run.records = {record_of("law", holds, 0)};
  const auto against = [&](const Declared& now) {
    run.declared = now;
    return changes_since({{kept_of(holds, 0)}, strict}, run);
  };
  CHECK(against(strict).worse.empty());
  CHECK(against({3, "f8", 4, 0, {"held", "planes", "spheres"}}).worse.empty());
  const std::vector<std::string> wider{
      "the solver declares f4; the baseline f8: bounds are wider",
      "the solver declares order 1; the baseline order 2: bounds are wider",
      "the solver declares solve_tolerance 0.01; the baseline 1e-06: bounds are wider"};
  CHECK(against({2, "f4", 1, 0.01, {"held", "planes"}}).worse == wider);
  const BaselineChanges poorer = against({1, "f8", 2, 1e-6, {"held"}});
  CHECK(poorer.worse.empty());  // laws that no longer apply are counted one by one
  CHECK(poorer.other.size() == 2);
  const ScratchFolder folder;
  write_verdicts_since(folder.file(""), run, against({2, "f4", 2, 1e-6, {"held", "planes"}}));
  const std::string xml = read_text_file(folder.file("junit.xml"), table_text_limits);
  CHECK_THAT(xml, Catch::Matchers::Contains("tests=\"2\" failures=\"1\""));
  CHECK_THAT(xml, Catch::Matchers::Contains("declares f4; the baseline f8"));
}

TEST_CASE("junit.xml: without a number it says what was required, and lines stay lines") {
  const ScratchFolder folder;
  RunRecord run;
  run.records = {record_of("law", fails, std::nan(""), std::nan(""))};
  run.records[0].finding.verdict.why_bound = "it must run to its end";
  run.records[0].finding.note = "its last words:\n    one\n    two";
  write_verdicts(folder.file(""), run);
  const std::string xml = read_text_file(folder.file("junit.xml"), table_text_limits);
  CHECK_THAT(xml, Catch::Matchers::Contains("no number; required: it must run to its end"));
  CHECK_THAT(xml, Catch::Matchers::Contains("words:&#10;    one&#10;    two"));
  CHECK_THAT(xml, !Catch::Matchers::Contains("nan"));
}
