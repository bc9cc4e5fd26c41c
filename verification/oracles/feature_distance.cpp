#include "verification/oracles/feature_distance.h"

#include <algorithm>

#include "verification/oracles/triple.h"

namespace foldproof::oracles {

namespace {

using Real = Digits50;
using Point = Triple<Real>;

Point point(const FourPoints& x, int column) { return {x(0, column), x(1, column), x(2, column)}; }

Real squared_to_segment(const Point& p, const Point& a, const Point& b) {
  const Point along = b - a, from = p - a;
  const Real length2 = dot(along, along), at = dot(from, along);
  if (at <= 0 || at >= length2) return std::min(dot(from, from), dot(p - b, p - b));
  const Point across = cross(from, along);
  return dot(across, across) / length2;
}

/// The foot of p on the plane lies in the triangle when it is on the inner side of each edge.
Real squared_to_triangle(const Point& p, const std::array<Point, 3>& t) {
  Real least = squared_to_segment(p, t[0], t[1]);
  for (const std::size_t k : {1, 2})
    least = std::min(least, squared_to_segment(p, t[k], t[(k + 1) % 3]));
  const Point n = cross(t[1] - t[0], t[2] - t[0]);
  if (dot(n, n) == 0) return least;
  for (std::size_t k = 0; k < 3; ++k)
    if (dot(cross(n, t[(k + 1) % 3] - t[k]), p - t[k]) < 0) return least;
  const Real height = dot(n, p - t[0]);
  return std::min<Real>(least, height * height / dot(n, n));
}

/// a + s u and b + r w are nearest where their difference is along n = u x w: s = (b - a) x w . n /
/// n . n, r likewise.
Real squared_between(const std::array<Point, 2>& a, const std::array<Point, 2>& b) {
  Real least = std::min(squared_to_segment(a[0], b[0], b[1]), squared_to_segment(a[1], b[0], b[1]));
  least =
      std::min({least, squared_to_segment(b[0], a[0], a[1]), squared_to_segment(b[1], a[0], a[1])});
  const Point u = a[1] - a[0], w = b[1] - b[0], n = cross(u, w), apart = b[0] - a[0];
  const Real size = dot(n, n), s = dot(cross(apart, w), n), r = dot(cross(apart, u), n);
  if (size == 0 || s < 0 || s > size || r < 0 || r > size) return least;
  const Real height = dot(apart, n);
  return std::min<Real>(least, height * height / size);
}

}  // namespace

Estimate feature_distance(Features features, const FourPoints& x) {
  const Point a = point(x, 0), b = point(x, 1), c = point(x, 2), d = point(x, 3);
  const Real squared = features == Features::vertex_and_triangle ? squared_to_triangle(a, {b, c, d})
                                                                 : squared_between({a, b}, {c, d});
  return rounded(sqrt(squared));
}

}  // namespace foldproof::oracles
