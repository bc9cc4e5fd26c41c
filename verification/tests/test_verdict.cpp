// Verdicts: what holds, what fails, and that nothing that is NaN or stopped ever passes.
#include <catch2/catch.hpp>
#include <algorithm>
#include <fstream>
#include <limits>
#include <stdexcept>

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
  worst.see(3);
  CHECK(worst.value() == 3);
  worst.see(not_a_number);
  worst.see(5);
  CHECK(worst.value() != worst.value());
}

TEST_CASE("a check that throws fails and says why; one that is not offered is not applicable") {
  const Subject subject = reference_subject();
  const Record broken = run_check(
      check_that([](const Subject&) -> Finding { throw std::runtime_error("out of cloth"); }), subject);
  CHECK(broken.outcome == Outcome::fails);
  CHECK(broken.finding.note.find("out of cloth") != std::string::npos);
  const Record absent =
      run_check(check_that([](const Subject&) -> Finding { throw NotOffered{"step"}; }), subject);
  CHECK(absent.outcome == Outcome::not_applicable);
}

TEST_CASE("an operation that a subject lacks is reported by name") {
  Subject subject = reference_subject();
  subject.step = nullptr;
  CHECK_THROWS_AS(offered(subject.step, "step"), NotOffered);
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

TEST_CASE("verdicts as JSON and XML: each outcome stands as it is, and none but what holds passes") {
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
  CHECK_THROWS_WITH(read_faults(folder.file("nowhere")), Catch::Contains("there is no list of faults"));
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
  CHECK_THROWS_WITH(
      read_faults(folder.file(".")),
      Catch::Contains("mesh.toml:2: the name 'one' is taken at ") && Catch::Contains("forces.toml:2"));
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
