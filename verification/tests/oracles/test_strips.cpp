// Strips, folds, chains and ribbons: balances, refusals and known values.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/types.h"
#include "verification/oracles/chains_and_ribbons.h"
#include "verification/oracles/elastica.h"
#include "verification/oracles/folds.h"
#include "verification/oracles/gauss.h"
#include "verification/oracles/gsl.h"
#include "verification/oracles/heavy_cantilever.h"

using namespace foldproof::oracles;
using namespace foldproof;

namespace {

constexpr std::array<double, 1> middle{.5};

/// Do the two agree within their uncertainties, which are small?
void check_agreement(const StripShape& one, const StripShape& other) {
  CHECK(one.uncertainty > 0);
  CHECK(one.uncertainty < 1e-9);
  CHECK(other.uncertainty > 0);
  CHECK(other.uncertainty < 2e-8);
  const double off = one.uncertainty + other.uncertainty;
  REQUIRE(one.points.size() == other.points.size());
  for (std::size_t i = 0; i < one.points.size(); ++i) {
    CHECK(std::abs(one.points[i].slope - other.points[i].slope) <= off);
    CHECK(std::abs(one.points[i].across - other.points[i].across) <= off);
    CHECK(std::abs(one.points[i].up - other.points[i].up) <= off);
  }
  CHECK(std::abs(one.first_curvature - other.first_curvature) < 1e-7);
  CHECK(std::abs(one.force_across - other.force_across) < 1e-6);
  CHECK(std::abs(one.force_up - other.force_up) < 1e-6);
}

}  // namespace

TEST_CASE("the heavy cantilever's tip is the table's") {
  const std::array<std::array<double, 3>, 5> table{{{1, .1234714020, .9912463953},
                                                    {5, .4959050446, .8466571800},
                                                    {10, .7001997155, .6563537612},
                                                    {100, .9375239354, .1592233826},
                                                    {1e4, .9941099339, .0142608898}}};
  for (const auto& [gamma, drop, reach] : table) {
    const CantileverTip tip = heavy_cantilever(gamma);
    CHECK(std::abs(tip.drop.value - drop) <= 5e-11 + tip.drop.uncertainty);
    CHECK(std::abs(tip.reach.value - reach) <= 5e-11 + tip.reach.uncertainty);
    CHECK(std::max(tip.drop.uncertainty, tip.reach.uncertainty) < 5e-11);  // the table's last digit
  }
  const auto slope = [](double gamma) {
    return heavy_cantilever(gamma).drop.value / heavy_cantilever(gamma).reach.value;
  };
  CHECK(std::abs(slope(1e-3) * 8 / 1e-3 - 1) < 1e-6);
  const double test_angle = std::tan(41.5 * pi / 180);
  const Estimate gamma =
      bracketed_root([&](double g) { return slope(g) - test_angle; }, 7, 9, 1e-9);
  CHECK(std::abs(gamma.value - 8.004197) < 5.1e-7);
}

TEST_CASE("loops without weight are as high as Peirce printed") {
  const auto height = [&](double first_slope, double turn) {
    const StripShape shape =
        strip_by_collocation({0, first_slope, {{first_slope + turn, 0, 0}}, 0}, middle);
    return -shape.points[0].up;
  };
  CHECK(std::abs(height(0, -2 * pi) - 1 / pi) < 1e-11);       // ring: a circle
  CHECK(std::abs(height(-pi / 2, -pi) - .4243) < 5e-5);       // pear loop
  CHECK(std::abs(height(pi / 2, -3 * pi) - .1337) < 2.5e-4);  // heart loop; ours is .13386
}

TEST_CASE("a symmetric strip between clamps rests half of its weight on each") {
  const std::array<double, 3> s{.25, .5, .75};
  for (const double bulge : {.9, -.9}) {
    const HeavyStrip strip{11, .4, {{-.4, .85, 0}}, bulge};
    const StripShape shape = strip_by_collocation(strip, s);
    CHECK(std::abs(shape.force_up - 5.5) < 1e-8);
    CHECK(std::abs(shape.points[1].slope) < 1e-10);
    CHECK(std::abs(shape.points[1].across - .425) < 1e-10);
    CHECK(std::abs(shape.points[0].slope + shape.points[2].slope) < 1e-10);
    CHECK((shape.points[1].up > 0) == (bulge > 0));
    check_agreement(shape, strip_by_shooting(strip, s));
  }
}

