#include "verification/oracles/tip_load.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "reference/types.h"
#include "verification/oracles/gsl.h"

namespace foldproof::oracles {

namespace {

void require_moderate(double alpha) {
  if (!(alpha > 0 && alpha <= 100)) throw InputError("oracle tip_load: alpha must be in (0, 100]");
}

/// The integrals for one slope of the tip.
struct Elliptic {
  long double first, second;  // K(k) - F(phi, k), E(k) - E(phi, k)
};

/// The slope of the tip is pi/2 - 2 eta, eta <= pi/4. Then k = cos(eta), and 1 - k^2 = sin(eta)^2.
/// In extended precision, because the library's integrals are only accurate to a thousand
/// roundings. The double nearest to pi/4 is below it, so 1/(k sqrt 2) < 1.
Elliptic elliptic(double eta) {
  const long double k = std::cos((long double)eta);
  const long double phi = std::asin(1 / (k * std::numbers::sqrt2_v<long double>));
  return {std::comp_ellint_1(k) - std::ellint_1(k, phi),
          std::comp_ellint_2(k) - std::ellint_2(k, phi)};
}

/// Result at the tip of shooting with one curvature at the clamp: slope, curvature, drop, reach.
ReferenceSolution shoot(double alpha, double curvature) {
  const RightHandSide rhs = [alpha](double, std::span<const double> y, std::span<double> dy) {
    dy[0] = y[1];
    dy[1] = -alpha * std::cos(y[0]);
    dy[2] = std::sin(y[0]);
    dy[3] = std::cos(y[0]);
  };
  const std::array<double, 4> clamp{0, curvature, 0, 0};
  return reference_solution(rhs, clamp, 0, std::array<double, 1>{1}, 1e-13);
}

}  // namespace

LoadedTip tip_load(double alpha) {
  require_moderate(alpha);
  const double wanted = std::sqrt(alpha);
  const auto miss = [wanted](double eta) { return double(elliptic(eta).first - wanted); };
  const Estimate eta = bracketed_root(miss, 1e-7, pi / 4, 0);
  // the integrals are good to some roundings; near eta = pi/4 a rounding of k moves phi by its root
  const auto tip = [wanted](double at) {
    return std::array<double, 2>{double(1 - 2 * elliptic(at).second / wanted),
                                 std::sqrt(2 * std::cos(2 * at)) / wanted};
  };
  const double change = 1e-7;
  const std::array<double, 2> here = tip(eta.value), beside = tip(eta.value - change);
  const double off = eta.uncertainty + 64 * std::numeric_limits<double>::epsilon();
  const double rounding = 1e-13;
  return {{here[0], rounding + std::abs(beside[0] - here[0]) / change * off},
          {here[1], rounding + std::abs(beside[1] - here[1]) / change * off}};
}

LoadedTip tip_load_by_shooting(double alpha) {
  require_moderate(alpha);
  const auto miss = [alpha](double curvature) { return shoot(alpha, curvature).values[0][1]; };
  // theta'(0)^2 = 2 alpha sin(theta(1)) < 2 alpha, and theta'(0) < alpha
  const double most = std::min(alpha, std::sqrt(2 * alpha) * (1 - 1e-9));
  // a little below the wanted curvature the tip curls back; far below, it swings to and fro
  double least = most;
  while (miss(least) > 0) least *= 0.995;
  const Estimate curvature = bracketed_root(miss, least, most, 1e-14);
  const ReferenceSolution hit = shoot(alpha, curvature.value);
  // a tip moves less than 10 times that
  const double off = 10 * (curvature.uncertainty + hit.uncertainty[0]);
  return {{hit.values[0][2], off}, {hit.values[0][3], off}};
}

}  // namespace foldproof::oracles
