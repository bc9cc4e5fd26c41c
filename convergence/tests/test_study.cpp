// Studies: each finding is judged, and one that throws fails.
#include <catch2/catch.hpp>
#include <stdexcept>

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
