// Strips under their own weight and folds: closed forms, balances of forces, and one solver
// against the other.
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "reference/types.h"
#include "verification/oracles/collocation.h"
#include "verification/oracles/elastica.h"
#include "verification/oracles/folds.h"
#include "verification/oracles/gauss.h"
#include "verification/oracles/gsl.h"
#include "verification/oracles/heavy_cantilever.h"

using namespace foldproof;
using namespace foldproof::oracles;

namespace {

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

/// Places and weights of Gauss's quadrature, on the strip and at its end.
std::vector<double> gauss_places(const Gauss& gauss) {
  std::vector<double> s(gauss.s.begin(), gauss.s.end());
  s.push_back(1);
  return s;
}

}  // namespace

TEST_CASE("polynomials by their values at Chebyshev's nodes are differentiated and integrated") {
  const auto p = [](double s) { return 3 * std::pow(s, 5) - 2 * s * s + .7 * s - .4; };
  const auto derivative = [](double s) { return 15 * std::pow(s, 4) - 4 * s + .7; };
  const auto integral = [](double s) {
    return std::pow(s, 6) / 2 - 2 * s * s * s / 3 + .35 * s * s - .4 * s;
  };
  for (const int n : {5, 8}) {
    const Collocation nodes(n);
    REQUIRE(nodes.s.size() == n + 1);
    for (int j = 0; j <= n; ++j)
      CHECK(nodes.s[j] == Approx((1 - std::cos(j * pi / n)) / 2).margin(1e-15));
    const Eigen::VectorXd values = nodes.s.unaryExpr(p), slopes = nodes.derivative * values,
                          factors = nodes.coefficients * values;
    for (int j = 0; j <= n; ++j) CHECK(std::abs(slopes[j] - derivative(nodes.s[j])) < 1e-12);
    for (const double s : {0., .13, .5, .77, 1.}) {
      CHECK(std::abs(nodes.integral(s).dot(values) - integral(s)) < 1e-14);
      double sum = 0;
      for (int k = 0; k <= n; ++k) sum += factors[k] * std::cos(k * std::acos(2 * s - 1));
      CHECK(std::abs(sum - p(s)) < 1e-13);
    }
  }
}

TEST_CASE("a strip that hangs straight down stays straight under any weight") {
  const std::array<double, 3> s{0, .37, 1};
  for (const double gamma : {0., 7., 1e3}) {
    const StripShape shape = strip_by_collocation({gamma, -pi / 2, {}, 0}, s);
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(std::abs(shape.points[i].slope + pi / 2) <= shape.uncertainty);
      CHECK(std::abs(shape.points[i].across) <= shape.uncertainty);
      CHECK(std::abs(shape.points[i].up + s[i]) <= shape.uncertainty);
    }
    CHECK(std::abs(shape.first_curvature) < 1e-9);
    CHECK(shape.force_across == 0);
    CHECK(shape.force_up == 0);
    CHECK(shape.uncertainty >= 64 * 72 * 2.2e-16);
    CHECK(shape.uncertainty < 64 * 300 * 2.3e-16 + 1e-11);
  }
}

TEST_CASE("a free strip's moment at its clamp is that of its weight, its tip the cantilever's") {
  const Gauss gauss(30);
  const std::vector<double> s = gauss_places(gauss);
  for (const double gamma : {3., 37., 400.}) {
    const StripShape shape = strip_by_collocation({gamma, 0, {}, 0}, s);
    double moment = 0;
    for (int i = 0; i < 30; ++i) moment += gauss.weight[i] * shape.points[std::size_t(i)].across;
    CHECK(shape.first_curvature == Approx(-gamma * moment).epsilon(1e-8));
    const CantileverTip tip = heavy_cantilever(gamma);
    const StripPoint& end = shape.points.back();
    CHECK(shape.uncertainty < 1e-10);
    CHECK(std::abs(end.up + tip.drop.value) <= shape.uncertainty + tip.drop.uncertainty);
    CHECK(std::abs(end.across - tip.reach.value) <= shape.uncertainty + tip.reach.uncertainty);
  }
}

TEST_CASE("tips of light and heavy strips are the cantilever's, each asked for alone") {
  for (const double gamma : {.03, .5, 1e4}) {
    const StripShape shape = strip_by_collocation({gamma, 0, {}, 0}, std::array<double, 1>{1});
    const CantileverTip tip = heavy_cantilever(gamma);
    CHECK(shape.uncertainty < 1e-10);
    CHECK(std::abs(shape.points[0].up + tip.drop.value) <=
          shape.uncertainty + tip.drop.uncertainty);
    CHECK(std::abs(shape.points[0].across - tip.reach.value) <=
          shape.uncertainty + tip.reach.uncertainty);
  }
}

