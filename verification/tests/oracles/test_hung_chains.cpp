// Chains that hang, ribbons that tip and columns that fall: Bessel's functions of the standard
// library, and the differential equations.
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/types.h"
#include "verification/oracles/chains_and_ribbons.h"

using namespace foldproof;
using namespace foldproof::oracles;

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
