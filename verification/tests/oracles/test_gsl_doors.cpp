// GSL's integrator and root finder: refused arguments, known answers, and their uncertainties.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "reference/types.h"
#include "verification/oracles/gsl.h"
#include "verification/tests/complaint.h"

using namespace foldproof;
using namespace foldproof::oracles;

static constexpr double infinity = std::numeric_limits<double>::infinity();

TEST_CASE("GSL's integrator names the argument that it refuses") {
  using Numbers = std::vector<double>;
  const RightHandSide rest = [](double, std::span<const double>, std::span<double> dy) {
    std::fill(dy.begin(), dy.end(), 0);
  };
  const auto refused = [&](const Numbers& y0, double t0, const Numbers& times, double tolerance) {
    return complaint([&] { reference_solution(rest, y0, t0, times, tolerance); });
  };
  for (const double bound : {1e-14, 1e-3}) CHECK(refused({1, 2}, 0, {1}, bound).empty());
  CHECK_THAT(refused({}, 0, {1}, 1e-9), Catch::Contains("must not be empty"));
  CHECK_THAT(refused({1, infinity}, 0, {1}, 1e-9), Catch::Contains("y0 and t0 must be finite"));
  CHECK_THAT(refused({1, 2}, 1.1, {1, 2}, 1e-9), Catch::Contains("times must ascend"));
  CHECK_THAT(refused({1, 2}, 0, {2, 1}, 1e-9), Catch::Contains("times must ascend"));
  CHECK_THAT(refused({1, 2}, 0, {1, infinity}, 1e-9), Catch::Contains("times must be finite"));
  for (const double bad : {.99e-14, 1.01e-3})
    CHECK_THAT(refused({1, 2}, 0, {1}, bad), Catch::Contains("tolerance must be"));
}

TEST_CASE("GSL's integrator answers at each time, and is surer with a smaller tolerance") {
  const RightHandSide swing = [](double t, std::span<const double> y, std::span<double> dy) {
    dy[0] = y[1];
    dy[1] = -9 * y[0] + t;
  };
  const std::vector<double> start{.7, -1.3}, times{.4, .4, 1.9, 5};
  double before = infinity;
  for (const double tolerance : {1e-5, 1e-9, 1e-13}) {
    const ReferenceSolution solution = reference_solution(swing, start, .4, times, tolerance);
    REQUIRE(solution.values.size() == 4);
    CHECK(solution.values[1] == start);
    CHECK(solution.uncertainty[0] == 0);
    for (std::size_t i = 2; i < 4; ++i) {
      // x = t/9 + a cos(3 (t - .4)) + b sin(3 (t - .4))
      const double angle = 3 * (times[i] - .4), a = .7 - .4 / 9, b = (-1.3 - 1. / 9) / 3;
      const double x = times[i] / 9 + a * std::cos(angle) + b * std::sin(angle),
                   v = 1. / 9 + 3 * (b * std::cos(angle) - a * std::sin(angle));
      const double off =
          std::max(std::abs(solution.values[i][0] - x), std::abs(solution.values[i][1] - v));
      CHECK(off <= solution.uncertainty[i]);
      CHECK(off < 100 * tolerance);
      CHECK(solution.uncertainty[i] < 1000 * tolerance);
    }
    CHECK(solution.uncertainty[3] < before / 100);
    before = solution.uncertainty[3];
  }
  const RightHandSide infinite = [](double t, std::span<const double>, std::span<double> dy) {
    dy[0] = dy[1] = t < 1 ? 1 : infinity;
  };
  const RightHandSide throwing = [](double, std::span<const double>, std::span<double>) {
    throw std::domain_error("own");
  };
  CHECK_THROWS_WITH(reference_solution(infinite, start, 0, times, 1e-9),
                    Catch::Contains("stopped at t = ") && Catch::EndsWith("side is not finite"));
  CHECK_THROWS_AS(reference_solution(throwing, start, 0, times, 1e-9), std::domain_error);
}

TEST_CASE("a root lies in its bracket, as narrow as requested") {
  const auto f = [](double x) { return x * x * x - 2; };
  const double root = std::cbrt(2.);
  for (const double width : {1e-4, 0.}) {
    const Estimate found = bracketed_root(f, .3, 5, width);
    CHECK(found.uncertainty <= std::max(width, 4 * 2.3e-16 * root));
    CHECK(std::abs(found.value - root) <= found.uncertainty + 3e-16);
  }
  CHECK(bracketed_root(f, .3, 5, 100).uncertainty == Approx(4.7));  // at once
  CHECK(std::abs(bracketed_root([](double x) { return 3 - x; }, 3, 7, 0).value - 3) < 1e-15);
  for (const auto& [low, high, width, why] : {std::tuple{2., 2., 0., "lower must be below upper"},
                                              {-infinity, 2., 0., "lower must be below upper"},
                                              {0., 2., -1e-9, "width must be at least 0"},
                                              {2., 3., 0., "opposite signs"}})
    CHECK_THROWS_WITH(bracketed_root(f, low, high, width), Catch::Contains(why));
  const auto later = [](double x) -> double {
    if (x > .1 && x < 1.9) throw std::domain_error("own");
    return x - 1;
  };
  CHECK_THROWS_WITH(bracketed_root(later, 0, 2, 0), "own");
}
