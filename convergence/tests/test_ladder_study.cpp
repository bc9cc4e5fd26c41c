// The study that `foldproof converge` writes for reports.
#include <catch2/catch.hpp>

#include "convergence/any_case/converge.h"
#include "convergence/any_case/solver_ladder.h"

namespace foldproof {

using Catch::Matchers::Contains;

namespace {

QuantityOverLevels quantity_of(const std::string& name, const std::vector<double>& differences) {
  return {name, "m", {}, differences, error_bar({{}, differences, 2, 2, 0}), 0.5};
}

LadderAnswer answer_of(std::vector<QuantityOverLevels> quantities) {
  const std::vector<double> sizes = {0.08, 0.04, 0.02, 0.01};
  LadderAnswer answer{"strip",
                      "C",
                      "time",
                      sizes,
                      {1, 2, 4, 8},
                      {3, 6, 12, 24},
                      {"", "", "", "fell"},
                      std::move(quantities),
                      {4, 4, 4, 4}};
  answer.formal_order = 2;
  return answer;
}

}  // namespace

TEST_CASE("the asymptotic range reaches back as long as orders agree") {
  const auto M = Mark::measured, U = Mark::unfinished;
  // orders 1, 2, 2
  CHECK(range_marks(quantity_of("x", {2, 1, 0.25, 0.0625})) == std::vector<Mark>{U, M, M, M});
  CHECK(range_marks(quantity_of("x", {16, 4, 1, 0.25})) == std::vector<Mark>{M, M, M, M});
  CHECK(range_marks(quantity_of("x", {4, 1, 0.5})) == std::vector<Mark>{U, U, U});
  CHECK(range_marks(quantity_of("x", {1, 2, 4})) == std::vector<Mark>{U, U, U});
}

TEST_CASE("an error is halved by its order, or by a level, or in no known way") {
  LadderAnswer settled = answer_of({quantity_of("positions", {16, 4, 1})});  // work doubles a level
  CHECK(how_to_halve(settled) ==
        "Steps 1.41 times shorter (0.057 s) halve that error, at 1.4 times the work.");
  settled.in = "space";
  settled.particles = {4, 8, 16, 32};
  CHECK(how_to_halve(settled) ==
        "Edges 1.41 times shorter (0.057 m) halve that error, at 2.0 times the work.");
  // the levels' errors, each its distance to the finest and that one's bar of 6: 28, 12, 8, 6
  LadderAnswer unsettled = answer_of({quantity_of("positions", {16, 4, 2})});
  unsettled.quantities[0].bar.half_width = 6;
  for (const auto& [error, words] : std::map<double, std::string>{
           {28, "Steps 2 times shorter at least halve that error, at 2.0 times the work."},
           {23, "Steps 4 times shorter at least halve that error, at 4.0 times the work."},
           {11, "No level of this ladder halves that error."}}) {
    unsettled.quantities[0].first_error = error;
    CHECK(how_to_halve(unsettled) == words);
  }
  CHECK(how_to_halve(answer_of({quantity_of("positions", {1, 2, 4})})) ==
        "What halves that error is not known.");
}

TEST_CASE("two solvers are called different models by their error bars only") {
  CHECK_THAT(in_words(SolverGap{1, 0.2, 0.3, true}, "s"), Contains("the models differ"));
  CHECK_THAT(in_words(SolverGap{0.4, 0.2, 0.3, true}, "s"), Contains("steps may explain it"));
  CHECK_THAT(in_words(SolverGap{1, 0.2, 0.3, false}, "s"), Contains("nothing can be said"));
}

}  // namespace foldproof
