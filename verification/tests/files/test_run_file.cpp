// A run's HDF5 file, read back through the library itself: nothing is missing, nothing is added.
// And the results of one job, kept and read again.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "verification/files/part_file.h"
#include "verification/files/results_file.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/files/hdf5_listing.h"
#include "verification/tests/files/results_specimen.h"
#include "verification/tests/files/small_files.h"

namespace foldproof {

namespace {

using Json = nlohmann::json;

const char* const both_origins =
    "12 jobs on 0123456789 (clean), begun day 1; 1 job on fedcba9876 (dirty), begun day 2";

const PartOf of_job{"strain-sweeps", "0123", "full", 7};
const RunOrigin origin{"89abcdef", "dirty", "a date", 5};

/// All of a run's records, studies and cases, as they stand in its file.
Listing listing_of(const RunRecord& run) {
  const ScratchFolder scratch;
  RunRecord part;
  part.records = run.records, part.studies = run.studies, part.cases = run.cases;
  write_run(scratch.file("run.h5"), part);
  return hdf5_listing(scratch.file("run.h5"));
}

/// With numbers that a text would not keep, and outcomes of all kinds.
RunRecord part_specimen() {
  struct Estimate {
    double value, uncertainty;
  };
  RunRecord part = full_run();
  Record& record = part.records[0];
  record.finding.verdict = {0.1 + 0.2, 1e-300, -0.0, "m", "why"};
  Table evidence("e.name", "e.title", Table{{"estimate", "m"}});
  evidence.row(Estimate{std::nan(""), 0.25});
  record.finding.evidence = evidence;
  part.records.resize(3);
  part.records[2].name = "law.third", part.records[2].outcome = Outcome::holds;
  part.studies[0].figures[0].curves[0].floor = -INFINITY;
  return part;
}

}  // namespace

TEST_CASE("run file: a run is written whole, without faults and parts if it has none") {
  const ScratchFolder folder;
  const std::string path = folder.file("run.h5");
  RunRecord run = full_run();
  run.records.clear(), run.studies.clear();
  Listing root;
  add_listed(root, "/", R"(@schema = 1; @program = foldproof; @version = v3; @commit = c4
    @tree = dirty; @compiler = gcc; @flags = -O7; @build_type = Odd; @cpu = a cpu; @cores = 5
    @date = a date; @command = a command; @tier = full; @seed = 37; @subject = a solver
    @subject_version = v8; @seconds = 12.25; findings/; studies/; cases/; claims/)");
  Listing all = root;
  all["/@parts"] = both_origins;
  add_listed(all, "/cases/drape/", R"(@order = 0; @file = drape.h5; @title = Drape
    @about = of a sheet; @seconds = 3.5; @stopped = it diverged)");
  add_listed(all, "/cases/twist/", R"(@order = 1; @file = twist.h5; @title = Twist
    @about = of a rope; @seconds = 4.25; @stopped)");
  add_listed(all, "/claims/stiff/", R"(@order = 0; @paper = BMF03; @paper_title = Folds (2003)
    @section = 7.3; @paragraph = 4; @begins = We saw; @printed = a + b; @restored = a - b
    @statement = it is > stiff; @ruling = confirmed under a condition; @recorded = refuted
    @condition = if dry; @why = because; @missing = a lab
    @decided_by = [2] law.full | law.bare; @roles = [2] limits | contradicts
    @outcomes = [2] fails | missing)");
  write_run(path, run);
  CHECK(difference_of(hdf5_listing(path), all) == "");
  run.cases.clear(), run.claims.clear(), run.origins.clear();
  write_run(path, run);
  CHECK(difference_of(hdf5_listing(path), root) == "");
  run.faults = {{"sign", "a.cpp", "+ b", "- b", "sum", {"law.full", "law.bare"}, {}, "caught"},
                {"size", "c.cpp", "3", "4", "count", {}, {"test one", "test two"}, "SURVIVED"}};
  add_listed(root, "/faults/", R"(name = [2] sign | size; file = [2] a.cpp | c.cpp
    find = [2] + b | 3; replace = [2] - b | 4; law = [2] sum | count
    caught_by = [2] law.full, law.bare | ; outcome = [2] caught | SURVIVED)");
  root["/faults/caught_by_tests"] = "[2]  | test one\ntest two";
  add_listed(root, "/faults/", R"(name@order = 0; file@order = 1; find@order = 2; law@order = 4
    replace@order = 3; caught_by@order = 5; caught_by_tests@order = 6; outcome@order = 7
    name@unit; file@unit; find@unit; law@unit; replace@unit; caught_by@unit
    caught_by_tests@unit; outcome@unit)");
  write_run(path, run);
  CHECK(difference_of(hdf5_listing(path), root) == "");
  CHECK_THROWS_WITH(write_run(folder.file("none/run.h5"), run), Catch::Contains("none/run.h5"));
}

TEST_CASE("kept results: what is read and written again is the same to the bit") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("part"), again = scratch.file("again");
  const RunRecord part = part_specimen();
  write_part(path, of_job, origin, part);
  const std::optional<RunRecord> read = read_part(path, of_job);
  REQUIRE(read);
  CHECK(difference_of(listing_of(*read), listing_of(part)) == "");
  REQUIRE(read->origins.size() == 1);
  CHECK(read->origins.front().text() == "1 job on 89abcdef (dirty), begun a date");
  CHECK((!read->records[0].outcome && read->records[2].outcome == Outcome::holds));
  CHECK(std::signbit(read->records[0].finding.verdict.uncertainty));
  const Table& evidence = read->records[0].finding.evidence;
  CHECK((evidence.name == "e.name" && evidence.title == "e.title"));
  CHECK(evidence.columns()[0].uncertainty == 0.25);
  write_part(again, of_job, origin, *read);
  CHECK(bytes_of_file(again) == bytes_of_file(path));
}

TEST_CASE("kept results: those of another program, tier, seed or job, and damaged ones, are none") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("part");
  CHECK(!read_part(path, of_job));
  write_part(path, of_job, origin, part_specimen());
  for (const PartOf& other : {PartOf{"other", "0123", "full", 7},
                              {"strain-sweeps", "1", "full", 7},
                              {"strain-sweeps", "0123", "quick", 7},
                              {"strain-sweeps", "0123", "full", 8}})
    CHECK(!read_part(path, other));
  const std::string bytes = bytes_of_file(path);
  const auto is_part = [&](const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
    return read_part(path, of_job).has_value();
  };
  const Json whole = Json::from_cbor(bytes);
  const auto is_json_part = [&](const Json& json) {
    const std::vector<std::uint8_t> cbor = Json::to_cbor(json);
    return is_part({cbor.begin(), cbor.end()});
  };
  CHECK((is_part(bytes) && !is_part(bytes + "x")));
  for (const size_t length : {size_t(0), size_t(1), bytes.size() / 2, bytes.size() - 1})
    CHECK(!is_part(bytes.substr(0, length)));
  CHECK((!is_json_part(Json::array({1, 2})) && !is_json_part(Json::object())));
  for (const char* key : {"of", "origin", "records", "studies", "cases"}) {
    Json odd = whole;
    odd[key] = 7;
    CHECK(!is_json_part(odd));
  }
  Json newer = whole;
  newer["of"]["layout"] = 2;
  CHECK(!is_json_part(newer));
}

}  // namespace foldproof
