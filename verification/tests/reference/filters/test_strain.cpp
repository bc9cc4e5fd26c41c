// Strain limits: what one correction does, when sweeps end, and how springs are
// sorted and coloured.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "reference/filters/strain_limit.h"

using namespace foldproof;

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

PerParticle inverse_masses(std::initializer_list<double> values) {
  PerParticle w(Eigen::Index(values.size()));
  std::copy(values.begin(), values.end(), w.data());
  return w;
}

/// Particles on the x axis, at these places.
PerParticle3 on_a_line(std::initializer_list<double> places) {
  PerParticle3 x = PerParticle3::Zero(3, Eigen::Index(places.size()));
  Eigen::Index i = 0;
  for (const double place : places) x(0, i++) = place;
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

// Of one spring in space:
constexpr double L0 = 0.63, h = 0.07;
const Vector3 d(0.2, 0.3, 0.6);  // length 0.7
PerParticle3 two_ends() {
  PerParticle3 x(3, 2);
  x.col(0) << 0.31, -0.17, 0.53;
  x.col(1) = x.col(0) + d;
  return x;
}

/// The predicted spring after a call, which must have pushed along d only, with opposite impulses.
Vector3 predicted_after_impulse(const StrainLimiter& limiter, const PerParticle3& v_before,
                                StrainSweeps& done) {
  const PerParticle3 x = two_ends();
  PerParticle3 v = v_before;
  done = limit_strain(limiter, h, x, v);
  const PerParticle3 change = v - v_before;
  const double wa = limiter.inverse_mass[0], wb = limiter.inverse_mass[1];
  CHECK((change.col(0) * wb + change.col(1) * wa).norm() < 1e-14);
  CHECK(change.col(0).cross(d).norm() < 1e-14);
  CHECK(change.col(1).cross(d).norm() < 1e-14);
  CHECK(change.norm() > 1e-3);
  return d + h * (v.col(1) - v.col(0));
}

}  // namespace

TEST_CASE("a spring that would turn over to hardly beyond its limit is corrected to all digits") {
  const double step = 0.125, upper = 1.5, beyond = std::ldexp(1.0, -32);  // [s, m, m]
  const StrainLimiter limiter = chain(limits_of(0.5, 0, 1, 1e-12), inverse_masses({1, 3}), 1);
  const PerParticle3 x = on_a_line({0, 1.25});
  PerParticle3 v = PerParticle3::Zero(3, 2);
  v(0, 1) = (-upper - beyond - 1.25) / step;
  limit_strain(limiter, step, x, v);
  CHECK(v(0, 0) == Approx(-(2 * upper + beyond) / step / 4).epsilon(1e-14));
}

TEST_CASE("limits that nobody names are the paper's tenth, in 20 sweeps to a thousandth") {
  const StrainLimits limits;
  CHECK(limits.extension == 0.1);
  CHECK(limits.compression == 0);
  CHECK(limits.order == SweepOrder::gauss_seidel);
  CHECK(limits.sweeps == 20);
  CHECK(limits.tolerance == 1e-3);
}

TEST_CASE("an impulse along a long spring brings its predicted length to the upper limit") {
  const auto limiter = chain(limits_of(0.17, 0.23, 9, 1e-9), inverse_masses({0.3, 1.7}), L0);
  PerParticle3 v(3, 2);
  v << 0.4, 1.9, -0.7, 2.3, 0.2, 3.1;
  StrainSweeps done;
  const Vector3 p = predicted_after_impulse(limiter, v, done);
  CHECK(p.norm() == Approx(1.17 * L0).epsilon(1e-14));
  CHECK(p.dot(d) > 0);
  CHECK(done.remaining_violation == 0);
  CHECK(done.unreachable == 0);
  CHECK(done.sweeps == 2);  // the second finds nothing to do
}

TEST_CASE("an impulse along a short spring brings its predicted length to the lower limit") {
  const auto limiter = chain(limits_of(0.17, 0.23, 9, 1e-9), inverse_masses({1.7, 0.3}), L0);
  PerParticle3 v(3, 2);
  v << 2.0, 0.6, 2.9, 0.1, 5.2, 0.3;
  REQUIRE((d + h * (v.col(1) - v.col(0))).norm() < 0.77 * L0);
  StrainSweeps done;
  const Vector3 p = predicted_after_impulse(limiter, v, done);
  CHECK(p.norm() == Approx(0.77 * L0).epsilon(1e-14));
  CHECK(p.dot(d) > 0);
  CHECK(done.remaining_violation == 0);
}