TEST_CASE("a weightless strip whose ends suit an arc is that arc, held by no force") {
  const std::array<double, 4> s{0, .21, .68, 1};
  const double first = .3, turn = 1.1;
  const auto across = [&](double at) {
    return (std::sin(first + turn * at) - std::sin(first)) / turn;
  };
  const auto up = [&](double at) { return (std::cos(first) - std::cos(first + turn * at)) / turn; };
  const HeavyStrip strip{0, first, {{first + turn, across(1), up(1)}}, 0};
  for (const StripShape& shape : {strip_by_collocation(strip, s), strip_by_shooting(strip, s)}) {
    REQUIRE(shape.points.size() == 4);
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(std::abs(shape.points[i].slope - first - turn * s[i]) < 1e-10);
      CHECK(std::abs(shape.points[i].across - across(s[i])) < 1e-10);
      CHECK(std::abs(shape.points[i].up - up(s[i])) < 1e-10);
    }
    CHECK(std::abs(shape.first_curvature - turn) < 1e-9);
    CHECK(std::abs(shape.force_across) < 1e-8);
    CHECK(std::abs(shape.force_up) < 1e-8);
  }
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
  // a strip that is compressed a little buckles at Euler's load, to the side of its bulge
  for (const double bulge : {.1, -.1}) {
    const HeavyStrip strip{0, 0, {{0, .9975, 0}}, bulge};
    const StripShape shape = strip_by_collocation(strip, s);
    CHECK(shape.force_across == Approx(-4 * pi * pi).epsilon(.005));
    CHECK(std::abs(shape.force_up) < 1e-7);
    // slope a sin(2 pi s) with a^2/4 = .0025, height a/pi in the middle
    CHECK(shape.points[1].up == Approx((bulge > 0 ? 1 : -1) * .1 / pi).epsilon(.005));
    CHECK(shape.points[0].slope == Approx(bulge > 0 ? .1 : -.1).epsilon(.005));
  }
}

TEST_CASE("a pinned end bears no moment, and both solvers place it alike") {
  const std::array<double, 3> s{.2, .55, 1};
  const HeavyStrip strip{9, -.7, {{.3, .7, -.25, EndHold::pinned}}, .4};
  const StripShape shape = strip_by_collocation(strip, s);
  check_agreement(shape, strip_by_shooting(strip, s));
  CHECK(std::abs(shape.points[2].across - .7) < 1e-10);
  CHECK(std::abs(shape.points[2].up + .25) < 1e-10);
  // moments about the first end: theta'(0) against force and weight, none from the pin
  const Gauss gauss(30);
  const StripShape along = strip_by_collocation(strip, gauss_places(gauss));
  double weight = 0;
  for (int i = 0; i < 30; ++i) weight += gauss.weight[i] * along.points[std::size_t(i)].across;
  CHECK(shape.first_curvature ==
        Approx(.7 * shape.force_up + .25 * shape.force_across - 9 * weight).margin(1e-8));
  const std::array<double, 2> last{1 - 1e-4, 1};
  const StripShape near = strip_by_collocation(strip, last);
  CHECK(std::abs(near.points[1].slope - near.points[0].slope) < 1e-6);
}

