// Verdicts: what holds, what fails, and that nothing that is NaN or stopped ever passes.
#include <catch2/catch.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <thread>

#include "reference/scene/key_file.h"
#include "verification/verdict.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/faults/faults.h"
#include "verification/subjects/reference_subject.h"
#include "verification/files/verdicts_file.h"

using namespace foldproof;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

Check check_that(std::function<Finding(const Subject&)> run) {
  return {"group.name", "A sentence.", "nowhere", std::move(run)};
}

}  // namespace

TEST_CASE("a verdict holds, fails, or cannot be decided") {
  CHECK(outcome_of({1.0, 2.0, 0.5, "1", ""}) == Outcome::holds);
  CHECK(outcome_of({1.5, 2.0, 0.5, "1", ""}) == Outcome::holds);
  CHECK(outcome_of({1.75, 2.0, 0.5, "1", ""}) == Outcome::inconclusive);
  CHECK(outcome_of({2.25, 2.0, 0.5, "1", ""}) == Outcome::inconclusive);
  CHECK(outcome_of({2.5, 2.0, 0.5, "1", ""}) == Outcome::inconclusive);
  CHECK(outcome_of({2.75, 2.0, 0.5, "1", ""}) == Outcome::fails);
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
  CHECK(worst.value() != worst.value());
}

TEST_CASE("a table fills its columns row by row, numbers and texts") {
  Table table{{"case", ""}, {"steps", "1"}, {"error", "m"}};
  table.row("coarse", 8, 0.25);
  table.row(std::string("fine"), 16L, 0.0625F);
  CHECK(table.rows() == 2);
  CHECK(table.texts("case") == std::vector<std::string>{"coarse", "fine"});
  CHECK(table.numbers("steps") == std::vector<double>{8, 16});
  CHECK(table.numbers("error") == std::vector<double>{0.25, 0.0625});
  CHECK(table.column("error").unit == "m");
  table.add({"order", "1", std::vector<double>{not_a_number, 2}});
  CHECK(table.columns().back().name == "order");
}

TEST_CASE(
    "a row of another length or type, a short column and an unknown name are refused by name") {
  Table table{"orders", "Observed orders", {{"scheme", "1"}, {"order", "1"}}};
  const auto rejection = Catch::Contains("table 'orders' of columns [scheme, order]: ");
  CHECK_THROWS_WITH(table.row("A"), rejection && Catch::Contains("a row of 1 for 2 columns"));
  table.row("A", 2.0);
  CHECK_THROWS_WITH(table.row(1, 2.0),
                    rejection && Catch::Contains("'scheme' holds texts, and row 2"));
  CHECK_THROWS_WITH(table.row("B", "two"), rejection && Catch::Contains("'order' holds numbers"));
  CHECK(table.rows() == 1);
  CHECK_THROWS_WITH(table.add({"floor", "1"}), rejection && Catch::Contains("0 values"));
  CHECK_THROWS_WITH(table.numbers("error"), rejection && Catch::Contains("no column 'error'"));
  CHECK_THROWS_WITH(table.numbers("scheme"), rejection && Catch::Contains("holds texts"));
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
  const Finding finding = judge_worst(table, "error", 6, "why", "note");
  CHECK(finding.verdict.measured == 5);
  CHECK(finding.verdict.uncertainty == 0.5);
  CHECK(finding.verdict.bound == 6);
  CHECK(finding.verdict.unit == "m");
  CHECK(finding.verdict.why_bound == "why");
  CHECK(finding.note == "note");
  CHECK(finding.evidence.numbers("error") == std::vector<double>{3, 5});
  CHECK(judge_worst(table, 20, "why").verdict.measured == 16);
  table.row("three", Estimate{1, not_a_number}, 32);
  CHECK(outcome_of(judge_worst(table, "error", 6, "why").verdict) == Outcome::fails);
}

TEST_CASE("a check's record has the time that it took") {
  const auto wait = [](const Subject&) -> Finding {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return {};
  };
  CHECK(run_check(check_that(wait), reference_subject()).seconds >= 0.02);
}

TEST_CASE("a check that throws fails and says why; one that is not offered is not applicable") {
  const Subject subject = reference_subject();
  const Record broken = run_check(
      check_that([](const Subject&) -> Finding { throw std::runtime_error("out of cloth"); }),
      subject);
  CHECK(broken.outcome == Outcome::fails);
  CHECK(broken.finding.note == "stopped by an error: out of cloth");
  CHECK(broken.finding.verdict.why_bound == "it must run to its end");
  CHECK(std::isnan(broken.finding.verdict.measured));
  const Record absent =
      run_check(check_that([](const Subject&) -> Finding { throw NotOffered{"step"}; }), subject);
  CHECK(absent.outcome == Outcome::not_applicable);
  CHECK(absent.finding.note == "the subject does not offer step");
  CHECK(absent.finding.verdict.why_bound.empty());
  CHECK(std::isnan(absent.finding.verdict.measured));
}

TEST_CASE("an operation that a subject lacks is reported by name") {
  Subject subject = reference_subject();
  subject.step = nullptr;
  CHECK_THROWS_AS(require_offered(subject.step, "step"), NotOffered);
}