TEST_CASE("a spring that is predicted to turn round is made to point the way it does now") {
  const auto limiter = chain(limits_of(0.17, 0.23, 9, 1e-9), inverse_masses({0.9, 0.3}), L0);
  for (const double overshoot : {1.3, 1.9, 3.1}) {  // within its limits backwards, too short, long
    PerParticle3 v(3, 2);
    v.col(0) << 0.3, -0.2, 0.5;
    v.col(1) = v.col(0) - overshoot / h * d + Vector3(0.3, -0.2, 0);  // and some motion across
    const double start = (d + h * (v.col(1) - v.col(0))).norm() / L0;
    StrainSweeps done;
    if (start > 0.77 && start < 1.17) {
      PerParticle3 same = v;
      CHECK(limit_strain(limiter, h, two_ends(), same).sweeps == 1);
      CHECK(same == v);
      continue;
    }
    const Vector3 p = predicted_after_impulse(limiter, v, done);
    CHECK(p.norm() == Approx((start < 0.77 ? 0.77 : 1.17) * L0).epsilon(1e-13));
    CHECK(p.dot(d) > 0);
  }
}

TEST_CASE("a spring that moves too far across itself gets the least length it can reach") {
  const auto limiter = chain(limits_of(0.17, 0.23, 5, 1e-9), inverse_masses({0.3, 1.7}), L0);
  PerParticle3 v(3, 2);
  const Vector3 across = Vector3(0.3, -0.2, 0).normalized();  // perpendicular to d
  v.col(0) << 0.4, -0.7, 0.2;
  v.col(1) = v.col(0) + 0.9 / h * across + 0.4 / h * d;
  StrainSweeps done;
  const Vector3 p = predicted_after_impulse(limiter, v, done);
  CHECK(std::abs(p.dot(d)) < 1e-13);
  CHECK(p.norm() == Approx(0.9).epsilon(1e-13));
  CHECK(done.unreachable == 1);
  CHECK(done.sweeps == 5);
  CHECK(done.remaining_violation == Approx(0.9 / L0 - 1.17).epsilon(1e-12));
}

TEST_CASE("springs that no impulse can change are counted as unreachable and left alone") {
  PerParticle3 v(3, 2);
  v << 0.4, 1.9, -0.7, 2.3, 0.2, 3.1;
  const PerParticle3 before = v;
  SECTION("between prescribed particles") {
    const auto limiter = chain(limits_of(0.17, 0.23, 9, 1e-9), inverse_masses({0, 0}), L0);
    const StrainSweeps done = limit_strain(limiter, h, two_ends(), v);
    CHECK(done.sweeps == 1);
    CHECK(done.unreachable == 1);
    const double strain = (d + h * (v.col(1) - v.col(0))).norm() / L0;
    CHECK(done.remaining_violation == Approx(strain - 1.17).epsilon(1e-13));
  }
  SECTION("without length") {
    const auto limiter = chain(limits_of(0.17, 0.23, 9, 1e-9), inverse_masses({0.3, 0.7}), L0);
    PerParticle3 x = two_ends();
    x.col(1) = x.col(0);
    const StrainSweeps done = limit_strain(limiter, h, x, v);
    CHECK(done.sweeps == 1);
    CHECK(done.unreachable == 1);
    const double strain = h * (v.col(1) - v.col(0)).norm() / L0;
    CHECK(done.remaining_violation == Approx(0.77 - strain).epsilon(1e-13));
  }
  CHECK(v == before);
}

TEST_CASE("the free end alone moves if the other end is prescribed, on either side") {
  for (const int held : {0, 1}) {
    const auto limiter = chain(limits_of(0.17, 0.23, 9, 1e-9),
                               held == 0 ? inverse_masses({0, 0.6}) : inverse_masses({0.6, 0}), L0);
    PerParticle3 v(3, 2);
    v << 0.4, 1.9, -0.7, 2.3, 0.2, 3.1;
    const Vector3 prescribed = v.col(held);
    const StrainSweeps done = limit_strain(limiter, h, two_ends(), v);
    CHECK(v.col(held) == prescribed);
    CHECK((d + h * (v.col(1) - v.col(0))).norm() == Approx(1.17 * L0).epsilon(1e-14));
    CHECK(done.unreachable == 0);
  }
}

