#include "reference/mesh/polygon.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace foldproof {

namespace {

using Vector2 = Eigen::Vector2d;

constexpr double least_area = 1e-12;  // over the longest side squared, as in make_triangle_mesh

std::vector<Triangle> fan_of(std::span<const int> corners) {
  std::vector<Triangle> fan;
  for (size_t k = 2; k < corners.size(); ++k)
    fan.push_back({corners[0], corners[k - 1], corners[k]});
  return fan;
}

std::vector<int> without_repeats(std::span<const int> corners) {
  std::vector<int> kept;
  for (const int corner : corners)
    if (kept.empty() || corner != kept.back()) kept.push_back(corner);
  while (kept.size() > 1 && kept.front() == kept.back()) kept.pop_back();
  return kept;
}

/// The corners' shadow on the plane across the area vector; empty if the polygon has no area.
std::vector<Vector2> shadow_of(std::span<const int> corners, const PerParticle3& x) {
  const Vector3 origin = x.col(corners[0]);
  Vector3 area = Vector3::Zero(), before = Vector3::Zero();
  double longest = 0;
  for (const int corner : corners) {
    const Vector3 r = x.col(corner) - origin;
    area += before.cross(r) / 2;
    longest = std::max(longest, r.squaredNorm());
    before = r;
  }
  if (!(area.norm() > least_area * longest)) return {};
  const Vector3 across = area.unitOrthogonal(), up = area.normalized().cross(across);
  std::vector<Vector2> shadow;
  for (const int corner : corners) {
    const Vector3 r = x.col(corner) - origin;
    shadow.emplace_back(across.dot(r), up.dot(r));
  }
  return shadow;
}

/// Else a polygon without area crosses itself.
bool are_in_line(std::span<const int> corners, const PerParticle3& x) {
  double area = 0, longest = 0;
  for (const Triangle& t : fan_of(corners)) {
    const Vector3 a = x.col(t[1]) - x.col(t[0]), b = x.col(t[2]) - x.col(t[0]);
    area = std::max(area, a.cross(b).norm());
    longest = std::max({longest, a.squaredNorm(), b.squaredNorm()});
  }
  return !(area > least_area * longest);
}

double cross(const Vector2& a, const Vector2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Twice the area over the longest side squared; negative if clockwise.
double quality(const Vector2& a, const Vector2& b, const Vector2& c) {
  const double longest =
      std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return longest > 0 ? cross(b - a, c - a) / longest : 0;
}

/// Whether the first corner sees the whole polygon within a half-plane.
bool is_fan(const std::vector<Vector2>& p) {
  for (size_t k = 2; k < p.size(); ++k)
    if (!(quality(p[0], p[k - 1], p[k]) > least_area) || !(cross(p[1] - p[0], p[k] - p[0]) > 0))
      return false;
  return true;
}

/// A fan of so many triangles meets itself in boxes, as pairs do: of a convex polygon every second
/// corner is cut off instead, and again. Empty if one of these triangles has no area.
std::vector<Triangle> halving_cut(std::span<const int> corners, const std::vector<Vector2>& p) {
  std::vector<Triangle> triangles;
  for (size_t step = 1; step < p.size(); step *= 2)
    for (size_t a = 0; a + step < p.size(); a += 2 * step) {
      const size_t b = a + step, c = a + 2 * step < p.size() ? a + 2 * step : 0;
      if (c == 0 && a == 0) continue;  // the side between them closes the polygon
      if (!(quality(p[a], p[b], p[c]) > least_area)) return {};
      triangles.push_back({corners[a], corners[b], corners[c]});
    }
  return triangles;
}

bool crosses_itself(const std::vector<Vector2>& p) {
  const size_t n = p.size();
  const auto parts = [&](size_t i, size_t j) {  // side i has the ends of side j on both its sides
    const Vector2 side = p[(i + 1) % n] - p[i];
    return cross(side, p[j] - p[i]) * cross(side, p[(j + 1) % n] - p[i]) < 0;
  };
  for (size_t i = 0; i < n; ++i)
    for (size_t j = i + 2; j < n; ++j)
      if (parts(i, j) && parts(j, i)) return true;
  return false;
}

/// By dynamic programming over the parts of the polygon (Klincsek 1980). Triangles that all turn as
/// the polygon does, and whose sides not its own are shared by two, cover it exactly once.
std::vector<Triangle> best_cut(std::span<const int> corners, const std::vector<Vector2>& p) {
  const int n = int(p.size());
  // of corners first..last, cut along the side between these two: the worst triangle's quality, and
  // the third corner of the triangle on that side
  Eigen::MatrixXd worst = Eigen::MatrixXd::Constant(n, n, INFINITY);
  Eigen::MatrixXi third = Eigen::MatrixXi::Constant(n, n, -1);
  for (int width = 2; width < n; ++width)
    for (int first = 0, last = width; last < n; ++first, ++last) {
      worst(first, last) = -INFINITY;
      for (int k = first + 1; k < last; ++k) {
        const double other = std::min({worst(first, k), worst(k, last),
                                       quality(p[size_t(first)], p[size_t(k)], p[size_t(last)])});
        if (!(other > std::max(worst(first, last), least_area))) continue;
        worst(first, last) = other;
        third(first, last) = k;
      }
    }
  std::vector<Triangle> triangles;
  std::vector<std::pair<int, int>> parts{{0, n - 1}};
  while (!parts.empty()) {
    const auto [first, last] = parts.back();
    parts.pop_back();
    if (last - first < 2) continue;
    const int k = third(first, last);
    if (k < 0) return {};
    triangles.push_back({corners[size_t(first)], corners[size_t(k)], corners[size_t(last)]});
    parts.emplace_back(k, last);
    parts.emplace_back(first, k);
  }
  return triangles;
}

}  // namespace

std::vector<Triangle> triangles_of_polygon(std::span<const int> corners, const PerParticle3& x) {
  if (corners.size() == 3) return fan_of(corners);
  const std::vector<int> kept = without_repeats(corners);
  if (kept.size() < 3) return fan_of(corners);
  const std::vector<Vector2> shadow = shadow_of(kept, x);
  if (shadow.empty()) return are_in_line(kept, x) ? fan_of(corners) : std::vector<Triangle>();
  if (is_fan(shadow)) {
    const bool is_large = int(kept.size()) > most_concave_corners;
    std::vector<Triangle> cut = is_large ? halving_cut(kept, shadow) : std::vector<Triangle>();
    return cut.empty() ? fan_of(kept) : cut;
  }
  if (int(kept.size()) > most_concave_corners || crosses_itself(shadow)) return {};
  return best_cut(kept, shadow);
}

}  // namespace foldproof
