#include "verification/oracles/heavy_cantilever.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "reference/types.h"
#include "verification/oracles/gsl.h"

// Shooting from the tip. With u = 1 - s and phi = pi/2 - theta the strip obeys
//   phi'' = gamma u sin(phi),   phi'(0) = 0,   phi(1) = pi/2,
// and phi(0) = b is unknown. For large gamma b is as small as exp(-2/3 sqrt(gamma)), so the unknown
// is ln b; l = ln(phi) and r = phi'/phi are integrated, as they stay of moderate size:
//   l' = r,   r' = gamma u sin(phi)/phi - r^2,   H' = cos(phi),   W' = sin(phi).
// Beyond phi = pi/2, which the solution only reaches at the clamp, sin(phi) is held at 1. Then
// phi(1) rises monotonically with b, and the strips with loops, which are other solutions, drop
// out.

namespace foldproof::oracles {

namespace {

constexpr double tolerance = 1e-13;
const double log_right_angle = std::log(0.5 * pi);

/// Result at the clamp of shooting with one value of ln b.
struct Shot {
  double miss;  // ln(phi(1)) - ln(pi/2)
  double drop, reach;
  double uncertainty;  // of each
};

Shot shoot(double gamma, double log_b) {
  const RightHandSide rhs = [gamma](double u, std::span<const double> y, std::span<double> dy) {
    const double phi = std::exp(y[0]), bounded = std::min(phi, 0.5 * pi);
    dy[0] = y[1];
    dy[1] = gamma * u * std::sin(bounded) / phi - y[1] * y[1];
    dy[2] = std::cos(bounded);
    dy[3] = std::sin(bounded);
  };
  const std::array<double, 4> tip{log_b, 0, 0, 0};
  const std::array<double, 1> clamp{1};
  const ReferenceSolution solution = reference_solution(rhs, tip, 0, clamp, tolerance);
  const std::vector<double>& y = solution.values[0];
  return {y[0] - log_right_angle, y[2], y[3], solution.uncertainty[0]};
}

}  // namespace

CantileverTip heavy_cantilever(double gamma) {
  if (!(gamma > 0 && gamma <= 1e5))
    throw InputError("oracle heavy_cantilever: gamma must be in (0, 1e5]");

  // phi'/phi never exceeds sqrt(gamma u), whose integral bounds the growth of ln(phi)
  // up to the clamp
  const double most_growth = 2.0 / 3.0 * std::sqrt(gamma) + 0.1;
  const auto miss = [gamma](double log_b) { return shoot(gamma, log_b).miss; };
  const Estimate log_b = bracketed_root(miss, log_right_angle - most_growth, log_right_angle, 0);

  // an error of the miss moves the tip in the same ratio as a small change of ln b does
  const double change = 1e-5;
  const Shot hit = shoot(gamma, log_b.value), beside = shoot(gamma, log_b.value - change);
  const double off = std::abs(hit.miss) + hit.uncertainty + log_b.uncertainty;
  const double ratio = off / std::abs(beside.miss - hit.miss);
  return {{hit.drop, hit.uncertainty + std::abs(beside.drop - hit.drop) * ratio},
          {hit.reach, hit.uncertainty + std::abs(beside.reach - hit.reach) * ratio}};
}

}  // namespace foldproof::oracles
