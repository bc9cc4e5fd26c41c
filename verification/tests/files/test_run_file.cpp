// A run's HDF5 file, read back through the library itself: nothing is missing, nothing is added.
#include <catch2/catch.hpp>
#include <fstream>

#include "verification/files/baseline_file.h"
#include "verification/files/findings_file.h"
#include "verification/files/hdf5_file.h"
#include "verification/files/results_file.h"
#include "verification/files/studies_file.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/files/hdf5_listing.h"

namespace foldproof {

namespace {

Listing written_by(const std::function<void(const Hdf5&)>& write) {
  const ScratchFolder folder;
  {
    Hdf5 file = Hdf5::create_file(folder.file("a.h5"));
    write(file);
    file.close();
  }
  return hdf5_listing(folder.file("a.h5"));
}

/// A finding with all that a record can hold.
Record full_record() {
  Record record;
  record.name = "law.full", record.kind = "bench", record.study = "of-steps";
  record.claim = "it is so", record.source = "BMF03 section 7";
  record.finding.verdict = {3.25, 4.5, 0.125, "steps", "empirical: twice the largest"};
  record.finding.evidence = Table{{"step", "s"}, {"case", ""}, {"error", "m"}};
  record.finding.evidence.row(0.5, "drape", -2.75);
  record.finding.evidence.row(0.25, "twist", 1e-9);
  record.finding.note = "a note", record.finding.headline = "three and a quarter";
  record.better = "lower", record.seconds = 6.5;
  record.faults = {"first-fault", "second-fault"};
  return record;
}

/// One without all that may be missing.
Record bare_record() {
  Record record;
  record.name = "law.bare", record.kind = "check";
  record.finding.verdict = {0.375, 0.75, 0, "1", "by hand"};
  record.outcome = Outcome::not_applicable;
  return record;
}

const Listing full_finding{{"@order", "0"},
                           {"@kind", "bench"},
                           {"@study", "of-steps"},
                           {"@claim", "it is so"},
                           {"@source", "BMF03 section 7"},
                           {"@measured", "3.25"},
                           {"@bound", "4.5"},
                           {"@uncertainty", "0.125"},
                           {"@unit", "steps"},
                           {"@why_bound", "empirical: twice the largest"},
                           {"@basis", "empirical"},
                           {"@scope", "specific"},
                           {"@certainty", "estimated"},
                           {"@outcome", "measured"},
                           {"@note", "a note"},
                           {"@headline", "three and a quarter"},
                           {"@seconds", "6.5"},
                           {"@faults", "[2] first-fault | second-fault"},
                           {"@better", "lower"},
                           {"", ""},
                           {"evidence/", ""},
                           {"evidence/step", "[2] 0.5 | 0.25"},
                           {"evidence/step@order", "0"},
                           {"evidence/step@unit", "s"},
                           {"evidence/case", "[2] drape | twist"},
                           {"evidence/case@order", "1"},
                           {"evidence/case@unit", ""},
                           {"evidence/error", "[2] -2.75 | 1e-09"},
                           {"evidence/error@order", "2"},
                           {"evidence/error@unit", "m"}};

const Listing bare_finding{{"@order", "1"},
                           {"@kind", "check"},
                           {"@study", ""},
                           {"@claim", ""},
                           {"@source", ""},
                           {"@measured", "0.375"},
                           {"@bound", "0.75"},
                           {"@uncertainty", "0"},
                           {"@unit", "1"},
                           {"@why_bound", "by hand"},
                           {"@basis", "reasoned"},
                           {"@scope", "specific"},
                           {"@certainty", "computed"},
                           {"@outcome", "not applicable"},
                           {"@note", ""},
                           {"@seconds", "0"},
                           {"", ""}};

/// The entries of `part` under the name of a group.
void add_below(const std::string& group, const Listing& part, Listing& all) {
  for (const auto& [name, value] : part) all[group + name] = value;
}

Listing both_findings() {
  Listing all{{"/findings/", ""}};
  add_below("/findings/law.full/", full_finding, all);
  add_below("/findings/law.bare/", bare_finding, all);
  return all;
}

/// A run with two of everything, but one study.
RunRecord full_run() {
  RunRecord run;
  run.provenance = {"v3", "c4", "dirty", "gcc", "-O7", "Odd", "a cpu", "a date", "a command", 5};
  run.tier = "full", run.subject = "a solver", run.subject_version = "v8";
  run.seed = 37, run.seconds = 12.25;
  run.records = {full_record(), bare_record()};
  run.studies = {{"lone-study", "so it is", "theory", "about it", 9.5, {}, {}, {}}};
  run.cases = {{"drape", "drape.h5", "Drape", "of a sheet", 3.5, "it diverged"},
               {"twist", "twist.h5", "Twist", "of a rope", 4.25, ""}};
  run.faults = {{"sign", "a.cpp", "+ b", "- b", "sum", {"law.full", "law.bare"}, {}, "caught"},
                {"size", "c.cpp", "3", "4", "count", {}, {"test one", "test two"}, "SURVIVED"}};
  Claim claim{"BMF03", "stiff", "7.3", "it is stiff", {}, Ruling::refuted, "if dry", "because"};
  claim.decided_by = {{"law.full", Role::limits}, {"law.bare", Role::contradicts}};
  claim.cited = {4, "We saw", "a + b", "a - b"};
  claim.missing = "a lab", claim.paper_title = "Folds (2003)";
  Claim other{"BFA02", "soft", "abstract", "it is soft", {}, Ruling::undecided, "", ""};
  run.claims = {{claim, {"holds", "missing"}, Ruling::conditional}, {other, {}, Ruling::undecided}};
  run.origins = {{"0123456789abcdef", "clean", "day 1", 12},
                 {"fedcba9876543", "dirty", "day 2", 1}};
  return run;
}

const char* const both_origins =
    "12 jobs on 0123456789 (clean), begun day 1; 1 job on fedcba9876 (dirty), begun day 2";

const Listing provenance_and_run{{"/", ""},
                                 {"/@schema", "1"},
                                 {"/@program", "foldproof"},
                                 {"/@version", "v3"},
                                 {"/@commit", "c4"},
                                 {"/@tree", "dirty"},
                                 {"/@compiler", "gcc"},
                                 {"/@flags", "-O7"},
                                 {"/@build_type", "Odd"},
                                 {"/@cpu", "a cpu"},
                                 {"/@cores", "5"},
                                 {"/@date", "a date"},
                                 {"/@command", "a command"},
                                 {"/@tier", "full"},
                                 {"/@seed", "37"},
                                 {"/@subject", "a solver"},
                                 {"/@subject_version", "v8"},
                                 {"/@seconds", "12.25"},
                                 {"/@parts", both_origins}};

const Listing study_and_cases{{"/studies/", ""},
                              {"/studies/lone-study/", ""},
                              {"/studies/lone-study/@order", "0"},
                              {"/studies/lone-study/@claim", "so it is"},
                              {"/studies/lone-study/@source", "theory"},
                              {"/studies/lone-study/@about", "about it"},
                              {"/studies/lone-study/@seconds", "9.5"},
                              {"/studies/lone-study/figures/", ""},
                              {"/studies/lone-study/maps/", ""},
                              {"/studies/lone-study/tables/", ""},
                              {"/cases/", ""},
                              {"/cases/drape/", ""},
                              {"/cases/drape/@order", "0"},
                              {"/cases/drape/@file", "drape.h5"},
                              {"/cases/drape/@title", "Drape"},
                              {"/cases/drape/@about", "of a sheet"},
                              {"/cases/drape/@seconds", "3.5"},
                              {"/cases/drape/@stopped", "it diverged"},
                              {"/cases/twist/", ""},
                              {"/cases/twist/@order", "1"},
                              {"/cases/twist/@file", "twist.h5"},
                              {"/cases/twist/@title", "Twist"},
                              {"/cases/twist/@about", "of a rope"},
                              {"/cases/twist/@seconds", "4.25"},
                              {"/cases/twist/@stopped", ""}};

const Listing both_claims{{"/claims/", ""},
                          {"/claims/stiff/", ""},
                          {"/claims/stiff/@order", "0"},
                          {"/claims/stiff/@paper", "BMF03"},
                          {"/claims/stiff/@paper_title", "Folds (2003)"},
                          {"/claims/stiff/@section", "7.3"},
                          {"/claims/stiff/@paragraph", "4"},
                          {"/claims/stiff/@begins", "We saw"},
                          {"/claims/stiff/@printed", "a + b"},
                          {"/claims/stiff/@restored", "a - b"},
                          {"/claims/stiff/@statement", "it is stiff"},
                          {"/claims/stiff/@ruling", "confirmed under a condition"},
                          {"/claims/stiff/@recorded", "refuted"},
                          {"/claims/stiff/@condition", "if dry"},
                          {"/claims/stiff/@why", "because"},
                          {"/claims/stiff/@missing", "a lab"},
                          {"/claims/stiff/@decided_by", "[2] law.full | law.bare"},
                          {"/claims/stiff/@roles", "[2] limits | contradicts"},
                          {"/claims/stiff/@outcomes", "[2] holds | missing"},
                          {"/claims/soft/", ""},
                          {"/claims/soft/@order", "1"},
                          {"/claims/soft/@paper", "BFA02"},
                          {"/claims/soft/@paper_title", ""},
                          {"/claims/soft/@section", "abstract"},
                          {"/claims/soft/@paragraph", "0"},
                          {"/claims/soft/@begins", ""},
                          {"/claims/soft/@printed", ""},
                          {"/claims/soft/@restored", ""},
                          {"/claims/soft/@statement", "it is soft"},
                          {"/claims/soft/@ruling", "undecided"},
                          {"/claims/soft/@recorded", "undecided"},
                          {"/claims/soft/@condition", ""},
                          {"/claims/soft/@why", ""},
                          {"/claims/soft/@missing", ""}};

/// The columns of the table of faults, each with its order and without a unit.
Listing fault_columns() {
  const std::pair<const char*, const char*> columns[] = {
      {"name", "sign | size"},
      {"file", "a.cpp | c.cpp"},
      {"find", "+ b | 3"},
      {"replace", "- b | 4"},
      {"law", "sum | count"},
      {"caught_by", "law.full, law.bare | "},
      {"caught_by_tests", " | test one\ntest two"},
      {"outcome", "caught | SURVIVED"}};
  Listing all{{"/faults/", ""}};
  int order = 0;
  for (const auto& [name, values] : columns) {
    const std::string path = std::string("/faults/") + name;
    all[path] = std::string("[2] ") + values;
    all[path + "@order"] = std::to_string(order++);
    all[path + "@unit"] = "";
  }
  return all;
}

}  // namespace

TEST_CASE("run file: a finding is written with all that it has, and with nothing that it lacks") {
  const Listing is = written_by([](const Hdf5& file) {
    write_findings(file, {full_record(), bare_record()});
  });
  Listing expected = both_findings();
  expected["/"] = "";
  CHECK(difference_of(is, expected) == "");
}

TEST_CASE("run file: a run is written whole") {
  const ScratchFolder folder;
  write_run(folder.file("run.h5"), full_run());
  Listing expected = both_findings();
  for (const Listing& part : {provenance_and_run, study_and_cases, both_claims, fault_columns()})
    expected.insert(part.begin(), part.end());
  CHECK(difference_of(hdf5_listing(folder.file("run.h5")), expected) == "");
}

TEST_CASE("run file: a run of nothing has its groups, but no parts and no faults") {
  const ScratchFolder folder;
  RunRecord run = full_run();
  run.records.clear(), run.studies.clear(), run.cases.clear(), run.claims.clear();
  run.faults.clear(), run.origins.clear();
  write_run(folder.file("run.h5"), run);
  Listing expected = provenance_and_run;
  expected.erase("/@parts");
  for (const char* group : {"/findings/", "/studies/", "/cases/", "/claims/"}) expected[group] = "";
  CHECK(difference_of(hdf5_listing(folder.file("run.h5")), expected) == "");
}

TEST_CASE("run file: the parts of a resumed run stand in their order") {
  RunRecord run;
  CHECK(origins_text(run) == "");
  run.origins = {{"0123456789abcdef", "clean", "day 1", 12},
                 {"fedcba9876543", "dirty", "day 2", 1}};
  CHECK(origins_text(run) == both_origins);
  CHECK(RunOrigin{"short", "unknown", "day 3", 0}.text() ==
        "0 jobs on short (unknown), begun day 3");
}

TEST_CASE("run file: numbers that nothing was entered for are zero") {
  const RunRecord run;
  CHECK((run.seed == 0 && run.seconds == 0 && run.provenance.cores == 0));
  CHECK((CaseRecord().seconds == 0 && RunOrigin().jobs == 0));
  const Declared declared;
  CHECK((declared.level == 0 && declared.order == 0 && declared.solve_tolerance == 0));
  const KeptVerdict kept;
  CHECK((kept.measured == 0 && kept.bound == 0));
}

TEST_CASE("run file: a file that cannot be written is named") {
  const ScratchFolder folder;
  CHECK_THROWS_WITH(write_run(folder.file("none/run.h5"), full_run()),
                    Catch::Contains("none/run.h5"));
}

}  // namespace foldproof
