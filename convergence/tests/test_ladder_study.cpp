// The study that `foldproof converge` writes for reports.
#include <catch2/catch.hpp>

#include "convergence/any_case/ladder_study.h"
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

TEST_CASE("an answer in words says what the reading is worth") {
  CHECK_THAT(in_words(answer_of({quantity_of("positions", {16, 4, 1})})),
             Contains("off by 0.5 m at most") && Contains("error bar of 0.42 m") &&
                 Contains("order 2.00: asymptotic."));
  CHECK_THAT(in_words(answer_of({quantity_of("positions", {16, 4, 2})})),
             Contains("not asymptotic: the order still changes"));
  CHECK_THAT(in_words(answer_of({quantity_of("positions", {1, 2, 4})})),
             Contains("a spread and no estimate: differences between levels grow."));
  CHECK_THAT(in_words(answer_of({quantity_of("positions", {1, 2, nan})})),
             Contains("No error can be stated for strip with method C"));
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
  unsettled.quantities[0].first_error = 28;
  CHECK(how_to_halve(unsettled) ==
        "Steps 2 times shorter at least halve that error, at 2.0 times the work.");
  unsettled.quantities[0].first_error = 23;
  CHECK(how_to_halve(unsettled) ==
        "Steps 4 times shorter at least halve that error, at 4.0 times the work.");
  unsettled.quantities[0].first_error = 11;
  CHECK(how_to_halve(unsettled) == "No level of this ladder halves that error.");
  CHECK(how_to_halve(answer_of({quantity_of("positions", {1, 2, 4})})) ==
        "What halves that error is not known.");
}

TEST_CASE("a study of a ladder has its differences, its bars and its costs") {
  QuantityOverLevels height = quantity_of("height", {-16, 4, 1});
  height.values = {30, 14, 18, 19};
  QuantityOverLevels constant = quantity_of("constant", {0, 0, 0});
  constant.values = {5, 5, 5, 5};
  const StudyRecord study =
      study_of(answer_of({quantity_of("positions", {16, 4, 1}), height, constant}), "beyond 2 s");
  CHECK(study.name == "converge.strip.C.in-time");
  CHECK_THAT(study.claim, Contains("halve that error"));
  CHECK_THAT(study.about, Contains(" Beyond 2 s."));
  CHECK(study.seconds == 45);
  REQUIRE(study.figures.size() == 2);
  const Curve& positions = study.figures[0].curves.at(0);
  CHECK(positions.x == std::vector<double>{0.08, 0.04, 0.02});
  CHECK(positions.y == std::vector<double>{16, 4, 1});
  CHECK(positions.pair_orders == std::vector<double>{2, 2});
  CHECK(study.figures[0].slope == 2);
  REQUIRE(study.figures[1].curves.size() == 1);  // a constant cannot be drawn on a log axis
  CHECK(study.figures[1].curves[0].y.at(0) == Approx(16.0 / 30));
  const Table& quantities = study.tables.at(0);
  CHECK(quantities.texts("quantity") ==
        std::vector<std::string>{"positions", "height", "constant"});
  CHECK(quantities.numbers("error bar").at(0) == Approx(1.25 / 3));
  CHECK_THAT(quantities.texts("reading").at(2), Contains("inconclusive: differences"));
  CHECK(study.tables.at(1).texts("stopped") == std::vector<std::string>{"no", "no", "no", "fell"});
  CHECK(study.tables[1].numbers("particles") == std::vector<double>{4, 4, 4, 4});
  CHECK(study.tables[1].numbers("processor time") == std::vector<double>{3, 6, 12, 24});
}

TEST_CASE("two solvers are called different models by their error bars only") {
  const SolverGap far{1, 0.2, 0.3, true}, near{0.4, 0.2, 0.3, true}, spread{1, 0.2, 0.3, false};
  CHECK(far.is_beyond_steps());
  CHECK_FALSE(near.is_beyond_steps());
  CHECK_FALSE(spread.is_beyond_steps());
  CHECK_THAT(in_words(far, "s"), Contains("the models differ"));
  CHECK_THAT(in_words(near, "s"), Contains("steps may explain it"));
  CHECK_THAT(in_words(spread, "s"), Contains("nothing can be said"));
}

}  // namespace foldproof
