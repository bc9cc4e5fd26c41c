// Verdicts: what holds, what fails, and that nothing that is NaN or stopped ever passes.
#include <catch2/catch.hpp>
#include <stdexcept>

#include "reference/scene/key_file.h"
#include "verification/verdict.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/faults/faults.h"
#include "verification/subjects/reference_subject.h"
#include "verification/files/verdicts_file.h"

using namespace foldproof;
using Catch::Contains;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

Record record_of_check(std::function<Finding(const Subject&)> run) {
  return run_check({"group.name", "A sentence.", "nowhere", std::move(run)}, reference_subject());
}

const std::string edit = "edit = \"a «+¦-» b\"\nlaw = \"sums\"\n";

std::string fault_of(const std::string& name, const std::string& file) {
  return "[fault." + name + "]\nfile = \"" + file + "\"\n" + edit;
}

}  // namespace

TEST_CASE("a verdict holds, fails, or cannot be decided") {
  for (const auto& [measured, outcome] : {std::pair{1.0, Outcome::holds},
                                          {1.5, Outcome::holds},
                                          {1.75, Outcome::inconclusive},
                                          {2.25, Outcome::inconclusive},
                                          {2.5, Outcome::inconclusive},
                                          {2.75, Outcome::fails}})
    CHECK(outcome_of({measured, 2.0, 0.5, "1", ""}) == outcome);
}

TEST_CASE("NaN never holds, wherever it stands") {
  CHECK(outcome_of({not_a_number, 2.0, 0.0, "1", ""}) == Outcome::fails);
  CHECK(outcome_of({1.0, not_a_number, 0.0, "1", ""}) == Outcome::fails);
  CHECK(outcome_of({1.0, 2.0, not_a_number, "1", ""}) == Outcome::fails);
  CHECK(outcome_of({1.0, std::numeric_limits<double>::infinity(), 0.0, "1", ""}) == Outcome::fails);
  CHECK(outcome_of({3.0, 2.0, -2.0, "1", ""}) == Outcome::fails);
}

TEST_CASE("Worst keeps a NaN whatever comes after it") {
  Worst worst;
  worst.observe(3);
  CHECK(worst.value() == 3);
  worst.observe(not_a_number);
  worst.observe(5);
  CHECK(std::isnan(worst.value()));
}

TEST_CASE(
    "a row of another length or type, a short column and an unknown name are refused by name") {
  Table table{"orders", "Observed orders", {{"scheme", "1"}, {"order", "1"}}};
  const auto rejection = Contains("table 'orders' of columns [scheme, order]: ");
  CHECK_THROWS_WITH(table.row("A"), rejection && Contains("a row of 1 for 2 columns"));
  table.row("A", 2.0);
  CHECK_THROWS_WITH(table.row(1, 2.0), rejection && Contains("'scheme' holds texts, and row 2"));
  CHECK_THROWS_WITH(table.row("B", "two"), rejection && Contains("'order' holds numbers"));
  CHECK(table.rows() == 1);
  CHECK_THROWS_WITH(table.add({"floor", "1"}), rejection && Contains("0 values"));
  CHECK_THROWS_WITH(table.numbers("error"), rejection && Contains("no column 'error'"));
  CHECK_THROWS_WITH(table.numbers("scheme"), rejection && Contains("holds texts"));
  CHECK_THROWS_AS(
      (Table{{"a", "1", std::vector<double>{1, 2}}, {"b", "1", std::vector<double>{1}}}),
      std::logic_error);
}

TEST_CASE("the worst of a column keeps NaN, and is not a number where there is no row") {
  Table table{{"case", ""}, {"error", "1"}};
  CHECK(std::isnan(table.worst("error")));
  table.row("below", -3.0);
  CHECK(table.worst("error") == 0);
  table.row("largest", 7.0);
  table.row("small", 2.0);
  CHECK(table.worst("error") == 7);
  CHECK(table.worst_row("error") == 1);
  table.row("none", not_a_number);
  table.row("larger", 11.0);
  CHECK(std::isnan(table.worst("error")));
  CHECK(table.worst_row("error") == 3);
}

TEST_CASE("the worst row is judged in its column's unit, with the largest uncertainty of any row") {
  struct Estimate {
    double value, uncertainty;
  };
  Table table{{"case", ""}, {"error", "m"}, {"steps", "1"}};
  table.row("one", Estimate{3, 0.5}, 8);
  table.row("two", Estimate{5, 0.25}, 16);
  const Verdict verdict = judge_worst(table, "error", 6, "why", "note").verdict;
  CHECK(verdict.measured == 5);
  CHECK(verdict.uncertainty == 0.5);
  CHECK(verdict.bound == 6);
  CHECK(verdict.unit == "m");
  CHECK(judge_worst(table, 20, "why").verdict.measured == 16);
  table.row("three", Estimate{1, not_a_number}, 32);
  CHECK(outcome_of(judge_worst(table, "error", 6, "why").verdict) == Outcome::fails);
}

