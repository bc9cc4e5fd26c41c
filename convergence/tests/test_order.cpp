// Orders, tables, and the running of studies.
#include <catch2/catch.hpp>
#include <stdexcept>

#include "convergence/order.h"
#include "convergence/studies.h"
#include "convergence/study.h"
#include "convergence/tables.h"
#include "reference/types.h"
#include "verification/oracles/estimate.h"
#include "verification/subjects/reference_subject.h"

using namespace foldproof;

namespace {

/// Errors 1.3 h^order at these steps.
Convergence power_law(double order, const std::vector<double>& steps = {0.3, 0.15, 0.075, 0.0375}) {
  Convergence convergence{steps, {}, 0};
  for (const double h : steps) convergence.errors.push_back(1.3 * std::pow(h, order));
  return convergence;
}

}  // namespace

TEST_CASE("pair orders do not need equal ratios of steps") {
  const Convergence convergence = power_law(1.6, {0.5, 0.4, 0.1, 0.07});
  for (const double order : pair_orders(convergence)) CHECK(order == Approx(1.6).epsilon(1e-12));
  CHECK(fitted_order(convergence) == Approx(1.6).epsilon(1e-12));
}

TEST_CASE("the fitted order is the slope of least squares over all points") {
  // log2 of the steps 0, -1, -2, -3, of the errors 0, -2, -4, -3: so the slope is (-.5 * 2 +
  // .5 * 4 + 1.5 * 3)/5
  const Convergence convergence{{1, 0.5, 0.25, 0.125}, {1, 0.25, 0.0625, 0.125}, 0};
  CHECK(fitted_order(convergence) == Approx(1.1).epsilon(1e-12));
}

TEST_CASE("errors without a logarithm give NaN and no order") {
  for (const double error : {0.0, -1e-3, foldproof::nan}) {
    const Convergence convergence{{0.4, 0.2, 0.1}, {1e-2, error, 1e-4}, 0};
    for (const double order : pair_orders(convergence)) CHECK(std::isnan(order));
    CHECK(std::isnan(fitted_order(convergence)));
    CHECK(std::isnan(order_deviation(convergence, 2, 2).value));
  }
}

TEST_CASE("a NaN among the judged pairs is kept although others follow") {
  const Convergence convergence{{0.8, 0.4, 0.2, 0.1}, {foldproof::nan, 4e-2, 1e-2, 25e-4}, 0};
  CHECK(std::isnan(order_deviation(convergence, 2, 3).value));
  CHECK(order_deviation(convergence, 2, 2).value == Approx(0).margin(1e-12));
}

TEST_CASE("the deviation is the worst of the last pairs only") {
  // orders 1, 2, 2.5
  const Convergence convergence{{0.8, 0.4, 0.2, 0.1}, {1, 0.5, 0.125, 0.125 / std::pow(2, 2.5)}, 0};
  CHECK(order_deviation(convergence, 2, 3).value == Approx(1).epsilon(1e-12));
  CHECK(order_deviation(convergence, 2, 2).value == Approx(0.5).epsilon(1e-12));
  CHECK(order_deviation(convergence, 2.5, 1).value == Approx(0).margin(1e-12));
}

TEST_CASE("the floor's uncertainty covers every error that the floor allows") {
  Convergence convergence = power_law(2);
  convergence.floor = 0.13 * convergence.errors.back();
  const Estimate deviation = order_deviation(convergence, 2, 1);
  for (const double first : {-1.0, 1.0})
    for (const double second : {-1.0, 1.0}) {
      Convergence moved = convergence;
      moved.errors[2] += first * convergence.floor;
      moved.errors[3] += second * convergence.floor;
      CHECK(order_deviation(moved, 2, 1).value <= deviation.value + deviation.uncertainty);
    }
  CHECK(deviation.uncertainty < 0.5);
}

TEST_CASE("an error at its floor says nothing") {
  Convergence convergence = power_law(2);
  convergence.floor = convergence.errors.back();
  CHECK(std::isinf(order_deviation(convergence, 2, 1).uncertainty));
  convergence.floor = 0;
  CHECK(order_deviation(convergence, 2, 1).uncertainty == 0);
  convergence.errors.back() = 0;  // without a floor, too
  CHECK(std::isnan(order_deviation(convergence, 2, 1).value));
  CHECK(order_deviation(convergence, 2, 1).uncertainty == 0);
}

