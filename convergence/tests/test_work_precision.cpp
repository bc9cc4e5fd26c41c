// The cheapest method of a motion: ties are printed as ties, on costs that are known.
#include <catch2/catch.hpp>

#include "convergence/work_precision/work_precision.h"

using namespace foldproof;

namespace {

/// A method whose only run reaches every error at that cost.
PrecisionCurve costing(const std::string& method, double applications) {
  return {method, {{40, 1e-5, applications, 1e-3 * applications, 1, {}}}};
}

/// Steps are tried by a ratio of 1.5.
Table cheapest_of(std::vector<PrecisionCurve> curves) {
  PrecisionScene scene{};
  scene.problem.end = 0.8;
  scene.problem.ratio = 1.5;
  scene.truth = {{}, 1, 0, 0.01, 0.01, 0.01};
  scene.curves = std::move(curves);
  const std::vector<Table> tables = precision_tables({scene});
  return *std::ranges::find(tables, "cheapest", &Table::name);
}

}  // namespace

TEST_CASE("methods nearer in cost than two tried steps are tied", "[work-precision]") {
  for (const double of_b : {140.0, 170.0}) {
    const Table table = cheapest_of({costing("A", 310), costing("B", of_b), costing("C", 100)});
    CHECK(table.texts("cheapest method").front() == "C");
    CHECK(table.texts("tied").front() == (of_b < 150 ? "B" : ""));
  }
}

TEST_CASE("the next best method is the cheapest of those that are not tied", "[work-precision]") {
  const Table table =
      cheapest_of({costing("C", 400), costing("RK4", 300), costing("B", 105), costing("A", 100)});
  CHECK(table.texts("cheapest method").front() == "A");
  CHECK(table.texts("tied").front() == "B");
  CHECK(table.texts("next best").front() == "RK4");
  CHECK(table.numbers("it costs this many times as much").front() == Approx(3));
}

TEST_CASE("a step lasts whose energy is at most twice that of half the step", "[work-precision]") {
  const double none = std::nan("");
  const auto is_stable = [](const LongerEnergy& with_step, const LongerEnergy& with_half) {
    return lasts({0.01, with_step, with_half});
  };
  CHECK(is_stable({7, 1.9}, {7, 1}));
  CHECK_FALSE(is_stable({7, 2.1}, {7, 1}));
  CHECK(is_stable({0, 0}, {0, 0}));
  // at rest, but for a hundredth of the largest velocity
  CHECK(is_stable({7, 1e-4}, {7, 1e-9}));
  CHECK_FALSE(is_stable({7, 2e-3}, {7, 1e-9}));
  CHECK_FALSE(is_stable({none, none}, {7, 1}));
  CHECK_FALSE(is_stable({7, 1}, {none, none}));
  CHECK_FALSE(is_stable({INFINITY, INFINITY}, {INFINITY, INFINITY}));
}

TEST_CASE("a price rests on no step that a longer run shows to be unstable", "[work-precision]") {
  // errors of second order; steps of 0.04, 0.02, 0.01 and 0.005 s
  PrecisionCurve curve{"B", {}};
  for (int n = 20; n <= 160; n *= 2)
    curve.runs.push_back({n, 6.4 / n / n, double(n), 0.01 * n, 1, {}});
  const auto price = [&](double wanted) { return price_at(curve, 0.8, wanted); };
  const double step = price(0.008).step;
  CHECK(step == Approx(0.04 / std::sqrt(2.)));
  const LongerEnergy allowed{1, 1}, gained{3, 3}, none{std::nan(""), std::nan("")};
  curve.longer = {{step, gained, allowed}};
  CHECK(price(0.008).step == Approx(0.02));
  CHECK(price(0.008).applications == 40);
  CHECK(price(0.008).limit == LimitedBy::longer_run);
  CHECK(price(0.002).limit == LimitedBy::accuracy);
  curve.longer.push_back({0.02, none, allowed});
  CHECK(price(0.008).step == Approx(0.01));
  curve.longer.push_back({0.005, none, none});
  CHECK(price(0.008).limit == LimitedBy::not_reached);
}

TEST_CASE("the cheapest method of a motion is one whose step lasts", "[work-precision]") {
  PrecisionCurve unstable = costing("A", 100), stable = costing("B", 310);
  unstable.longer = {{0.02, {5, 5}, {1, 1}}};
  stable.longer = {{0.02, {1, 1}, {1, 1}}};
  CHECK(cheapest_of({unstable, stable}).texts("cheapest method").front() == "B");
}
