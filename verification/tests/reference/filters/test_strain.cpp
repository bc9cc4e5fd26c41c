// Strain limits: which springs are corrected and counted, and when sweeps end.
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/filters/strain_limit.h"

using namespace foldproof;

namespace {

PerParticle inverse_masses(std::initializer_list<double> values) {
  PerParticle w(Eigen::Index(values.size()));
  std::copy(values.begin(), values.end(), w.data());
  return w;
}

/// Particles on the x axis, at these places.
PerParticle3 on_a_line(std::initializer_list<double> places) {
  PerParticle3 x = PerParticle3::Zero(3, Eigen::Index(places.size()));
  x.row(0) = inverse_masses(places).transpose();
  return x;
}

StrainLimits limits_of(double extension, double compression, int sweeps, double tolerance) {
  return {extension, compression, SweepOrder::gauss_seidel, sweeps, tolerance};
}

/// Springs between neighbours of a chain.
StrainLimiter chain(const StrainLimits& limits, const PerParticle& inverse_mass, double L0) {
  std::vector<Spring> springs;
  for (int i = 0; i + 1 < int(inverse_mass.size()); ++i) springs.push_back({i, i + 1, L0, 0, 0});
  return make_strain_limiter(limits, springs, inverse_mass);
}

}  // namespace

TEST_CASE("a spring that would turn over to hardly beyond its limit is corrected to all digits") {
  const double step = 0.125, upper = 1.5, beyond = std::ldexp(1.0, -32);  // [s, m, m]
  const StrainLimiter limiter = chain(limits_of(0.5, 0, 1, 1e-12), inverse_masses({1, 3}), 1);
  PerParticle3 v = PerParticle3::Zero(3, 2);
  v(0, 1) = (-upper - beyond - 1.25) / step;
  limit_strain(limiter, step, on_a_line({0, 1.25}), v);
  CHECK(v(0, 0) == Approx(-(2 * upper + beyond) / step / 4).epsilon(1e-14));
}

TEST_CASE("a spring whose motion across is as long as its limit is reachable, a longer one not") {
  const auto limiter = chain(limits_of(0.25, 0.5, 9, 1e-9), inverse_masses({0.5, 0.25}), 1);
  for (const double across : {1.25, 1.5}) {
    PerParticle3 v = on_a_line({0, 0.5});
    v(1, 1) = across;
    const StrainSweeps done = limit_strain(limiter, 1, on_a_line({0, 1}), v);
    CHECK(done.unreachable == (across > 1.25 ? 1 : 0));
    CHECK(done.sweeps == (across > 1.25 ? 9 : 2));  // the second finds nothing to do
    CHECK(done.remaining_violation == Approx(across - 1.25));
    CHECK(v(0, 1) - v(0, 0) == Approx(-1));
  }
}

TEST_CASE("a Jacobi sweep divides each impulse by the number that meet at its busier free end") {
  StrainLimits limits = limits_of(0.25, 0.5, 1, 1e-9);
  limits.order = SweepOrder::jacobi;
  // lengths 1.75, 2 and 1.5 of springs limited to 1.25: impulses of -0.5, -0.75 and -0.25, halved
  PerParticle3 v = on_a_line({0, 0.75, 1.75, 2.25});
  const PerParticle w = inverse_masses({0.3, 0.6, 1.2, 2.4});
  limit_strain(chain(limits, w, 1), 1, on_a_line({0, 1, 2, 3}), v);
  const double first = 0.25 / 0.9, second = 0.375 / 1.8, third = 0.125 / 3.6;
  CHECK(v(0, 0) == Approx(0.3 * first));
  CHECK(v(0, 1) == Approx(0.75 - 0.6 * first + 0.6 * second));
  CHECK(v(0, 2) == Approx(1.75 - 1.2 * second + 1.2 * third));
  CHECK(v(0, 3) == Approx(2.25 - 2.4 * third));

  // a prescribed hub, two free particles, and another prescribed one; one spring is within limits
  const std::vector<Spring> springs{
      {0, 1, 1, 0, 0}, {0, 2, 1, 0, 0}, {0, 3, 1, 0, 0}, {1, 2, 3, 0, 0}};
  v = on_a_line({0, -0.75, 0.5, 4});
  const StrainSweeps done =
      limit_strain(make_strain_limiter(limits, springs, inverse_masses({0, 0.3, 0.7, 0})), 1,
                   on_a_line({0, -1, 1, 2}), v);
  CHECK(v(0, 1) == Approx(-0.25));  // in full: predicted 1.25 away from the hub
  CHECK(v(0, 2) == Approx(0.25));
  CHECK(v(0, 3) == 4);
  CHECK(done.unreachable == 1);
}