TEST_CASE("Richardson's extrapolation is exact for one power") {
  const double limit = 0.77, c = -1.9, h = 0.21;
  const double coarse = limit + c * h * h, fine = limit + c * h * h / 9;
  const Estimate estimate = richardson(coarse, fine, 3, 2);
  CHECK(estimate.value == Approx(limit).epsilon(1e-14));
  CHECK(estimate.uncertainty == Approx(std::abs(fine - limit)).epsilon(1e-12));
  for (const double ratio : {1.0, foldproof::nan})
    CHECK_THROWS_AS(richardson(1, 2, ratio, 2), InputError);
  CHECK_THROWS_AS(richardson(1, 2, 2, 0), InputError);
}

TEST_CASE("the asymptotic range begins after the last order that is off") {
  CHECK(asymptotic_from({1.2, 2.01, 1.7, 1.95, 2.02}, 2, 0.1) == 3);
  CHECK(asymptotic_from({2.01, 1.99}, 2, 0.1) == 0);
  CHECK(asymptotic_from({2.01, 1.5}, 2, 0.1) == 2);
  CHECK(asymptotic_from({2.01, foldproof::nan, 2.0}, 2, 0.1) == 2);
  CHECK(asymptotic_from({}, 2, 0.1) == 0);
}

TEST_CASE("levels above the floor end at the first that has sunk") {
  const Convergence convergence{{0.8, 0.4, 0.2, 0.1}, {1e-3, 1e-4, 1e-7, 1e-4}, 1e-6};
  CHECK(levels_above_floor(convergence, 10) == 2);
  CHECK(levels_above_floor(convergence, 1e4) == 0);
  CHECK(levels_above_floor({{0.2, 0.1}, {foldproof::nan, 1e-3}, 1e-6}, 10) == 0);
}

namespace {

Table runs() {
  Table table{{"scheme", ""}, {"step", "s"}, {"error", "m"}};
  table.row("A", 0.3, oracles::Estimate{4.5, 0.25});
  table.row("C", 0.3, oracles::Estimate{3.0, 0.5});
  table.row("A", 0.15, oracles::Estimate{1.5, 0.125});
  return table;
}

}  // namespace

TEST_CASE("group_of keeps the rows with the text, without its column") {
  const Table group = group_of(runs(), "scheme", "A");
  REQUIRE(group.columns().size() == 2);
  CHECK(group.numbers("step") == std::vector<double>{0.3, 0.15});
  CHECK(group.numbers("error") == std::vector<double>{4.5, 1.5});
  CHECK(group.column("error").uncertainty == 0.5);
  CHECK(group_of(runs(), "scheme", "B").rows() == 0);
}

TEST_CASE("stacked keeps the larger uncertainty of a later table") {
  Table coarse{{"error", "m"}};
  coarse.row(oracles::Estimate{7.0, 2.5});
  const Table fine = with_columns(runs(), {"error"});
  const Table all = stacked({"mesh", ""}, {{"fine", fine}, {"coarse", coarse}});
  CHECK(all.column("error").uncertainty == 2.5);
  CHECK(all.texts("mesh") == std::vector<std::string>{"fine", "fine", "fine", "coarse"});
  CHECK(all.numbers("error") == std::vector<double>{4.5, 3, 1.5, 7});
  CHECK_THROWS_AS(stacked({"mesh", ""}, {{"a", runs()}, {"b", fine}}), std::logic_error);
}

TEST_CASE("largest_deviation is relative, of either sign, and keeps NaN") {
  Table table{{"measured", "m"}, {"derived", "m"}};
  CHECK(largest_deviation(table, "measured", "derived") == 0);
  table.row(3.0, 4.0);
  table.row(4.5, 4.0);
  CHECK(largest_deviation(table, "measured", "derived") == 0.25);
  CHECK(largest_ratio(table, "measured", "derived") == 1.125);
  CHECK(last_exponent(with_columns(table, {"derived", "measured"}), "measured", "derived") == 0);
  table.row(foldproof::nan, 4.0);
  table.row(12.0, 4.0);
  CHECK(std::isnan(largest_deviation(table, "measured", "derived")));
  CHECK(std::isnan(largest_ratio(table, "measured", "derived")));
}

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