TEST_CASE("a spring within eight roundings of a limit is unchanged; beyond them it is corrected") {
  const auto limiter = chain(limits_of(0.25, 0.25, 9, 1e-3), inverse_masses({0, 0.5}), 1);
  const auto changes = [&](double length) {
    PerParticle3 v = PerParticle3::Zero(3, 2);
    limit_strain(limiter, 0.5, on_a_line({0, length}), v);
    return v != PerParticle3::Zero(3, 2);
  };
  CHECK_FALSE(changes(1));
  CHECK_FALSE(changes(1.25 * (1 + 8 * eps)));
  CHECK(changes(1.25 * (1 + 8 * eps) + eps));
  CHECK_FALSE(changes(0.75 * (1 - 8 * eps)));
  CHECK(changes(0.75 * (1 - 8 * eps) - eps / 2));
}

TEST_CASE("sweeps end where the largest violation is at the tolerance") {
  // the free middle is pulled past the limit of one spring by the other's:
  // after each sweep the first spring is 1.5 long, 0.25 too long
  const PerParticle3 x = on_a_line({0, 1, 2}), v_start = on_a_line({0, 0, 0.75});
  const PerParticle w = inverse_masses({0, 0.5, 0});
  PerParticle3 v = v_start;
  StrainSweeps done = limit_strain(chain(limits_of(0.25, 0.5, 9, 0.25), w, 1), 1, x, v);
  CHECK(done.sweeps == 2);
  CHECK(done.remaining_violation == 0.25);
  CHECK(v == on_a_line({0, 0.5, 0.75}));
  v = v_start;
  done = limit_strain(chain(limits_of(0.25, 0.5, 9, 0.24), w, 1), 1, x, v);
  CHECK(done.sweeps == 9);
  CHECK(done.remaining_violation == 0.25);
  v = v_start;  // a first sweep that is the last
  done = limit_strain(chain(limits_of(0.25, 0.5, 1, 0.24), w, 1), 1, x, v);
  CHECK(done.sweeps == 1);
  CHECK(done.remaining_violation == 0.25);
  v = v_start;  // a violation of 0.5 is within the tolerance, and so is what the sweep leaves
  done = limit_strain(chain(limits_of(0.25, 0.5, 9, 0.5), w, 1), 1, x, v);
  CHECK(done.sweeps == 1);
  CHECK(done.remaining_violation == 0.25);
}

TEST_CASE("a sweep that leaves more than it found is followed by another") {
  // the first spring is 1.375 long, within the tolerance; the second then pulls it to 1.5... and so
  // on: what a sweep found is asked for first, but what it left decides
  const PerParticle3 x = on_a_line({0, 1, 2, 3});
  const PerParticle w = inverse_masses({0, 0.5, 0.25, 0});
  PerParticle3 v = on_a_line({0, 0.125, 0.5, 1.25});
  const StrainLimiter limiter = chain(limits_of(0.25, 0.5, 40, 0.01), w, 1);
  const StrainSweeps done = limit_strain(limiter, 1, x, v);
  double worst = 0;  // of what it left
  for (int i = 0; i < 3; ++i) worst = std::max(worst, 1 + v(0, i + 1) - v(0, i) - 1.25);
  CHECK(done.remaining_violation == Approx(worst).epsilon(1e-12));
}

TEST_CASE("alternating sweeps run forwards, backwards, forwards, backwards") {
  StrainLimits limits = limits_of(0.125, 0.25, 4, 1e-12);
  const PerParticle w = inverse_masses({0.3, 0.7, 0.2, 0.9});
  const PerParticle3 x = on_a_line({0, 1, 2.1, 3}), v_start = on_a_line({0, 0.7, 1.1, 2.9});
  limits.order = SweepOrder::alternating;
  PerParticle3 v = v_start;
  CHECK(limit_strain(chain(limits, w, 1), 0.9, x, v).sweeps == 4);
  limits.order = SweepOrder::gauss_seidel;
  limits.sweeps = 1;
  StrainLimiter forwards = chain(limits, w, 1), backwards = forwards;
  std::reverse(backwards.springs.begin(), backwards.springs.end());
  PerParticle3 one_by_one = v_start;
  for (int sweep = 0; sweep < 4; ++sweep)
    limit_strain(sweep % 2 == 0 ? forwards : backwards, 0.9, x, one_by_one);
  CHECK(v == one_by_one);
  limits.sweeps = 4;
  v = v_start;
  limit_strain(chain(limits, w, 1), 0.9, x, v);
  CHECK(v != one_by_one);
  one_by_one = v_start;
  for (int sweep = 0; sweep < 4; ++sweep) limit_strain(forwards, 0.9, x, one_by_one);
  CHECK(v == one_by_one);
}

