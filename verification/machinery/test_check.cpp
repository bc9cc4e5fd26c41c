// Verdicts: what holds, what fails, and that nothing that is NaN or stopped ever passes.
#include <catch2/catch.hpp>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include "verification/check.h"
#include "verification/subject.h"
#include "verification/verdicts_file.h"

using namespace foldproof;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

Check check_that(std::function<Finding(const Subject&)> run) {
  return {"group.name", "A sentence.", "nowhere", std::move(run)};
}

}  // namespace

TEST_CASE("a verdict holds, fails, or cannot be decided") {
  CHECK(ruling({1.0, 2.0, 0.5, "1", ""}) == Ruling::holds);
  CHECK(ruling({1.5, 2.0, 0.5, "1", ""}) == Ruling::holds);
  CHECK(ruling({1.75, 2.0, 0.5, "1", ""}) == Ruling::inconclusive);
  CHECK(ruling({2.25, 2.0, 0.5, "1", ""}) == Ruling::inconclusive);
  CHECK(ruling({2.75, 2.0, 0.5, "1", ""}) == Ruling::fails);
}

TEST_CASE("NaN never holds, wherever it stands") {
  CHECK(ruling({not_a_number, 2.0, 0.0, "1", ""}) == Ruling::fails);
  CHECK(ruling({1.0, not_a_number, 0.0, "1", ""}) == Ruling::fails);
  CHECK(ruling({1.0, 2.0, not_a_number, "1", ""}) == Ruling::fails);
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
  CHECK(broken.outcome == "fails");
  CHECK(broken.finding.note.find("out of cloth") != std::string::npos);
  const Record absent =
      run_check(check_that([](const Subject&) -> Finding { throw NotOffered{"step"}; }), subject);
  CHECK(absent.outcome == "not applicable");
}

TEST_CASE("a study that throws fails under its own name") {
  const Study study{"sums", "A sentence.", "", "", [](const Subject&, Tier, const Progress&) -> StudyResult {
                      throw std::runtime_error("no convergence");
                    }};
  const auto [records, whole] = run_study(study, reference_subject(), Tier::quick, [](double) {});
  REQUIRE(records.size() == 1);
  CHECK(records[0].name == "sums");
  CHECK(records[0].outcome == "fails");
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
  record.outcome = "fails";
  record.finding.verdict.measured = not_a_number;
  run.records.push_back(record);
  const std::string json = verdicts_json(run);
  CHECK(json.find("\"measured\": null") != std::string::npos);
  CHECK(json.find("odd \\\"name\\\" <b>") != std::string::npos);
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
  const std::filesystem::path folder = std::filesystem::temp_directory_path();
  const std::string path = (folder / "foldproof machinery map.h5").string();
  CHECK_NOTHROW(write_run(path, run));
  std::filesystem::remove(path);
  run.studies[0].maps = {short_of_one};
  CHECK_THROWS_WITH(write_run(path, run), Catch::Contains("5 values for 3 x 2 points"));
  std::filesystem::remove(path + ".partial");
}