TEST_CASE("a check that throws fails and says why; one that is not offered is not applicable") {
  const Record broken =
      record_of_check([](const Subject&) -> Finding { throw std::runtime_error("out of cloth"); });
  CHECK(broken.outcome == Outcome::fails);
  CHECK(broken.finding.note == "stopped by an error: out of cloth");
  CHECK(std::isnan(broken.finding.verdict.measured));
  const Record absent = record_of_check([](Subject subject) -> Finding {
    subject.step = nullptr;
    require_offered(subject.step, "step");
    return {};
  });
  CHECK(absent.outcome == Outcome::not_applicable);
  CHECK(absent.finding.note == "the subject does not offer step");
  CHECK(std::isnan(absent.finding.verdict.measured));
}

TEST_CASE("verdicts as JSON: NaN becomes null, names stay") {
  Record record;
  record.name = "odd \"name\" <b>";
  record.outcome = Outcome::fails;
  record.finding.verdict.measured = not_a_number;
  RunRecord run;
  run.records = {record};
  CHECK_THAT(verdicts_json(run),
             Contains("\"measured\": null") && Contains("odd \\\"name\\\" <b>"));
}

TEST_CASE(
    "verdicts as JSON and XML: each outcome stands as it is, and none but what holds passes") {
  RunRecord run;
  for (const Outcome outcome :
       {Outcome::holds, Outcome::fails, Outcome::inconclusive, Outcome::not_applicable}) {
    Record record;
    record.name = "that it " + std::string(name_of(outcome));
    record.outcome = outcome;
    record.finding.note = "1 < 2 & 3";
    run.records.push_back(record);
    CHECK_THAT(verdicts_json(run),
               Contains("\"outcome\": \"" + std::string(outcome_text(record)) + "\""));
  }
  const ScratchFolder folder;
  write_verdicts(folder.file("."), run);
  CHECK_THAT(read_text(folder.file("junit.xml")),
             Contains("tests=\"4\" failures=\"2\" errors=\"0\" skipped=\"1\"") &&
                 Contains("1 &lt; 2 &amp; 3") && !Contains("1 < 2"));
}

TEST_CASE("faults are read with who catches them, and a key that no one knows is refused") {
  const ScratchFolder folder;
  const std::string row = fault_of("slip", "reference/mesh/a.cpp");
  folder.write("mesh.toml", row +
                                "caught_by = [\"sums.{add-up,end}.{x,y}\", \"sums.all\"]\n"
                                "fast = true\n"
                                "caught_by_tests = [\"one, and another\", \"test_sums\"]\n"
                                "[fault.next]\nfind = \"+\"\nreplace = \"-\"\nlaw = \"sums\"\n");
  const std::vector<Fault> faults = read_faults(folder.file("."));
  REQUIRE(faults.size() == 2);
  CHECK((faults[0].find == "a + b" && faults[0].replace == "a - b"));
  CHECK((faults[1].find == "+" && faults[1].replace == "-"));
  CHECK(faults[1].file == "reference/mesh/a.cpp");  // as in the row above
  CHECK(faults[0].caught_by == std::vector<std::string>{"sums.add-up.x", "sums.add-up.y",
                                                        "sums.end.x", "sums.end.y", "sums.all"});
  CHECK(faults[0].caught_by_tests == std::vector<std::string>{"one, and another", "test_sums"});
  std::vector<Record> records(2);
  records[0].name = "sums.end.y";
  name_faults(faults, records);
  CHECK(records[0].faults == std::vector<std::string>{"slip"});
  CHECK(records[1].faults.empty());
  folder.write("mesh.toml", row + "caught_bye = [\"sums.add-up\"]\n");
  CHECK_THROWS_WITH(read_faults(folder.file(".")),
                    Contains("mesh.toml:5: ") && Contains("caught_bye"));
}

TEST_CASE("a fault in the file of another room, and a name that is taken, are refused") {
  const ScratchFolder folder;
  for (const char* lacking : {".", "nowhere"})
    CHECK_THROWS_WITH(read_faults(folder.file(lacking)), Contains("there is no list of faults"));
  folder.write("forces.toml", fault_of("one", "reference/forces/a.cpp"));
  folder.write("mesh.toml", fault_of("two", "reference/mesh/a.cpp"));
  CHECK(read_faults(folder.file(".")).size() == 2);
  const auto refused = [&](const char* name, const char* file, const char* words) {
    folder.write("mesh.toml", fault_of(name, file));
    CHECK_THROWS_WITH(read_faults(folder.file(".")), Contains(words));
  };
  refused("two", "reference/forces/a.cpp", "mesh.toml:2: a fault in ");
  refused("two", "scripts/faults", "mesh.toml:2: ");
  refused("one", "reference/mesh/a.cpp", "mesh.toml:1: the name 'one' is taken at ");
  CHECK(room_of("verification/checks/forces/spring_checks.cpp") == "checks");
  CHECK(room_of("verification/verdict.cpp") == "verdict");
  CHECK(room_of("convergence/stability/sheet.cpp") == "convergence");
  CHECK(room_of("scripts/program/jobs.cpp") == "program");
}
