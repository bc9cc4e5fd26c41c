// Results of one job, kept and read again: all that a report shows, to the bit.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "verification/files/part_file.h"

namespace foldproof {
namespace {

const PartOf of_job{"strain-sweeps", "0123", "full", 7};
const RunOrigin origin{"89abcdef", "dirty", "2031-02-03T04:05:06Z", 1};

std::string temporary() {
  return (std::filesystem::temp_directory_path() / ("part-" + std::to_string(::getpid()))).string();
}

RunRecord made_up() {
  RunRecord part;
  Record record;
  record.name = "strain-sweeps.a";
  record.kind = "study";
  record.study = "strain-sweeps";
  record.claim = "a claim with \"quotes\" and \xce\xb1";
  record.source = "section 4";
  record.finding = {{0.1 + 0.2, 1e-300, -0.0, "m", "why"},
                    Table{{"case", "1"}, {"measured", "m"}}.with_row("one", nan),
                    "a note"};
  record.outcome = Outcome::inconclusive;
  record.better = "lower";
  record.seconds = 1.0 / 3;
  part.records = {record, Record{}};
  StudyRecord study;
  study.name = "strain-sweeps";
  study.about = "about";
  study.claim = "claim";
  study.source = "source";
  study.seconds = 2;
  Curve curve{"A", {1, 2}, {nan, std::numeric_limits<double>::infinity()}, nan, {1.5}};
  curve.slope = -2;
  curve.marks = {Mark::measured, Mark::diverged};
  study.figures = {{"f", "F", {"x", "s", Scale::log}, {"y", "m", Scale::linear}, 2, "c", {curve}}};
  study.maps = {{"m",
                 "M",
                 {"x", "1", Scale::linear},
                 {"y", "1", Scale::log},
                 {1, 2},
                 {3},
                 {4, nan},
                 "q",
                 "J",
                 Scale::log,
                 "caption",
                 {curve}}};
  study.tables = {Table("t", "T", Table{{"n", "1"}}.with_row(3))};
  part.studies = {study};
  part.cases = {{"drop", "drop.h5", "Drop", "about a drop", 4.5, "it stopped"}};
  return part;
}

/// The bytes of a file: equal ones tell of equal contents, NaN and -0 too.
std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST_CASE("kept results: what is read and written again is the same to the bit") {
  const std::string path = temporary(), again = path + "-again";
  write_part(path, of_job, origin, made_up());
  const std::optional<RunRecord> read = read_part(path, of_job);
  REQUIRE(read);
  CHECK(read->origins.front().text() == "1 job on 89abcdef (dirty), begun 2031-02-03T04:05:06Z");
  REQUIRE(read->records.size() == 2);
  const Record& record = read->records.front();
  CHECK(record.finding.verdict.measured == 0.1 + 0.2);
  CHECK(std::signbit(record.finding.verdict.uncertainty));
  CHECK(record.finding.evidence.texts("case").front() == "one");
  CHECK(std::isnan(record.finding.evidence.numbers("measured").front()));
  CHECK(record.outcome == Outcome::inconclusive);
  CHECK(!read->records.back().outcome);
  CHECK(read->studies.front().figures.front().curves.front().marks.back() == Mark::diverged);
  CHECK(read->studies.front().maps.front().scale == Scale::log);
  CHECK(read->studies.front().tables.front().numbers("n").front() == 3);
  CHECK(read->cases.front().stopped == "it stopped");
  write_part(again, of_job, origin, *read);
  CHECK(bytes_of(again) == bytes_of(path));
  std::filesystem::remove(path);
  std::filesystem::remove(again);
}

TEST_CASE("kept results: those of another program, tier, seed or job, and damaged ones, are none") {
  const std::string path = temporary();
  CHECK(!read_part(path, of_job));
  write_part(path, of_job, origin, made_up());
  for (const PartOf& other : {PartOf{"other", "0123", "full", 7},
                              {"strain-sweeps", "1", "full", 7},
                              {"strain-sweeps", "0123", "quick", 7},
                              {"strain-sweeps", "0123", "full", 8}})
    CHECK(!read_part(path, other));
  const std::string whole = bytes_of(path);
  for (const size_t length : {size_t(0), size_t(1), whole.size() / 2, whole.size() - 1}) {
    std::ofstream(path, std::ios::binary) << whole.substr(0, length);
    CHECK(!read_part(path, of_job));
  }
  std::filesystem::remove(path);
}

}  // namespace foldproof