TEST_CASE("moments about a strip's first end balance, and free and pinned ends bear none") {
  const Gauss gauss(40);
  const double end = 1e-5;
  std::vector<double> s(gauss.s.begin(), gauss.s.end());
  s.insert(s.end(), {1 - 2 * end, 1 - end, 1});
  for (const HeavyStrip& strip :
       {HeavyStrip{37, 0, {}, 0}, HeavyStrip{9, -.7, {{.3, .7, -.25, EndHold::pinned}}, .4},
        HeavyStrip{17, .2, {{-.3, .85, .11}}, .9}, HeavyStrip{53, 0, {{-2 * pi, 0, 0}}, 0}}) {
    const StripShape shape = strip_by_collocation(strip, s);
    if (strip.last) check_agreement(shape, strip_by_shooting(strip, s));
    double weight = 0;
    for (int i = 0; i < 40; ++i) weight += gauss.weight[i] * shape.points[std::size_t(i)].across;
    const auto slope = [&](std::size_t i) { return shape.points[40 + i].slope; };
    const double last_curvature = (3 * slope(2) - 4 * slope(1) + slope(0)) / (2 * end);
    const StripPoint& last = shape.points.back();
    CHECK(shape.first_curvature == Approx(last_curvature + last.across * shape.force_up -
                                          last.up * shape.force_across - strip.gamma * weight)
                                       .margin(2e-5));
    if (!strip.last || strip.last->hold == EndHold::pinned) CHECK(std::abs(last_curvature) < 2e-5);
  }
}

TEST_CASE("a shot strip is unsure by more than its integration, as its aim is") {
  const std::vector<double> s{.13, .5, .81, 1};
  const HeavyStrip strip{17, .2, {{-.3, .85, .11}}, .9};
  const StripShape shape = strip_by_shooting(strip, s);
  const RightHandSide rhs = [&](double at, std::span<const double> y, std::span<double> dy) {
    dy[0] = y[1];
    dy[1] = shape.force_across * std::sin(y[0]) - (shape.force_up - 17 * (1 - at)) * std::cos(y[0]);
    dy[2] = std::cos(y[0]);
    dy[3] = std::sin(y[0]);
  };
  const std::array<double, 4> start{.2, shape.first_curvature, 0, 0};
  const ReferenceSolution hit = reference_solution(rhs, start, 0, s, 1e-13);
  for (std::size_t i = 0; i < 4; ++i) {
    const double off = shape.uncertainty + hit.uncertainty[i];
    CHECK(std::abs(hit.values[i][0] - (i < 3 ? shape.points[i].slope : -.3)) <= off);
    CHECK(std::abs(hit.values[i][2] - (i < 3 ? shape.points[i].across : .85)) <= off);
    CHECK(std::abs(hit.values[i][3] - (i < 3 ? shape.points[i].up : .11)) <= off);
  }
  // the miss of each end's number moves the strip by an amount of its own size
  CHECK(shape.uncertainty > 2 * hit.uncertainty.back());
  CHECK(shape.uncertainty < 100 * hit.uncertainty.back());
}

TEST_CASE("weights of a strip are refused just beyond their bounds, with the reason") {
  const double beyond = 1e5 * (1 + 1e-15);
  for (const double gamma : {-1e-300, beyond, double(NAN)}) {
    CHECK_THROWS_WITH(strip_by_collocation({gamma, -pi / 2, {}, 0}, middle),
                      Catch::Contains("gamma must be in [0, 1e5]"));
    CHECK_THROWS_AS(strip_by_shooting({gamma, 0, {{0, .9, 0}}, 1}, middle), InputError);
  }
  CHECK(std::abs(strip_by_collocation({1e5, -pi / 2, {}, 0}, middle).points[0].up + .5) < 1e-9);
  CHECK_THROWS_WITH(strip_by_shooting({1, 0, {}, 0}, middle), Catch::Contains("held at both ends"));
  CHECK_THROWS_WITH(strip_by_collocation({0, 0, {{0, 1.2, 0}}, 0}, middle),
                    Catch::Contains("no equilibrium found at gamma = 0"));
  for (const double gamma : {0., beyond, double(NAN)})
    CHECK_THROWS_WITH(heavy_cantilever(gamma), Catch::Contains("gamma must be in (0, 1e5]"));
  CHECK(heavy_cantilever(1e5).drop.value < 1);
  CHECK(heavy_cantilever(1e-9).drop.value == Approx(1e-9 / 8).epsilon(1e-3));
}

