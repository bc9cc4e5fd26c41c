#include <catch2/catch.hpp>

#include "convergence/study.h"
#include "convergence/validation/comparison.h"
#include "verification/subject.h"

using namespace foldproof;

TEST_CASE("a comparison agrees, differs or cannot tell, by both uncertainties together") {
  const auto of = [](double simulated, double numerical, double scatter) {
    return agreement_of({"", simulated, numerical, {5, scatter}}, .7);
  };
  CHECK(of(5.4, .3, .4) == Agreement::agrees);  // u = .5
  CHECK(of(4.6, .3, .4) == Agreement::agrees);
  CHECK(of(5.6, .3, .4) == Agreement::differs);
  CHECK(of(4.4, .3, .4) == Agreement::differs);
  CHECK(of(5.6, .6, .8) == Agreement::cannot_tell);  // u = 1
  CHECK(of(6.1, .6, .8) == Agreement::differs);      // more than even this u explains
  CHECK(of(std::nan(""), .3, .4) == Agreement::cannot_tell);
  CHECK(of(5.1, INFINITY, .4) == Agreement::cannot_tell);
  const auto judged = [](double simulated, double numerical) {
    Table table = no_comparisons("m");
    add_comparison(table, {"height", 2.99, .01, {3, 0}}, .4);
    add_comparison(table, {"width", simulated, numerical, {3, 0}}, .4);
    return outcome_of(judge_comparisons(table, .4, "why", "").verdict);
  };
  CHECK(judged(3.2, .1) == Outcome::holds);
  CHECK(judged(3.2, .3) == Outcome::inconclusive);
  CHECK(judged(3.6, .1) == Outcome::fails);
  CHECK(judged(std::nan(""), .1) == Outcome::fails);
}

TEST_CASE("findings of a validation say their kind") {
  const auto run = [](const Subject&, Tier, const Progress&) {
    return StudyResult{{{"loop.height", "", {{1, 2, 0, "1", "why"}, {}, ""}}}, {}, {}, {}};
  };
  for (const std::string kind : {"validation", "study"})
    CHECK(run_study({"loop", "", {}, "", "", run, kind}, {}, Tier::quick, [](double) {})
              .first.at(0)
              .kind == kind);
}
