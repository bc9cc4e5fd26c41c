// Kept verdicts: what counts as worse, and which files are refused; verdicts.json and junit.xml.
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/mesh/text_file.h"
#include "reference/types.h"
#include "verification/files/baseline_file.h"
#include "verification/files/verdicts_file.h"
#include "verification/specimens/scratch_folder.h"

using namespace foldproof;

namespace {

using Lines = std::vector<std::string>;

constexpr auto holds = Outcome::holds, fails = Outcome::fails, inconclusive = Outcome::inconclusive,
               not_applicable = Outcome::not_applicable;
const double no_number = std::nan("");

Record record_of(const std::string& name, std::optional<Outcome> outcome, double measured,
                 double bound = 1) {
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
  CHECK(changes.worse_names.size() == changes.worse.size());
  if (!changes.worse.empty()) return 'w';
  if (!changes.better.empty()) return 'b';
  return changes.other.empty() ? '-' : 'o';
}

std::string junit_in(const ScratchFolder& folder) {
  return read_text_file(folder.file("junit.xml"), table_text_limits);
}

/// A finding of a kept file.
std::string row_of(const std::string& name, const std::string& outcome,
                   const std::string& kind = "check") {
  return "{\"name\":\"" + name + "\",\"kind\":\"" + kind + "\",\"outcome\":\"" + outcome +
         "\",\"measured\":3.5,\"bound\":7.25}";
}

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
  const Record unrun = record_of("law", std::nullopt, no_number);
  const KeptVerdict kept{"law", "did not run", no_number, no_number};
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
  struct Row {
    double was, was_bound, is, is_bound;
    char change;
  };
  const double none = no_number;  // without a bound above zero the numbers themselves are compared
  const Row rows[] = {
      {3, 0.5, 12, 1, '-'},     {3, 0.5, 12.01, 1, 'w'},   {3, 0.5, 9, 3, '-'},
      {3, 0.5, 8.99, 3, 'b'},   {3, 0.5, none, none, 'w'}, {none, none, none, none, '-'},
      {none, none, 61, 3, 'b'}, {3, 0, 6, 0, '-'},         {3, 0, 6.01, 0, 'w'},
      {3, 0, 1.49, 0, 'b'},     {3, -4, 6, -4, '-'},       {3, none, 6.01, none, 'w'}};
  for (const Row& row : rows) {
    INFO(row.was << "/" << row.was_bound << " before, " << row.is << "/" << row.is_bound << " now");
    CHECK(change(kept_of(fails, row.was, row.was_bound),
                 record_of("law", fails, row.is, row.is_bound)) == row.change);
  }
  CHECK(change(kept_of(holds, 4, 50), record_of("law", holds, 40, 50)) == '-');
  CHECK(change(kept_of(inconclusive, 4, 50), record_of("law", inconclusive, 40, 50)) == 'w');
}

TEST_CASE("baseline: junit.xml fails where the exit code does") {
  const ScratchFolder folder;
  RunRecord run;
  run.records = {record_of("known", fails, 3), record_of("worse", fails, 3),
                 record_of("new", fails, 3), record_of("lost", not_applicable, 0),
                 record_of("good", holds, 0)};
  Baseline kept;
  for (const auto& [name, outcome] :
       {std::pair("known", fails), {"worse", holds}, {"lost", holds}, {"good", holds}})
    kept.verdicts.push_back({name, std::string(name_of(outcome)), 3, 1});
  write_verdicts_since(folder.file(""), run, changes_since(kept, run));
  CHECK_THAT(junit_in(folder),
             Catch::Matchers::Contains("failures=\"2\" errors=\"0\" skipped=\"2\"") &&
                 Catch::Matchers::Contains("no worse than the baseline"));
  write_verdicts(folder.file(""), run);
  CHECK_THAT(junit_in(folder),
             Catch::Matchers::Contains("failures=\"3\" errors=\"0\" skipped=\"1\""));
}