TEST_CASE("verdicts as JSON: NaN becomes null, names stay") {
  RunRecord run;
  Record record;
  record.name = "odd \"name\" <b>";
  record.outcome = Outcome::fails;
  record.finding.verdict.measured = not_a_number;
  run.records.push_back(record);
  const std::string json = verdicts_json(run);
  CHECK(json.find("\"measured\": null") != std::string::npos);
  CHECK(json.find("odd \\\"name\\\" <b>") != std::string::npos);
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
  }
  const std::string json = verdicts_json(run);
  for (const Record& record : run.records) {
    const std::string text(outcome_text(record));
    INFO(text);
    CHECK(json.find("\"outcome\": \"" + text + "\"") != std::string::npos);
  }
  const ScratchFolder folder;
  write_verdicts(folder.file("."), run);
  const std::string xml = read_text(folder.file("junit.xml"));
  CHECK(xml.find("tests=\"4\" failures=\"2\" errors=\"0\" skipped=\"1\"") != std::string::npos);
  CHECK(xml.find("1 &lt; 2 &amp; 3") != std::string::npos);
  CHECK(xml.find("1 < 2") == std::string::npos);
}

TEST_CASE("faults are read with who catches them, and a key that no one knows is refused") {
  const ScratchFolder folder;
  const std::string row =
      "[[fault]]\nname = \"slip\"\nfile = \"reference/mesh/a.cpp\"\nfind = \"+\"\nreplace = \"-\"\n"
      "law = \"sums\"\n";
  const std::string path = folder.file("mesh.toml");
  std::ofstream(path) << row << "caught_by = [\"sums.add-up\"]\nfast = true\n"
                      << "caught_by_tests = [\"one, and another\", \"test_sums\"]\n";
  std::ofstream(folder.file("equivalent_mutants.toml")) << "[[mutant]]\n";
  const std::vector<Fault> faults = read_faults(folder.file("."));
  REQUIRE(faults.size() == 1);
  CHECK(faults[0].caught_by == std::vector<std::string>{"sums.add-up"});
  CHECK(faults[0].caught_by_tests == std::vector<std::string>{"one, and another", "test_sums"});
  Record record;
  record.name = "sums.add-up";
  std::vector<Record> records = {record, {}};
  name_faults(faults, records);
  CHECK(records[0].faults == std::vector<std::string>{"slip"});
  CHECK(records[1].faults.empty());
  std::ofstream(path) << row << "caught_bye = [\"sums.add-up\"]\n";
  CHECK_THROWS_WITH(read_faults(folder.file(".")),
                    Catch::Contains("mesh.toml:7: ") && Catch::Contains("caught_bye"));
}

TEST_CASE("a fault in the file of another room, and a name that is taken, are refused") {
  const auto row = [](const std::string& name, const std::string& file) {
    return "[[fault]]\nname = \"" + name + "\"\nfile = \"" + file +
           "\"\nfind = \"+\"\nreplace = \"-\"\nlaw = \"sums\"\n";
  };
  const ScratchFolder folder;
  CHECK_THROWS_WITH(read_faults(folder.file(".")), Catch::Contains("there is no list of faults"));
  CHECK_THROWS_WITH(read_faults(folder.file("nowhere")),
                    Catch::Contains("there is no list of faults"));
  std::ofstream(folder.file("forces.toml")) << row("one", "reference/forces/a.cpp");
  std::ofstream(folder.file("mesh.toml")) << row("two", "reference/mesh/a.cpp");
  CHECK(read_faults(folder.file(".")).size() == 2);
  std::ofstream(folder.file("mesh.toml")) << row("two", "reference/forces/a.cpp");
  CHECK_THROWS_WITH(read_faults(folder.file(".")),
                    Catch::Contains("mesh.toml:3: ") && Catch::Contains("belongs in forces.toml"));
  std::ofstream(folder.file("mesh.toml")) << row("two", "scripts/faults");
  CHECK_THROWS_WITH(read_faults(folder.file(".")),
                    Catch::Contains("mesh.toml:3: ") && Catch::Contains("no list"));
  std::ofstream(folder.file("mesh.toml")) << row("one", "reference/mesh/a.cpp");
  CHECK_THROWS_WITH(read_faults(folder.file(".")),
                    Catch::Contains("mesh.toml:2: the name 'one' is taken at ") &&
                        Catch::Contains("forces.toml:2"));
}

TEST_CASE("the room of a file is its folder, or its name where it has none") {
  CHECK(room_of("reference/forces/springs.cpp") == "forces");
  CHECK(room_of("verification/checks/forces/spring_checks.cpp") == "checks");
  CHECK(room_of("verification/verdict.cpp") == "verdict");
  CHECK(room_of("reference/types.h") == "types");
  CHECK(room_of("convergence/stability/sheet.cpp") == "convergence");
  CHECK(room_of("scripts/program/jobs.cpp") == "program");
  CHECK(room_of("scripts/faults").empty());
}

TEST_CASE("a map is written with one value for each of its points, or refused") {
  const Map whole{"map",
                  "Title",
                  {"x", "m", Scale::linear},
                  {"y", "s", Scale::log},
                  {1, 3, 7},
                  {0.5, 4},
                  {11, 12, 13, 21, 22, not_a_number},
                  "quantity",
                  "1",
                  Scale::linear,
                  "",
                  {}};
  Map short_of_one = whole;
  short_of_one.values.pop_back();
  RunRecord run;
  run.studies.push_back({"study", "", "", "", 0, {}, {whole}, {}});
  const ScratchFolder folder;
  const std::string path = folder.file("map.h5");
  CHECK_NOTHROW(write_run(path, run));
  run.studies[0].maps = {short_of_one};
  CHECK_THROWS_WITH(write_run(path, run), Catch::Contains("5 values for 3 x 2 points"));
}
