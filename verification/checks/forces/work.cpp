#include "verification/checks/forces/work.h"

#include "verification/specimens/probe.h"
#include "verification/specimens/random.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

/// Work and integral of |F||dx| [J].
struct Integral {
  double work = 0, scale = 0;
};

void add(const Probe& probe, const Path& path, double parameter, double weight, Integral& sum) {
  const PerParticle3 f = probe.elastic(resting_state(path.x(parameter))),
                     slope = path.slope(parameter);
  sum.work += weight * f.cwiseProduct(slope).sum();
  sum.scale += weight * f.colwise().norm().cwiseProduct(slope.colwise().norm()).sum();
}

/// Five points a panel: exact for polynomials of degree 9.
Integral gauss(const Probe& probe, const Path& path, int panels) {
  const double inner = std::sqrt(5 - 2 * std::sqrt(10.0 / 7)) / 3,
               outer = std::sqrt(5 + 2 * std::sqrt(10.0 / 7)) / 3;
  const double heavy = (322 + 13 * std::sqrt(70.0)) / 900,
               light = (322 - 13 * std::sqrt(70.0)) / 900;
  const std::array<double, 5> nodes = {-outer, -inner, 0, inner, outer};
  const std::array<double, 5> weights = {light, heavy, 128.0 / 225, heavy, light};
  Integral sum;
  for (int panel = 0; panel < panels; ++panel) {
    for (int k = 0; k < 5; ++k)
      add(probe, path, (panel + 0.5 + 0.5 * nodes[k]) / panels, 0.5 * weights[k] / panels, sum);
  }
  return sum;
}

Integral trapezoidal(const Probe& probe, const Path& loop, int points) {
  Integral sum;
  for (int point = 0; point < points; ++point)
    add(probe, loop, double(point) / points, 1.0 / points, sum);
  return sum;
}

struct Refinement {
  Integral sum;
  double change;  // from the rule with half as many points [J]
};

/// Doubles the number of parts until the result changes by at most eight roundings of the scale, or
/// `most` parts are reached.
Refinement refine(const std::function<Integral(int)>& rule, int parts, int most) {
  Integral coarse = rule(parts);
  while (true) {
    parts *= 2;
    const Integral fine = rule(parts);
    const double change = std::abs(fine.work - coarse.work);
    if (change <= 8 * epsilon * fine.scale || parts >= most) return {fine, change};
    coarse = fine;
  }
}

}  // namespace

Path random_line(const PerParticle3& x, double size, unsigned seed) {
  const PerParticle3 direction = Random(seed).vectors(x.cols(), size);
  return {[=](double t) -> PerParticle3 { return x + (2 * t - 1) * direction; },
          [=](double) -> PerParticle3 { return 2 * direction; }};
}

Path random_loop(const PerParticle3& x, double size, unsigned seed) {
  Random random(seed);
  const PerParticle3 p = random.vectors(x.cols(), size), q = random.vectors(x.cols(), size);
  const double turn = 2 * pi;
  return {
      [=](double t) -> PerParticle3 { return x + std::cos(turn * t) * p + std::sin(turn * t) * q; },
      [=](double t) -> PerParticle3 {
        return turn * (std::cos(turn * t) * q - std::sin(turn * t) * p);
      }};
}

oracles::Estimate energy_against_work(const Probe& probe, const Path& path) {
  const double before = probe.energy(resting_state(path.x(0))),
               after = probe.energy(resting_state(path.x(1)));
  const Refinement line = refine([&](int panels) { return gauss(probe, path, panels); }, 8, 128);
  const double unit = epsilon * (line.sum.scale + std::abs(before) + std::abs(after));
  return {std::abs(after - before + line.sum.work) / unit, line.change / unit};
}

RoundTrip round_trip(const Probe& probe, const Path& loop) {
  const Refinement trip =
      refine([&](int points) { return trapezoidal(probe, loop, points); }, 64, 1024);
  return {trip.sum.work, trip.change, trip.sum.scale};
}

}  // namespace foldproof
