// Amplification factors, each compared with the method's own lines on y' = lambda y.
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <string>

#include "verification/oracles/amplification.h"

using namespace foldproof;
using namespace foldproof::oracles;

namespace {

using Complex = std::complex<double>;

/// One step from 1, stage by stage as the textbooks print it.
Complex by_stages(const std::string& method, Complex z) {
  if (method == "forward-euler") return 1.0 + z;
  if (method == "RK2") return 1.0 + z * (1.0 + z / 2.0);
  if (method == "SSP-RK3") {
    const Complex y1 = 1.0 + z, y2 = 0.75 + 0.25 * (y1 + z * y1);
    return 1.0 / 3 + 2.0 / 3 * (y2 + z * y2);
  }
  const Complex k1 = 1, k2 = 1.0 + z / 2.0 * k1, k3 = 1.0 + z / 2.0 * k2, k4 = 1.0 + z * k3;
  return 1.0 + z / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
}

constexpr double roundings = 20 * 2.3e-16;

}  // namespace

TEST_CASE("factors of explicit methods are those of their stages") {
  const Oscillator oscillator{13.7, 1.9, 0, 0};
  const double h = .083;
  const Complex root = std::sqrt(Complex(1.9 * 1.9 / 4 - 13.7)), lambda = -1.9 / 2 + root;
  for (const std::string method : {"forward-euler", "RK2", "SSP-RK3", "RK4"}) {
    INFO(method);
    const Factors factors = step_factors(method, oscillator, h);
    CHECK(std::abs(factors[0] - by_stages(method, h * lambda)) < roundings);
    CHECK(std::abs(factors[1] - by_stages(method, h * std::conj(lambda))) < roundings);
  }
}

TEST_CASE("factors of implicit methods solve their equations") {
  for (const Oscillator& oscillator : {Oscillator{13.7, 1.9, 0, 0}, Oscillator{2.3, 41, 0, 0}}) {
    const double h = .31;
    const Factors exact = exact_factors(oscillator, h);
    for (size_t i = 0; i < 2; ++i) {
      const Complex z = std::log(exact[i]);
      const Complex euler = step_factors("backward-euler", oscillator, h)[i];
      const Complex midpoint = step_factors("implicit-midpoint", oscillator, h)[i];
      const Complex bdf = step_factors("BDF2", oscillator, h)[i];
      CHECK(std::abs(euler - 1.0 - z * euler) < 10 * roundings);
      CHECK(std::abs(midpoint - 1.0 - z * (midpoint + 1.0) / 2.0) < 10 * roundings);
      CHECK(std::abs(1.5 * bdf * bdf - 2.0 * bdf + 0.5 - z * bdf * bdf) < 10 * roundings);
    }
  }
}

TEST_CASE("factors err by the method's order and one") {
  const Oscillator oscillator{7.1, .6, 0, 0};
  for (const auto& [method, order] : {std::pair{"A", 2},
                                      {"B", 2},
                                      {"C", 2},
                                      {"RK2", 2},
                                      {"SSP-RK3", 3},
                                      {"RK4", 4},
                                      {"BDF2", 2},
                                      {"implicit-midpoint", 2},
                                      {"backward-euler", 1},
                                      {"linear-backward-euler", 1},
                                      {"forward-euler", 1}}) {
    INFO(method);
    const auto error = [&](double h) {
      return std::abs(step_factors(method, oscillator, h)[0] - exact_factors(oscillator, h)[0]);
    };
    CHECK(std::log2(error(.01) / error(.005)) == Approx(order + 1).margin(.05));
  }
}

TEST_CASE("an unknown method has no factors") {
  CHECK_THROWS_AS(step_factors("leapfrog", {1.7, 0, 0, 0}, .1), InputError);
  CHECK_THROWS_AS(step_factors("RK4", {1.7, 0, 0, 0}, -.1), InputError);
}