TEST_CASE("the lifted part of a strip is its rest, in its own length") {
  const HeavyStrip part = lifted_part({64, 0, {{2.9, .7, .15}}, .2}, .25);
  CHECK(part.gamma == Approx(64 * .421875).epsilon(1e-15));  // (3/4)^3
  CHECK(part.last->across == Approx(.6).epsilon(1e-15));     // (.7 - .25)/.75
  CHECK(part.last->up == Approx(.2).epsilon(1e-15));
  CHECK(part.last->slope == 2.9);
  CHECK(part.bulge == .2);
  CHECK(part.first_slope == 0);
}

TEST_CASE("a free fold comes down without a moment, and keeps its first integral") {
  const FreeFold one = free_fold_by_collocation(), other = free_fold_by_shooting();
  for (const FreeFold& fold : {one, other}) {
    REQUIRE(fold.points.size() == 2001);
    const double V = fold.push.value, step = fold.lifted.value / 2000;
    CHECK(std::abs(fold.points.front().slope) < 1e-10);
    CHECK(std::abs(fold.points.back().slope - pi) < 1e-9);
    CHECK(std::abs(fold.points.back().up) < 1e-9);
    CHECK(fold.points.front().across == Approx(0).margin(1e-12));
    double top = 0;
    for (std::size_t i = 1; i < 2000; ++i) {
      const StripPoint &before = fold.points[i - 1], &at = fold.points[i],
                       &after = fold.points[i + 1];
      top = std::max(top, at.up);
      const double curvature = (after.slope - before.slope) / (2 * step);
      const double kept =
          curvature * curvature / 2 + (double(i) * step - V) * std::sin(at.slope) - at.up;
      REQUIRE(std::abs(kept) < 1e-4);
      REQUIRE(std::hypot(after.across - at.across, after.up - at.up) == Approx(step).epsilon(1e-4));
    }
    CHECK(fold.height.value >= top);
    CHECK(fold.height.value < top + 1e-6);
  }
}

namespace {

/// y'' by differences.
template <class Function>
double bend(const Function& y, double t) {
  constexpr double h = 1e-3;
  return (-y(t + 2 * h) + 16 * y(t + h) - 30 * y(t) + 16 * y(t - h) - y(t - 2 * h)) / (12 * h * h);
}

}  // namespace

TEST_CASE("a chain's frequencies are half the roots of Bessel's function") {
  for (const int n : {1, 2, 3, 4, 5}) {
    const double root = 2 * chain_frequency_by_series(n).value;
    CHECK(std::abs(root - (n - .25) * pi) < .06);
    CHECK(std::cyl_bessel_j(0, root * (1 - 1e-12)) * std::cyl_bessel_j(0, root * (1 + 1e-12)) < 0);
    CHECK(chain_frequency_by_series(n).uncertainty < 1e-13);
    // 1e-11 of the function's value moves the root by as much over its slope, which is -J1
    CHECK(chain_frequency_by_shooting(n).uncertainty ==
          Approx(.5e-11 / std::abs(std::cyl_bessel_j(1, root))).epsilon(.01));
  }
  for (const int n : {0, 6})
    CHECK_THROWS_WITH(chain_frequency_by_series(n), Catch::Contains("one of 1 to 5"));
}

TEST_CASE("a ribbon's twist and a column's slope obey their equations at the loads printed") {
  const double tipping = tipping_load_by_series().value,
               buckling = self_buckling_load_by_series().value;
  CHECK(tipping == Approx(12.85).epsilon(1e-3));
  CHECK(buckling == Approx(7.8373474).epsilon(1e-7));  // Greenhill
  CHECK(tipping_twist(0) == 1);
  CHECK(std::abs(tipping_twist(1)) < 1e-14);
  CHECK(std::abs(self_buckling_slope(1)) < 1e-14);
  for (const double t : {.3, .62, .9}) {
    const double twist = tipping_twist(t), slope = self_buckling_slope(t);
    CHECK(std::abs(bend(tipping_twist, t) + tipping * tipping / 4 * std::pow(t, 4) * twist) < 1e-6);
    CHECK(std::abs(bend(self_buckling_slope, t) + buckling * t * slope) < 1e-6);
  }
}

TEST_CASE("chains must be slack, and their second end to the right") {
  const std::vector<double> s{.5};
  CHECK(catenary({.6, .2}, {}).uncertainty > 9.9 * catenary({.6, .2}, {}).pull_up.uncertainty);
  for (const HungChain& taut : {HungChain{.6, .8}, HungChain{0, .5}, HungChain{-.4, .1},
                                HungChain{NAN, .1}, HungChain{.4, NAN}}) {
    CHECK_THROWS_AS(catenary(taut, s), InputError);
    CHECK_THROWS_AS(catenary_by_shooting(taut, s), InputError);
  }
}
