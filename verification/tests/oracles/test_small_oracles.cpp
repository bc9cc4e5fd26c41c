// Small oracles, and GSL's integrator and root finder.
#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "reference/types.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/oracles/gsl.h"
#include "verification/oracles/limited_spring.h"
#include "verification/oracles/solid_prisms.h"
#include "verification/oracles/triangle_distance.h"
#include "verification/tests/complaint.h"

using namespace foldproof::oracles;
using namespace foldproof;

TEST_CASE("a spring beyond a limit is brought back to it, and otherwise left alone") {
  LimitedSpringInput input{Vector3(1, 2, 3),
                           Vector3(4, 2, 7),
                           Vector3(.3, -.7, 1.1),
                           Vector3(.3, -.7, 1.1),
                           1.9,
                           .7,
                           .05,
                           4,
                           6};  // 5 m long
  for (const auto& [shortest, longest, is_violated] : {std::tuple{4., 6., false},
                                                       {5., 6., false},
                                                       {4., 5., false},
                                                       {std::nextafter(5, 6), 7., true},
                                                       {3., std::nextafter(5, 4), true}}) {
    input.shortest = shortest;
    input.longest = longest;
    const LimitedSpringAnswer answer = limited_spring(input);
    CHECK(answer.is_violated == is_violated);
    if (is_violated) continue;
    CHECK(answer.v_a == input.v_a);
    CHECK(answer.v_b == input.v_b);
    CHECK(answer.length == 5);
  }
  input.v_b += Vector3(4, -.3, 7);
  const auto kinetic = [](const Vector3& v_a, const Vector3& v_b) {
    return v_a.squaredNorm() / (2 * 1.9) + v_b.squaredNorm() / (2 * .7);
  };
  const Vector3 d = input.x_b - input.x_a;
  for (const auto& [shortest, longest] : {std::pair{3., 5.1}, std::pair{6., 7.}}) {
    input.shortest = shortest;
    input.longest = longest;
    const LimitedSpringAnswer answer = limited_spring(input);
    const double limit = longest < 6 ? longest : shortest;
    const Vector3 after = d + .05 * (answer.v_b - answer.v_a);
    CHECK(answer.is_reachable);
    CHECK(answer.length == Approx(limit).epsilon(1e-15));
    CHECK(after.norm() == Approx(limit).epsilon(1e-14));
    CHECK(answer.energy_taken ==
          Approx(kinetic(input.v_a, input.v_b) - kinetic(answer.v_a, answer.v_b)).epsilon(1e-12));
    CHECK(answer.sensitivity == Approx(limit / after.dot(d.normalized())).epsilon(1e-12));
  }
}

TEST_CASE("a spring that turns beyond its longest comes as near as it can") {
  LimitedSpringInput input{
      Vector3(0, 0, 0), Vector3(3, 0, 0), Vector3(.2, 0, 0), Vector3(0, 8, 0), 0, .7, .5, 1, 3.5};
  for (const double longest : {3.5, 4.}) {  // 4 m across by the end of the step
    input.longest = longest;
    const LimitedSpringAnswer answer = limited_spring(input);
    CHECK(answer.is_violated);
    CHECK(answer.is_reachable == (longest == 4));
    CHECK(answer.length == 4);
    CHECK(answer.sensitivity == 1);
    CHECK(answer.v_a == input.v_a);  // prescribed
    // nothing of it is left along: 3 + .5 (v_b - .2) = 0
    CHECK((answer.v_b - Vector3(-5.8, 8, 0)).norm() < 1e-14);
  }
}

TEST_CASE("nested prisms are inside by turns, and have both their floors") {
  // the outer one with a notch, the inner one above it
  const WholePrism outer{{{0, 0}, {5, 6}, {12, 1}, {9, 13}, {-3, 9}}, -2, 5},
      inner{{{4, 8}, {6, 8}, {6, 10}, {4, 10}}, 0, 3};
  CHECK(inside_nested({}, {1, 2, 3}) == -1);
  for (const auto& [z, side] : {std::pair{-3l, -1},
                                {-2l, 0},
                                {-1l, 1},
                                {0l, 0},
                                {1l, -1},
                                {3l, 0},
                                {4l, 1},
                                {5l, 0},
                                {6l, -1}})
    CHECK(inside_nested({outer, inner}, {5, 9, z}) == side);
  CHECK(inside_nested({outer, inner}, {5, 5, 1}) == -1);
}

TEST_CASE("distances to several triangles are the least, with their own rounding") {
  PerParticle3 x(3, 5);
  x << 0, 4, 0, 9, 9, 0, 0, 4, 0, 5, 0, 0, 0, 0, 0;
  const std::vector<std::array<int, 3>> triangles{{0, 1, 2}, {1, 3, 4}};
  for (const auto& [p, distance] : std::vector<std::pair<Vector3, double>>{
           {{1, 1, 7}, 7}, {{-3, -4, 12}, 13}, {{2, -3, 4}, 5}, {{8, 1, 2}, 2}, {{12, 3, 4}, 5}})
    CHECK(distance_to_triangles(x, triangles, p).value == Approx(distance));
  CHECK(distance_to_triangles(x, triangles, {3, 4, 0}).uncertainty ==
        Approx(64 * double(std::numeric_limits<long double>::epsilon()) * (5 + std::sqrt(106.))));
}

TEST_CASE("modes are orthogonal by masses, and turns between directions the smallest") {
  Eigen::Matrix3d K;
  K << 4, .7, -.3, .7, 3, .5, -.3, .5, 2;
  const Eigen::Vector3d masses(.3, 1.7, 2.9);
  CHECK((symmetric_eigenvalues(K) - symmetric_modes(K).values).norm() < 1e-14);
  const SymmetricModes modes = symmetric_modes(K, masses);
  const Eigen::Matrix3d M = masses.asDiagonal();
  CHECK((K * modes.vectors - M * modes.vectors * modes.values.asDiagonal()).norm() < 1e-13);
  CHECK((modes.vectors.transpose() * M * modes.vectors).isIdentity(1e-13));
  const Eigen::Vector3d from(1, -2, .5);
  for (const Eigen::Vector3d& to :
       {Eigen::Vector3d(-.4, .1, .7), Eigen::Vector3d(-2, 4, -1), Eigen::Vector3d(2, -4, 1)}) {
    const Eigen::Quaterniond turn = rotation_between(from, to);
    CHECK((turn * from.normalized() - to.normalized()).norm() < 1e-12);
    const double angle = std::atan2(from.cross(to).norm(), from.dot(to));
    CHECK(2 * std::atan2(turn.vec().norm(), turn.w()) == Approx(angle).margin(1e-7));
  }
}

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