TEST_CASE("baseline: a declaration that widens bounds is worse, and fails junit.xml") {
  const Declared strict{2, "f8", 2, 1e-6, {"held", "planes"}};
  RunRecord run;
  run.records = {record_of("law", holds, 0)};
  const auto against = [&](const std::optional<Declared>& kept,
                           const std::optional<Declared>& now) {
    run.declared = now;
    return changes_since({{kept_of(holds, 0)}, kept}, run);
  };
  const std::pair<std::optional<Declared>, std::optional<Declared>> none[] = {
      {strict, strict},
      {strict, Declared{3, "f8", 4, 0, {"held", "planes", "spheres"}}},
      {Declared{2, "f4", 2, 0, {}}, Declared{2, "f4", 2, 0, {}}}};
  for (const auto& [kept, now] : none) {
    const BaselineChanges changes = against(kept, now);
    CHECK((changes.worse.empty() && changes.looser.empty() && changes.other.empty()));
  }
  const BaselineChanges wider = against(strict, Declared{2, "f4", 1, 0.01, {"held", "planes"}});
  CHECK(wider.looser ==
        Lines{"the solver declares f4; the baseline f8: bounds are wider",
              "the solver declares order 1; the baseline order 2: bounds are wider",
              "the solver declares solve_tolerance 0.01; the baseline 1e-06: bounds are wider"});
  CHECK((wider.worse == wider.looser && wider.worse_names.empty()));
  const BaselineChanges poorer = against(strict, Declared{1, "f8", 2, 1e-6, {"held"}});
  CHECK(poorer.worse.empty());  // laws that no longer apply are counted one by one
  REQUIRE(poorer.other.size() == 2);
  CHECK_THAT(poorer.other[0], Catch::Matchers::Contains("level L1; the baseline L2"));
  CHECK_THAT(poorer.other[1], Catch::Matchers::Contains("no longer declares 'planes'"));
  const ScratchFolder folder;
  write_verdicts_since(folder.file(""), run,
                       against(strict, Declared{2, "f4", 2, 1e-6, {"held", "planes"}}));
  CHECK_THAT(junit_in(folder), Catch::Matchers::Contains("tests=\"2\" failures=\"1\"") &&
                                   Catch::Matchers::Contains("declares f4; the baseline f8"));
}

TEST_CASE("junit.xml: without a number it says what was required, and lines stay lines") {
  const ScratchFolder folder;
  RunRecord run;
  run.records = {record_of("law", fails, no_number, no_number)};
  run.records[0].finding.verdict.why_bound = "it must run to its end";
  run.records[0].finding.note = "its last words:\n    one\n    two";
  write_verdicts(folder.file(""), run);
  CHECK_THAT(junit_in(folder),
             Catch::Matchers::Contains("no number; required: it must run to its end") &&
                 Catch::Matchers::Contains("words:&#10;    one&#10;    two") &&
                 !Catch::Matchers::Contains("nan"));
}

TEST_CASE("baseline file: each refusal names the file and says why") {
  const ScratchFolder scratch;
  const std::string good = row_of("a", "holds"), path = scratch.file("kept.json");
  CHECK_THROWS_AS(read_baseline(path), InputError);
  const std::pair<std::string, const char*> rows[] = {
      {"[]", "array"},
      {"{\"findings\":[" + good + "," + good + "]}", "it has a twice"},
      {"{\"findings\":[" + row_of("a", "measured") + "]}", "the outcome of a is 'measured'"},
      {"{\"findings\":[" + row_of("a", "did not run") + "]}", "no findings"},
      {"{\"findings\":[" + good + "],\"declaration\":{}}", "level"}};
  for (const auto& [text, why] : rows) {
    scratch.write("kept.json", text);
    CHECK_THROWS_AS(read_baseline(path), InputError);
    CHECK_THROWS_WITH(read_baseline(path),
                      Catch::Matchers::StartsWith(path + ": ") && Catch::Matchers::Contains(why));
  }
}

TEST_CASE("verdicts: text is escaped for XML, and keeps only what XML allows") {
  CHECK(xml_text("a&b<c>d\"e'f\ng") == "a&amp;b&lt;c&gt;d&quot;e&apos;f&#10;g");
  CHECK(xml_text(std::string("0\0|\x01|\t|\r|\x1f|\x20|\x7f|~", 16)) == "0 | |\t| | | |\x7f|~");
  CHECK(xml_text("\u00e9\u4e2d\U0001F600\xff") == "\u00e9\u4e2d\U0001F600\uFFFD");
  CHECK(xml_text("a\uFFFEb\uFFFE\uFFFEc\uFFFF\uFFFF") == "a\uFFFDb\uFFFD\uFFFDc\uFFFD\uFFFD");
}
