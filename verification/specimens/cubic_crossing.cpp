#include "verification/specimens/cubic_crossing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace foldproof {

namespace {

double volume(const Vector3& a, const Vector3& b, const Vector3& c) { return a.cross(b).dot(c); }

/// Coefficients of the powers 0 to 3 of time of (x1 - x0) x (x2 - x0) . (x3 - x0).
std::array<double, 4> plane_cubic(const Corners4& x, const Corners4& v) {
  const Vector3 a = x.col(1) - x.col(0), b = x.col(2) - x.col(0), c = x.col(3) - x.col(0);
  const Vector3 p = v.col(1) - v.col(0), q = v.col(2) - v.col(0), r = v.col(3) - v.col(0);
  return {volume(a, b, c), volume(p, b, c) + volume(a, q, c) + volume(a, b, r),
          volume(p, q, c) + volume(p, b, r) + volume(a, q, r), volume(p, q, r)};
}

/// Real roots of c0 + c1 t + c2 t^2, of any degree down to none.
std::vector<double> roots_of_quadratic(double c0, double c1, double c2) {
  if (c2 == 0) return c1 == 0 ? std::vector<double>{} : std::vector{-c0 / c1};
  const double under = c1 * c1 - 4 * c2 * c0;
  if (!(under >= 0)) return {};
  const double q = -(c1 + std::copysign(std::sqrt(under), c1)) / 2;
  return q == 0 ? std::vector<double>{0} : std::vector{q / c2, c0 / q};
}

/// Real roots of a cubic, by the trigonometric formula or Cardano's.
std::vector<double> roots_of_cubic(const std::array<double, 4>& c) {
  if (c[3] == 0) return roots_of_quadratic(c[0], c[1], c[2]);
  const double a = c[2] / c[3] / 3, b = c[1] / c[3], d = c[0] / c[3];
  const double q = a * a - b / 3, r = (2 * a * a * a - a * b + d) / 2;
  if (r * r < q * q * q) {
    const double third = std::acos(std::clamp(r / std::sqrt(q * q * q), -1.0, 1.0)) / 3;
    std::vector<double> roots;
    for (const int k : {-1, 0, 1})
      roots.push_back(-2 * std::sqrt(q) * std::cos(third + 2 * std::numbers::pi * k / 3) - a);
    return roots;
  }
  const double s = -std::copysign(std::cbrt(std::abs(r) + std::sqrt(r * r - q * q * q)), r);
  return {s + (s == 0 ? 0 : q / s) - a};
}

}  // namespace

bool cubic_crossing(PairKind kind, const Corners4& x, const Corners4& displacement,
                    double tolerance) {
  std::vector<double> times = roots_of_cubic(plane_cubic(x, displacement));
  times.push_back(1);
  return std::ranges::any_of(times, [&](double t) {
    return t >= 0 && t <= 1 && nearness(kind, x + t * displacement).distance < tolerance;
  });
}

}  // namespace foldproof