TEST_CASE("a Jacobi sweep divides each impulse by the number that meet at its busier end") {
  // lengths 1.75, 2 and 1.5 of springs limited to 1.25: shares of -0.5, -0.75 and -0.25, halved
  StrainLimits limits = limits_of(0.25, 0.5, 1, 1e-9);
  limits.order = SweepOrder::jacobi;
  PerParticle3 v = on_a_line({0, 0.75, 1.75, 2.25});
  const StrainLimiter limiter = chain(limits, inverse_masses({0.3, 0.6, 1.2, 2.4}), 1);
  const StrainSweeps done = limit_strain(limiter, 1, on_a_line({0, 1, 2, 3}), v);
  const double first = 0.25 / 0.9, second = 0.375 / 1.8, third = 0.125 / 3.6;  // impulses
  CHECK(v(0, 0) == Approx(0.3 * first));
  CHECK(v(0, 1) == Approx(0.75 - 0.6 * first + 0.6 * second));
  CHECK(v(0, 2) == Approx(1.75 - 1.2 * second + 1.2 * third));
  CHECK(v(0, 3) == Approx(2.25 - 2.4 * third));
  CHECK(done.sweeps == 1);
}

TEST_CASE("in a Jacobi sweep impulses are not counted at prescribed ends or for held springs") {
  StrainLimits limits = limits_of(0.25, 0.5, 1, 1e-9);
  limits.order = SweepOrder::jacobi;
  // a prescribed hub, two free particles, and another prescribed one; one spring is within limits
  const std::vector<Spring> springs{
      {0, 1, 1, 0, 0}, {0, 2, 1, 0, 0}, {0, 3, 1, 0, 0}, {1, 2, 3, 0, 0}};
  const StrainLimiter limiter =
      make_strain_limiter(limits, springs, inverse_masses({0, 0.3, 0.7, 0}));
  PerParticle3 v = on_a_line({0, -0.75, 0.5, 4});
  const StrainSweeps done = limit_strain(limiter, 1, on_a_line({0, -1, 1, 2}), v);
  CHECK(v(0, 1) == Approx(-0.25));  // in full: predicted 1.25 away from the hub
  CHECK(v(0, 2) == Approx(0.25));
  CHECK(v(0, 3) == 4);
  CHECK(done.unreachable == 1);
}

TEST_CASE("the filter limits strain over the step's length and adds up its sweeps") {
  StrainLimiter limiter = chain(limits_of(0.25, 0.5, 9, 0.24), inverse_masses({0, 0.5, 0}), 1);
  State s;
  s.x = on_a_line({0, 1, 2});
  s.v = on_a_line({5, 6, 7});
  PerParticle3 v = on_a_line({0, 0, 1.5});
  Work work;
  work.strain_sweeps = 30, work.strain_left = 0.125;
  limiter.correct({3, 3, 0.5}, s, v, work);
  CHECK(work.strain_sweeps == 39);
  CHECK(work.strain_left == 0.25);
  CHECK(v == on_a_line({0, 1, 1.5}));
}

