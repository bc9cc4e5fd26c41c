// Studies: each finding is judged, and one that throws fails.
#include <catch2/catch.hpp>
#include <stdexcept>

#include "convergence/headlines.h"
#include "convergence/studies.h"
#include "convergence/study.h"
#include "verification/subjects/reference_subject.h"

using namespace foldproof;

TEST_CASE("a study that throws fails under its own name") {
  const Study study{"sums", "A sentence.", "", "",
                    [](const Subject&, Tier, const Progress&) -> StudyResult {
                      throw std::runtime_error("no convergence");
                    }};
  const auto [records, whole] = run_study(study, reference_subject(), Tier::quick, [](double) {});
  REQUIRE(records.size() == 1);
  CHECK(records[0].name == "sums");
  CHECK(records[0].outcome == Outcome::fails);
}

TEST_CASE("each finding of a study is judged by its own verdict") {
  const Study study{"sums", "A sentence.", "", "", [](const Subject&, Tier, const Progress&) {
                      StudyResult result;
                      for (const double measured : {1.0, 3.0, 2.25, foldproof::nan})
                        result.findings.push_back(
                            {"sums.one", "A sentence.", {{measured, 2, 0.5, "1", ""}, {}, ""}});
                      return result;
                    }};
  const auto [records, whole] = run_study(study, reference_subject(), Tier::quick, [](double) {});
  REQUIRE(records.size() == 4);
  CHECK(records[0].outcome == Outcome::holds);
  CHECK(records[1].outcome == Outcome::fails);
  CHECK(records[2].outcome == Outcome::inconclusive);
  CHECK(records[3].outcome == Outcome::fails);
}

TEST_CASE("the sentence of every study names the findings that it rests on") {
  for (const Study& study : all_studies()) {
    INFO(study.name);
    CHECK_FALSE(headline_families(study.name).empty());
  }
}

TEST_CASE("a study fails that does not measure what its sentence rests on") {
  const auto bend = [](const char* last) {
    return Study{"bending-scaling", "A sentence.", "", "",
                 [=](const Subject&, Tier, const Progress&) {
                   StudyResult result;
                   for (const char* name : {"edge-factor-vanishes-with-cell-width", last})
                     result.findings.push_back({std::string("bending-scaling.") + name,
                                                "A sentence.",
                                                {{1, 2, 0, "1", ""}, {}, ""}});
                   return result;
                 }};
  };
  const auto outcome = [](const Study& study) {
    return run_study(study, reference_subject(), Tier::quick, [](double) {}).first[0].outcome;
  };
  CHECK(outcome(bend("edge-squared-over-area-factor-tends-to-a-constant")) == Outcome::holds);
  CHECK(outcome(bend("edge-squared-over-area-factor-tends-to-a-constant.fine")) == Outcome::holds);
  CHECK(outcome(bend("edge-squared-over-area-factor-tends")) == Outcome::fails);
  CHECK(outcome(bend("edge-squared-over-area-factor-tends-to-a-constant-too")) == Outcome::fails);
}
