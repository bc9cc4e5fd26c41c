// GSL's doors: the arguments that they refuse, answers that are known, and how sure these are.
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

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::string gsl(const std::string& what) { return "oracle gsl: " + what; }

}  // namespace

TEST_CASE("GSL's integrator names the argument that it refuses") {
  const RightHandSide decay = [](double, std::span<const double> y, std::span<double> dy) {
    for (std::size_t i = 0; i < y.size(); ++i) dy[i] = -double(i + 1) * y[i];
  };
  const auto of = [&](const std::vector<double>& y0, double t0, const std::vector<double>& times,
                      double tolerance) {
    return complaint([&] { reference_solution(decay, y0, t0, times, tolerance); });
  };
  CHECK(of({1, 2}, 0, {1}, 1e-9).empty());
  CHECK(of({1, 2}, 0, {1}, 1e-14).empty());
  CHECK(of({1, 2}, 0, {1}, 1e-3).empty());
  const std::string empty = gsl("reference_solution: y0 and times must not be empty"),
                    finite = gsl("reference_solution: y0 and t0 must be finite"),
                    order = gsl("reference_solution: times must ascend from t0"),
                    tolerance = gsl("reference_solution: tolerance must be in [1e-14, 1e-3]");
  CHECK(of({}, 0, {1}, 1e-9) == empty);
  CHECK(of({1}, 0, {}, 1e-9) == empty);
  CHECK(of({1, infinity}, 0, {1}, 1e-9) == finite);
  CHECK(of({1, 2}, NAN, {1}, 1e-9) == finite);
  CHECK(of({1, 2}, 1.1, {1, 2}, 1e-9) == order);
  CHECK(of({1, 2}, 0, {2, 1}, 1e-9) == order);
  CHECK(of({1, 2}, 0, {1, infinity}, 1e-9) == gsl("reference_solution: times must be finite"));
  for (const double bad : {.99e-14, 1.01e-3, double(NAN)})
    CHECK(of({1, 2}, 0, {1}, bad) == tolerance);
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
    CHECK(solution.times == times);
    CHECK(solution.values[0] == start);
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
  // three solutions' worst: the values, ten times the tolerance, the other method
  CHECK(before > 0);
}

TEST_CASE("GSL's integrator says where and why it stopped") {
  const std::vector<double> start{1}, late{3};
  const RightHandSide infinite = [](double t, std::span<const double>, std::span<double> dy) {
    dy[0] = t < 1 ? 1 : std::numeric_limits<double>::infinity();
  };
  CHECK_THROWS_WITH(reference_solution(infinite, start, 0, late, 1e-9),
                    Catch::Contains("oracle gsl: rk8pd stopped at t = ") &&
                        Catch::EndsWith(": the right-hand side is not finite"));
  const RightHandSide too_fast = [](double, std::span<const double>, std::span<double> dy) {
    dy[0] = 1e308;
  };
  CHECK_THROWS_AS(reference_solution(too_fast, start, 0, late, 1e-9), std::runtime_error);
}

TEST_CASE("a root lies in its bracket, as narrow as asked for") {
  const auto f = [](double x) { return x * x * x - 2; };
  const double root = std::cbrt(2.);
  for (const double width : {.1, 1e-4, 1e-9, 0.}) {
    const Estimate found = bracketed_root(f, .3, 5, width);
    CHECK(found.uncertainty <= std::max(width, 4 * 2.3e-16 * root));
    CHECK(std::abs(found.value - root) <= found.uncertainty + 3e-16);
  }
  CHECK(bracketed_root(f, .3, 5, 100).uncertainty == Approx(4.7));  // at once
  CHECK(std::abs(bracketed_root([](double x) { return 3 - x; }, 3, 7, 0).value - 3) < 1e-15);
  const std::string order = gsl("bracketed_root: lower must be below upper");
  CHECK(complaint([&] { bracketed_root(f, 2, 2, 0); }) == order);
  CHECK(complaint([&] { bracketed_root(f, -infinity, 2, 0); }) == order);
  CHECK(complaint([&] { bracketed_root(f, 0, infinity, 0); }) == order);
  CHECK(complaint([&] { bracketed_root(f, 0, 2, -1e-9); }) ==
        gsl("bracketed_root: width must be at least 0"));
  CHECK(complaint([&] { bracketed_root(f, 2, 3, 0); }) ==
        gsl("bracketed_root: f must have opposite signs at lower and upper"));
  const auto at_once = [](double) -> double { throw std::domain_error("own"); };
  const auto later = [](double x) -> double {
    if (x > .1 && x < 1.9) throw std::domain_error("own");
    return x - 1;
  };
  CHECK_THROWS_WITH(bracketed_root(at_once, 0, 2, 0), "own");
  CHECK_THROWS_WITH(bracketed_root(later, 0, 2, 0), "own");
}
