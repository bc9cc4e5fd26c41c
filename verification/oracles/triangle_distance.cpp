#include "verification/oracles/triangle_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace foldproof::oracles {

namespace {

using Real = long double;
using Point = Eigen::Matrix<Real, 3, 1>;

Real squared_distance_to_segment(const Point& a, const Point& b, const Point& p) {
  const Point along = b - a;
  const Real t = std::clamp((p - a).dot(along) / along.squaredNorm(), Real(0), Real(1));
  return (p - a - t * along).squaredNorm();
}

/// The foot of p on the plane lies in the triangle when it is to the left of each of its edges.
Real squared_distance_to_triangle(const Point& a, const Point& b, const Point& c, const Point& p) {
  const Point normal = (b - a).cross(c - a);
  const auto is_left = [&](const Point& u, const Point& v) {
    return (v - u).cross(p - u).dot(normal) >= 0;
  };
  if (is_left(a, b) && is_left(b, c) && is_left(c, a)) {
    const Real height = (p - a).dot(normal);
    return height * height / normal.squaredNorm();
  }
  return std::min({squared_distance_to_segment(a, b, p), squared_distance_to_segment(b, c, p),
                   squared_distance_to_segment(c, a, p)});
}

}  // namespace

Estimate distance_to_triangles(const PerParticle3& x,
                               const std::vector<std::array<int, 3>>& triangles, const Vector3& p) {
  Real least = std::numeric_limits<Real>::infinity();
  for (const auto& [a, b, c] : triangles)
    least =
        std::min(least, squared_distance_to_triangle(x.col(a).cast<Real>(), x.col(b).cast<Real>(),
                                                     x.col(c).cast<Real>(), p.cast<Real>()));
  const double scale = p.norm() + x.colwise().norm().maxCoeff();
  return {double(std::sqrt(least)), 64 * double(std::numeric_limits<Real>::epsilon()) * scale};
}

}  // namespace foldproof::oracles