TEST_CASE("slanted clamps under weight: collocation and shooting agree on forces and moments") {
  const std::array<double, 3> s{.13, .5, .81};
  for (const HeavyStrip& strip :
       {HeavyStrip{17, .2, {{-.3, .85, .11}}, .9}, HeavyStrip{53, 0, {{-2 * pi, 0, 0}}, 0}}) {
    const StripShape shape = strip_by_collocation(strip, s);
    check_agreement(shape, strip_by_shooting(strip, s));
    // vertical balance is in F_y(s); moments about the first end, with the last clamp's moment
    const Gauss gauss(40);
    const StripShape along = strip_by_collocation(strip, gauss_places(gauss));
    double weight = 0;
    for (int i = 0; i < 40; ++i) weight += gauss.weight[i] * along.points[std::size_t(i)].across;
    const double end = 1e-5;
    const std::array<double, 3> tip{1 - 2 * end, 1 - end, 1};
    const StripShape near = strip_by_collocation(strip, tip);
    const double last_curvature =
        (3 * near.points[2].slope - 4 * near.points[1].slope + near.points[0].slope) / (2 * end);
    const StripEnd& last = *strip.last;
    CHECK(shape.first_curvature == Approx(last_curvature + last.across * shape.force_up -
                                          last.up * shape.force_across - strip.gamma * weight)
                                       .margin(2e-5));
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
  const std::array<double, 1> middle{.5};
  const std::string bounds = "oracle elastica: gamma must be in [0, 1e5]";
  for (const double gamma : {-1e-300, 1e5 * (1 + 1e-15), double(INFINITY), double(NAN)}) {
    CHECK_THROWS_WITH(strip_by_collocation({gamma, -pi / 2, {}, 0}, middle), bounds);
    CHECK_THROWS_WITH(strip_by_shooting({gamma, 0, {{0, .9, 0}}, 1}, middle), bounds);
  }
  CHECK(std::abs(strip_by_collocation({1e5, -pi / 2, {}, 0}, middle).points[0].up + .5) < 1e-9);
  CHECK_THROWS_WITH(strip_by_shooting({1, 0, {}, 0}, middle),
                    "oracle elastica: shooting needs a strip held at both ends");
  CHECK_THROWS_WITH(strip_by_collocation({0, 0, {{0, 1.2, 0}}, 0}, middle),
                    Catch::StartsWith("oracle elastica: no equilibrium found at gamma = 0"));
}

TEST_CASE("the heavy cantilever takes weights within its bounds only") {
  for (const double gamma : {0., -1., 1e5 * (1 + 1e-15), double(NAN)})
    CHECK_THROWS_WITH(heavy_cantilever(gamma),
                      "oracle heavy_cantilever: gamma must be in (0, 1e5]");
  CHECK(heavy_cantilever(1e5).drop.value < 1);
  CHECK(heavy_cantilever(1e-9).drop.value == Approx(1e-9 / 8).epsilon(1e-3));
  for (const double gamma : {.5, 40.}) {
    const CantileverTip tip = heavy_cantilever(gamma);
    for (const Estimate& number : {tip.drop, tip.reach}) {
      CHECK(number.uncertainty > 1e-15);
      CHECK(number.uncertainty < 1e-10);
    }
  }
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

TEST_CASE("a fold on a floor lifts off without a moment, and both solvers agree") {
  const HeavyStrip strip{23, 0, {{pi, .02, .01}}, 0};
  const Fold one = fold_on_floor(strip, .12, .35, strip_by_collocation),
             other = fold_on_floor(strip, .12, .35, strip_by_shooting);
  for (const auto& [p, q] :
       {std::pair{one.lift_off, other.lift_off}, std::pair{one.height, other.height}}) {
    CHECK(std::abs(p.value - q.value) <= p.uncertainty + q.uncertainty);
    CHECK(p.uncertainty > 1e-13);
    CHECK(p.uncertainty < 2e-9);
    CHECK(q.uncertainty < 1e-7);
  }
  // a lift-off that is off moves the top by a few times as much
  for (const Fold& fold : {one, other}) {
    CHECK(fold.height.uncertainty > 4 * fold.lift_off.uncertainty + 1e-12);
    CHECK(fold.height.uncertainty < 5 * fold.lift_off.uncertainty + 1.1e-12);
  }
  const HeavyStrip part = lifted_part(strip, one.lift_off.value);
  std::vector<double> even(1001);
  for (std::size_t i = 0; i < even.size(); ++i) even[i] = .5 + double(i) / 2000;
  const StripShape shape = strip_by_collocation(part, even);
  CHECK(std::abs(shape.first_curvature) < 1e-7);
  double top = 0;
  for (const StripPoint& point : shape.points) top = std::max(top, point.up);
  const double share = 1 - one.lift_off.value;
  CHECK(one.height.value >= share * top - 1e-11);
  CHECK(one.height.value < share * top + 1e-6);
  // between the places the top is a parabola's, to the fourth power of their distance
  const auto is_lower = [](const StripPoint& a, const StripPoint& b) { return a.up < b.up; };
  const auto best = std::max_element(shape.points.begin(), shape.points.end(), is_lower);
  std::vector<double> fine;
  const double around = even[std::size_t(best - shape.points.begin())];
  for (int i = -100; i <= 100; ++i) fine.push_back(around + i * 5e-6);
  double finer = 0;
  for (const StripPoint& point : strip_by_collocation(part, fine).points)
    finer = std::max(finer, point.up);
  CHECK(std::abs(one.height.value - share * finer) < 1e-10);

  const std::string why =
      "oracle folds: the strip must lie level at its first end, and have its last held";
  CHECK_THROWS_WITH(fold_on_floor({23, .1, {{pi, 0, 0}}, 0}, .12, .35, strip_by_collocation), why);
  CHECK_THROWS_WITH(fold_on_floor({23, 0, {}, 0}, .12, .35, strip_by_collocation), why);
}

TEST_CASE("a free fold comes down without a moment, and keeps its first integral") {
  const FreeFold one = free_fold_by_collocation(), other = free_fold_by_shooting();
  for (const auto& [p, q] : {std::pair{one.push, other.push}, std::pair{one.lifted, other.lifted},
                             std::pair{one.height, other.height}}) {
    CHECK(std::abs(p.value - q.value) <= p.uncertainty + q.uncertainty);
    CHECK(p.uncertainty >= 1e-11);
    CHECK(p.uncertainty < 1e-9);
    CHECK(q.uncertainty == other.push.uncertainty);
    CHECK(q.uncertainty > 1e-14);
    CHECK(q.uncertainty < 1e-9);
  }
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
