#include "reference/filters/feature_pair.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace foldproof {

namespace {

// Edges count as parallel if the squared sine of their angle is below this. Triangles count as
// lines if their squared area is below this fraction of the largest that their sides could span.
// The error is 1e-9 of their size.
constexpr double nearly_parallel = 1e-18;

/// Where along the edge from a to b the point p is nearest: 0 at a, 1 at b.
double nearest_along(const Vector3& p, const Vector3& a, const Vector3& b) {
  const Vector3 d = b - a;
  const double length2 = d.squaredNorm();  // m^2
  return length2 > 0 ? std::clamp((p - a).dot(d) / length2, 0.0, 1.0) : 0;
}

Nearness nearness_at(const Corners4& x, const Eigen::Vector4d& weights) {
  const Vector3 apart = x * weights;
  const double distance = apart.norm();
  return {distance, distance > 0 ? Vector3(apart / distance) : Vector3::Zero(), weights};
}

/// The nearest of several pairs of points.
struct NearestPoints {
  double distance = std::numeric_limits<double>::quiet_NaN();  // m
  Eigen::Vector4d weights = {};

  void add(const Corners4& x, const Eigen::Vector4d& other) {
    const double its_distance = (x * other).norm();
    if (!(distance <= its_distance)) distance = its_distance, weights = other;
  }
};

//      x3         The vertex x0 over the triangle. The foot of its perpendicular has the weights
//     /  \        w2, w3 (and w1 = 1 - w2 - w3); a negative weight means that it lies beyond the
//   x1 -- x2      side opposite that corner; the nearest point is then on such a side.
Nearness vertex_triangle(const Corners4& x) {
  const Vector3 e2 = x.col(2) - x.col(1), e3 = x.col(3) - x.col(1), r = x.col(0) - x.col(1);
  const Vector3 N = e2.cross(e3);  // twice the area [m^2]
  const double area2 = N.squaredNorm();
  Vector3 w = Vector3::Constant(-1);
  if (area2 > nearly_parallel * e2.squaredNorm() * e3.squaredNorm()) {
    w.setZero();
    // in a thin triangle the second pass corrects the rounding error of the first
    for (int pass = 0; pass < 2; ++pass) {
      const Vector3 rest = r - w[1] * e2 - w[2] * e3;
      w[1] += rest.cross(e3).dot(N) / area2;
      w[2] += e2.cross(rest).dot(N) / area2;
    }
    w[0] = 1 - w[1] - w[2];
    if (w.minCoeff() >= 0) return nearness_at(x, {1, -w[0], -w[1], -w[2]});
  }
  NearestPoints nearest;
  for (int corner = 0; corner < 3; ++corner) {
    if (w[corner] >= 0) continue;
    const int a = (corner + 1) % 3, b = (corner + 2) % 3;
    const double along = nearest_along(x.col(0), x.col(1 + a), x.col(1 + b));
    Eigen::Vector4d weights(1, 0, 0, 0);
    weights[1 + a] = -(1 - along);
    weights[1 + b] = -along;
    nearest.add(x, weights);
  }
  return nearness_at(x, nearest.weights);
}

Eigen::Vector4d edge_weights(double a, double b) { return {1 - a, a, -(1 - b), -b}; }

/// Of two edges, at an end of one of them.
Nearness nearest_at_ends(const Corners4& x) {
  NearestPoints nearest;
  for (int end = 0; end < 2; ++end) {
    nearest.add(x, edge_weights(end, nearest_along(x.col(end), x.col(2), x.col(3))));
    nearest.add(x, edge_weights(nearest_along(x.col(2 + end), x.col(0), x.col(1)), end));
  }
  return nearness_at(x, nearest.weights);
}

}  // namespace

Corners4 corners_of(const FeaturePair& pair, const PerParticle3& of) {
  Corners4 columns;
  for (int k = 0; k < 4; ++k) columns.col(k) = of.col(pair.particles[size_t(k)]);
  return columns;
}

/// x0 + a d and x2 + b e are nearest across N = d x e, so a = (x2 - x0) x e . N / |N|^2. For nearly
/// parallel edges rounding shifts a along them; projecting that point onto the other edge, and the
/// result back, gives two points as close as the nearest ones.
std::optional<Nearness> nearness_inside_edges(const Corners4& x) {
  const Vector3 d = x.col(1) - x.col(0), e = x.col(3) - x.col(2), r = x.col(2) - x.col(0);
  const Vector3 N = d.cross(e);  // m^2
  const double size = N.squaredNorm();
  if (!(size > nearly_parallel * d.squaredNorm() * e.squaredNorm())) return {};
  const double a = r.cross(e).dot(N) / size, b = r.cross(d).dot(N) / size;
  if (!(a >= 0 && a <= 1 && b >= 0 && b <= 1)) return {};
  const double foot = nearest_along(x.col(0) + a * d, x.col(2), x.col(3));
  return nearness_at(x, edge_weights(nearest_along(x.col(2) + foot * e, x.col(0), x.col(1)), foot));
}

Nearness nearness(PairKind kind, const Corners4& x) {
  if (kind == PairKind::vertex_triangle) return vertex_triangle(x);
  if (const std::optional<Nearness> inside = nearness_inside_edges(x)) return *inside;
  return nearest_at_ends(x);
}

}  // namespace foldproof