TEST_CASE("strain limits are refused outside their ranges, and taken at the ends of these") {
  const auto accepts = [](double extension, double compression, int sweeps, double tolerance) {
    const StrainLimits limits = limits_of(extension, compression, sweeps, tolerance);
    CHECK_NOTHROW(make_strain_limiter(limits, {}, inverse_masses({1})));
  };
  const auto refuses = [](double extension, double compression, int sweeps, double tolerance,
                          const std::string& why) {
    const StrainLimits limits = limits_of(extension, compression, sweeps, tolerance);
    CHECK_THROWS_WITH(make_strain_limiter(limits, {}, inverse_masses({1})),
                      "strain limits: " + why);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN(), least = 1e-300;
  accepts(0, 0, 1, least);
  accepts(1.5, 0.999, 2, 1.5);
  accepts(0.3, 0.4, 7, 0.1);
  for (const double wrong : {-least, -0.3, nan})
    refuses(wrong, 0.2, 3, 0.1, "extension must be a number >= 0");
  for (const double wrong : {-least, 1.0, 1.5, nan})
    refuses(0.3, wrong, 3, 0.1, "compression must lie in [0, 1)");
  for (const double wrong : {0.0, -0.3, nan}) refuses(0.3, 0.2, 3, wrong, "tolerance must be > 0");
  for (const int wrong : {0, -3}) refuses(0.3, 0.2, wrong, 0.1, "at least one sweep is needed");
}

TEST_CASE("springs are sorted by their particles; those of the same particles keep their order") {
  const std::vector<Spring> springs{{2, 5, 0.7, 0, 0}, {0, 3, 0.4, 0, 0}, {2, 4, 0.6, 0, 0},
                                    {0, 1, 0.9, 0, 0}, {0, 1, 0.2, 0, 0}, {1, 2, 0.3, 0, 0}};
  const StrainLimiter limiter =
      make_strain_limiter({}, springs, inverse_masses({1, 2, 3, 4, 5, 6}));
  CHECK(limiter.colours == std::vector<int>{0, 6});
  std::vector<double> lengths;
  std::vector<std::pair<int, int>> ends;
  for (const LimitedSpring& spring : limiter.springs) {
    lengths.push_back(spring.rest_length);
    ends.emplace_back(spring.a, spring.b);
  }
  CHECK(lengths == std::vector<double>{0.9, 0.2, 0.4, 0.3, 0.6, 0.7});
  CHECK(ends == std::vector<std::pair<int, int>>{{0, 1}, {0, 1}, {0, 3}, {1, 2}, {2, 4}, {2, 5}});
  CHECK(limiter.inverse_mass[4] == 5);
}

TEST_CASE("springs get the first colour that is free at both ends, and stand colour by colour") {
  StrainLimits limits;
  limits.order = SweepOrder::coloured;
  const std::vector<Spring> springs{{4, 5, 1, 0, 0}, {2, 3, 1, 0, 0}, {1, 3, 1, 0, 0},
                                    {1, 2, 1, 0, 0}, {0, 3, 1, 0, 0}, {0, 2, 1, 0, 0},
                                    {0, 1, 1, 0, 0}};
  const StrainLimiter limiter =
      make_strain_limiter(limits, springs, inverse_masses({1, 2, 3, 4, 5, 6}));
  std::vector<std::pair<int, int>> ends;
  for (const LimitedSpring& spring : limiter.springs) ends.emplace_back(spring.a, spring.b);
  CHECK(ends ==
        std::vector<std::pair<int, int>>{{0, 1}, {2, 3}, {4, 5}, {0, 2}, {1, 3}, {0, 3}, {1, 2}});
  CHECK(limiter.colours == std::vector<int>{0, 3, 5, 7});
  CHECK(make_strain_limiter(limits, {}, inverse_masses({1})).colours == std::vector<int>{0});
  CHECK(make_strain_limiter({}, {}, inverse_masses({1})).colours == std::vector<int>{0, 0});
}

TEST_CASE("a spring whose motion across is as long as its limit is reachable, just") {
  const auto limiter = chain(limits_of(0.25, 0.5, 9, 1e-9), inverse_masses({0.5, 0.25}), 1);
  PerParticle3 v = on_a_line({0, 0.5});
  v(1, 1) = 1.25;
  const StrainSweeps done = limit_strain(limiter, 1, on_a_line({0, 1}), v);
  CHECK(done.unreachable == 0);
  CHECK(v(0, 1) - v(0, 0) == Approx(-1));
}

TEST_CASE("a spring between equal masses gives half of its change to each") {
  const auto limiter = chain(limits_of(0.25, 0.5, 9, 1e-9), inverse_masses({0.7, 0.7}), 1);
  PerParticle3 v = on_a_line({0.5, 1.75});
  const StrainSweeps done = limit_strain(limiter, 1, on_a_line({0, 1}), v);
  CHECK(v(0, 0) == Approx(1));
  CHECK(v(0, 1) == Approx(1.25));
  CHECK(done.unreachable == 0);
}

TEST_CASE("sweeps of strain limiting end at the tolerance, not below it") {
  // the long spring is met last, and leaves the short one too long
  const std::vector<Spring> springs{{0, 1, 0.5, 1, 0}, {1, 2, 2, 1, 0}};
  const PerParticle3 x = (PerParticle3(3, 3) << 0, 0.5, 2.8, 0, 0, 0, 0, 0, 0).finished();
  const PerParticle inverse_mass = (PerParticle(3) << 0, 1, 0).finished();
  const auto limited = [&](double tolerance) {
    StrainLimits limits;
    limits.tolerance = tolerance;
    PerParticle3 v = PerParticle3::Zero(3, 3);
    return limit_strain(make_strain_limiter(limits, springs, inverse_mass), 1, x, v);
  };
  const StrainSweeps once = limited(1);
  CHECK(once.sweeps == 1);
  CHECK(once.remaining_violation == Approx(0.1));
  CHECK(limited(once.remaining_violation).sweeps == 1);
  CHECK(limited(std::nextafter(once.remaining_violation, 0)).sweeps > 1);
}
