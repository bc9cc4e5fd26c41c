#include <catch2/catch.hpp>
#include <cmath>

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
}

TEST_CASE("a comparison says its outcome with the numbers") {
  CHECK(words_of({"", 5.4, .3, {5, .4}}, .7) == "agrees within 0.5");
  CHECK(words_of({"", 4.2, .3, {5, .4}}, .7) == "differs by -0.8 +- 0.5");
  CHECK(words_of({"", 5.4, .6, {5, .8}}, .7) == "cannot tell: u = 1 is more than 0.7");
}

TEST_CASE("comparisons hold, fail or are inconclusive by |S - D| and u against the resolution") {
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
  const auto kind_of = [](const Study& study) {
    return run_study(study, Subject{}, Tier::quick, [](double) {}).first.at(0).kind;
  };
  CHECK(kind_of({"loop", "", "", "", run, "validation"}) == "validation");
  CHECK(kind_of({"loop", "", "", "", run}) == "study");
}
