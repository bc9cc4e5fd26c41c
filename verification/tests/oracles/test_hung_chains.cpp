// Chains that hang, ribbons that tip and columns that fall: Bessel's functions of the standard
// library, the differential equations, and balances of forces.
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/types.h"
#include "verification/oracles/chains_and_ribbons.h"
#include "verification/oracles/gauss.h"

using namespace foldproof;
using namespace foldproof::oracles;

namespace {

constexpr double epsilon = 2.220446049250313e-16;

void check_agreement(const Estimate& series, const Estimate& shooting) {
  CHECK(std::abs(series.value - shooting.value) <= series.uncertainty + shooting.uncertainty);
  CHECK(shooting.uncertainty > 1e-13);
  CHECK(shooting.uncertainty < 3e-10);
}

/// y'' by differences.
template <class Function>
double bend(const Function& y, double t) {
  constexpr double h = 1e-3;
  return (-y(t + 2 * h) + 16 * y(t + h) - 30 * y(t) + 16 * y(t - h) - y(t - 2 * h)) / (12 * h * h);
}

}  // namespace

TEST_CASE("a chain's frequencies are half the roots of Bessel's function") {
  for (const int n : {1, 2, 3, 4, 5}) {
    const Estimate series = chain_frequency_by_series(n);
    const double root = 2 * series.value;
    CHECK(std::abs(root - (n - .25) * pi) < .06);
    CHECK(std::cyl_bessel_j(0, root * (1 - 1e-12)) * std::cyl_bessel_j(0, root * (1 + 1e-12)) < 0);
    CHECK(series.uncertainty == Approx(200 * epsilon).epsilon(1e-6));
    const Estimate shot = chain_frequency_by_shooting(n);
    check_agreement(series, shot);
    // 1e-11 of the function's value moves the root by as much over its slope, which is -J1
    CHECK(shot.uncertainty == Approx(.5e-11 / std::abs(std::cyl_bessel_j(1, root))).epsilon(.01));
  }
  for (const int n : {0, 6}) {
    const std::string why = "oracle chains_and_ribbons: the mode must be one of 1 to 5";
    CHECK_THROWS_WITH(chain_frequency_by_series(n), why);
    CHECK_THROWS_WITH(chain_frequency_by_shooting(n), why);
  }
}

TEST_CASE("a ribbon's twist obeys its equation at the load that tips it") {
  const Estimate load = tipping_load_by_series();
  check_agreement(load, tipping_load_by_shooting());
  CHECK(load.uncertainty == Approx(20 * epsilon).epsilon(1e-6));
  CHECK(load.value == Approx(12.85).epsilon(1e-3));
  CHECK(tipping_twist(0) == 1);
  CHECK(std::abs(tipping_twist(1)) < 1e-14);
  for (const double t : {.3, .62, .9})
    CHECK(std::abs(bend(tipping_twist, t) +
                   load.value * load.value / 4 * std::pow(t, 4) * tipping_twist(t)) < 1e-6);
}

TEST_CASE("a column's slope obeys its equation at Greenhill's load, and leads to its free end") {
  const Estimate load = self_buckling_load_by_series();
  check_agreement(load, self_buckling_load_by_shooting());
  CHECK(load.uncertainty == Approx(20 * epsilon).epsilon(1e-6));
  CHECK(load.value == Approx(7.8373474).epsilon(1e-7));
  CHECK(std::abs(self_buckling_slope(1)) < 1e-14);
  for (const double t : {.25, .6, .91})
    CHECK(std::abs(bend(self_buckling_slope, t) + load.value * t * self_buckling_slope(t)) < 1e-6);
  const Gauss gauss(20);
  double end = 0;
  for (int i = 0; i < 20; ++i) end += gauss.weight[i] * self_buckling_slope(gauss.s[i]);
  CHECK(end == Approx(1).epsilon(1e-13));
}

TEST_CASE("a catenary of given pulls is found again from where its ends are") {
  const std::vector<double> s{.13, .58, .9, 1};
  for (const auto& [H, V] : {std::pair{.31, .62}, {.07, .45}, {1.9, -.3}, {.2, 1.15}}) {
    const auto across = [H = H, V = V](double at) {
      return H * (std::asinh((at - V) / H) + std::asinh(V / H));
    };
    const auto up = [H = H, V = V](double at) { return std::hypot(H, at - V) - std::hypot(H, V); };
    const HungChain chain{across(1), up(1)};
    for (const Catenary& shape : {catenary(chain, s), catenary_by_shooting(chain, s)}) {
      REQUIRE(shape.points.size() == s.size());
      CHECK(shape.uncertainty > 1e-15);
      CHECK(shape.uncertainty < 1e-9);
      const double off = shape.uncertainty + 1e-13;
      CHECK(std::abs(shape.pull_across.value - H) <= 100 * off);
      CHECK(std::abs(shape.pull_up.value + V) <= 100 * off);
      for (std::size_t i = 0; i < s.size(); ++i) {
        CHECK(std::abs(shape.points[i].across - across(s[i])) <= 100 * off);
        CHECK(std::abs(shape.points[i].up - up(s[i])) <= 100 * off);
      }
    }
  }
}

TEST_CASE("a chain's pulls carry their own uncertainty, a tenth of the points'") {
  const Catenary shape = catenary({.6, .2}, {});
  CHECK(shape.points.empty());
  CHECK(shape.pull_across.uncertainty == shape.pull_up.uncertainty);
  CHECK(shape.uncertainty == Approx(10 * shape.pull_up.uncertainty).epsilon(1e-12));
  const double H = shape.pull_across.value, least = 20 * epsilon * (1 + H);
  CHECK(shape.pull_up.uncertainty >= least);
  CHECK(shape.pull_up.uncertainty <= least * (1 + 4 * .6 / (2 * H)) * (1 + 1e-9));
  const std::vector<double> end{1};
  const Catenary shot = catenary_by_shooting({.6, .2}, end);
  CHECK(shot.uncertainty == shot.pull_across.uncertainty);
  CHECK(shot.uncertainty == shot.pull_up.uncertainty);
}

TEST_CASE("chains must be slack, and their second end to the right") {
  const std::vector<double> s{.5};
  const std::string why =
      "oracle chains_and_ribbons: the points must be nearer than the chain is long";
  for (const HungChain& chain : {HungChain{.6, .8}, HungChain{1, 0}, HungChain{0, .5},
                                 HungChain{-.4, .1}, HungChain{NAN, .1}, HungChain{.4, NAN}}) {
    CHECK_THROWS_WITH(catenary(chain, s), why);
    CHECK_THROWS_WITH(catenary_by_shooting(chain, s), why);
  }
  CHECK(std::abs(catenary({.02, -.3}, s).points[0].across) < .02);
  CHECK(catenary({.999, 0}, s).pull_across.value > 5);
}
