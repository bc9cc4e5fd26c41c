// Studies: each finding is judged, and one that throws fails.
#include <catch2/catch.hpp>
#include <stdexcept>

#include "convergence/studies.h"
#include "convergence/study.h"
#include "verification/subjects/reference_subject.h"

using namespace foldproof;

namespace {

std::vector<Record> records_of_study(const std::string& name,
                                     const std::function<StudyResult()>& result,
                                     const std::vector<std::string>& rests_on = {}) {
  const Study study{name,     "A sentence.",
                    rests_on, "",
                    "",       [&](const Subject&, Tier, const Progress&) { return result(); }};
  return run_study(study, reference_subject(), Tier::quick, [](double) {}).first;
}

}  // namespace

TEST_CASE("a study that throws fails under its own name") {
  const auto records =
      records_of_study("sums", []() -> StudyResult { throw std::runtime_error("no convergence"); });
  REQUIRE(records.size() == 1);
  CHECK(records[0].name == "sums");
  CHECK(records[0].outcome == Outcome::fails);
}

TEST_CASE("each finding of a study is judged by its own verdict") {
  std::vector<Outcome> outcomes;
  for (const Record& record : records_of_study("sums", [] {
         StudyResult result;
         for (const double measured : {1.0, 3.0, 2.25, foldproof::nan})
           result.findings.push_back({"sums.one", "", {{measured, 2, 0.5, "1", ""}, {}, ""}});
         return result;
       }))
    outcomes.push_back(*record.outcome);
  CHECK(outcomes == std::vector<Outcome>{Outcome::holds, Outcome::fails, Outcome::inconclusive,
                                         Outcome::fails});
}

TEST_CASE("a study fails that does not measure what its sentence rests on") {
  const auto outcome = [](const std::string& last) {
    return *records_of_study(
                "sums",
                [&] {
                  StudyResult result;
                  for (const std::string& name : {std::string("falls-with-the-step"), last})
                    result.findings.push_back({"sums." + name, "", {{1, 2, 0, "1", ""}, {}, ""}});
                  return result;
                },
                {"falls-with-the-step", "is-bounded"})[0]
                .outcome;
  };
  for (const char* last : {"is-bounded", "is-bounded.fine"}) CHECK(outcome(last) == Outcome::holds);
  for (const char* last : {"is", "is-bounded-too"}) CHECK(outcome(last) == Outcome::fails);
  for (const Study& study : all_studies()) CHECK_FALSE(study.rests_on.empty());
}
