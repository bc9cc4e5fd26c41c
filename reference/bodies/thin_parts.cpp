#include "reference/bodies/thin_parts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "reference/mesh/mesh_locations.h"

namespace foldproof {

namespace {

constexpr double step = 0.25, deepest = 1.5, thick = 0.75;  // of the search inward [cells]
constexpr double parallel = 0.966;                          // cosine of 15 degrees
constexpr int near = 3;                                     // cells
constexpr double pierced = 0.1;                             // of the surface of thin parts
constexpr size_t most_spared = 4, most_compared = 64;       // points

struct SurfacePoint {
  Vector3 position, normal;
};

enum class Behind { thick, thin, nothing };

Behind behind(const Grid& grid, const SurfacePoint& at) {
  const double cell = grid.lattice.spacing;
  const auto phi = [&](double depth) {
    return grid.in_cell(at.position - depth * cell * at.normal).phi / cell;
  };
  if (phi(thick) < -0.9 * thick) return Behind::thick;
  for (double depth = step; depth <= deepest; depth += step)
    if (phi(depth) < 0) return Behind::thin;
  return Behind::nothing;
}

bool has_inside_near(const Grid& grid, const Vector3& p) {
  const Vector3 at = (p - grid.lattice.origin) / grid.lattice.spacing;
  for (int k = -near; k <= near; ++k)
    for (int j = -near; j <= near; ++j)
      for (int i = -near; i <= near; ++i) {
        const Node node = {int(at.x()) + i, int(at.y()) + j, int(at.z()) + k};
        if (grid.phi[size_t(grid.lattice.index(node))] < 0) return true;
      }
  return false;
}

/// The wall behind a point: its depth [m], 0 without one in reach [m], and its normal.
std::pair<double, Vector3> wall_behind(const PerParticle3& x,
                                       const std::vector<Triangle>& triangles,
                                       const SurfacePoint& from, double reach) {
  std::pair<double, Vector3> nearest{0, Vector3::Zero()};
  for (const Triangle& t : triangles) {
    const Vector3 a = x.col(t[0]), b = x.col(t[1]) - a, c = x.col(t[2]) - a, n = b.cross(c);
    const double sinking = -n.dot(from.normal);
    if (!(sinking > 0)) continue;
    const double depth = n.dot(a - from.position) / sinking;
    const double most = nearest.first > 0 ? nearest.first : reach;
    if (!(depth > 0 && depth <= most)) continue;
    const Vector3 hit = from.position - depth * from.normal - a;
    const double u = hit.cross(c).dot(n), v = b.cross(hit).dot(n);
    if (u >= 0 && v >= 0 && u + v <= n.squaredNorm()) nearest = {depth, n.normalized()};
  }
  return nearest;
}

/// Calls act at points spread evenly over the surface, one for each `area` [m^2].
template <class Act>
long for_each_point(const PerParticle3& x, const std::vector<Triangle>& triangles, double area,
                    const Act& act) {
  long count = 0;
  double sum = 0.5 * area;
  for (const Triangle& t : triangles) {
    const Vector3 a = x.col(t[0]), b = x.col(t[1]) - a, c = x.col(t[2]) - a, n = b.cross(c);
    for (sum += n.norm() / 2; sum >= area; sum -= area, ++count) {
      // the first n terms cover the square evenly, for every n
      double u = std::fmod(0.7548776662466927 * double(count) + 0.5, 1);
      double v = std::fmod(0.5698402909980532 * double(count) + 0.5, 1);
      if (u + v > 1) std::tie(u, v) = std::pair(1 - u, 1 - v);
      act(SurfacePoint{a + u * b + v * c, n.normalized()});
    }
  }
  return count;
}

std::string digits(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

}  // namespace

std::optional<ThinParts> find_thin_parts(const PerParticle3& x,
                                         const std::vector<Triangle>& triangles, const Grid& grid) {
  const double cell = grid.lattice.spacing;
  double thin = 0;
  std::vector<SurfacePoint> suspects;
  const long points = for_each_point(x, triangles, cell * cell / 2, [&](const SurfacePoint& point) {
    const Behind found = behind(grid, point);
    if (found != Behind::thick) ++thin;
    if (found == Behind::nothing) suspects.push_back(point);
  });
  if (suspects.size() <= most_spared) return std::nullopt;
  const size_t stride = (suspects.size() + most_compared - 1) / most_compared;
  std::vector<std::pair<double, Vector3>> lost, holes;  // thickness and place
  for (size_t k = 0; k < suspects.size(); k += stride) {
    const auto [depth, normal] = wall_behind(x, triangles, suspects[k], 2 * cell);
    if (!has_inside_near(grid, suspects[k].position))
      lost.emplace_back(depth, suspects[k].position);
    else if (depth > 0 && normal.dot(suspects[k].normal) < -parallel)
      holes.emplace_back(depth, suspects[k].position);
  }
  if (double(stride * (lost.size() + holes.size())) > pierced * thin)
    lost.insert(lost.end(), holes.begin(), holes.end());
  if (stride * lost.size() <= most_spared) return std::nullopt;
  const auto middle = lost.begin() + long(lost.size() / 2);
  std::ranges::nth_element(lost, middle, {}, &std::pair<double, Vector3>::first);
  return ThinParts{double(stride * lost.size()) / double(points), middle->second, middle->first};
}

std::string describe(const ThinParts& parts, const Grid& grid, double longest, Repair repair) {
  const std::string text = "behind " + digits(std::min(100.0, 100 * parts.lost)) +
                           " % of its surface, such as at " + position_name(parts.place) +
                           ", the grid of " + digits(grid.lattice.spacing) +
                           " m has no inside: cloth falls through. ";
  if (!(parts.thickness > 0))
    return text + "No triangle faces the other way there: close the mesh, or remove that part";
  const double cells = std::ceil(2 * longest / parts.thickness);
  return text + "It is about " + digits(parts.thickness) + " m thick there; set field = " +
         (repair == Repair::refuse ? "\"exact\" or \"octree\"" : "\"octree\"") +
         // a cube of 500 cells takes a gigabyte
         (cells <= 500 ? ", or cells = " + digits(cells) : "");
}

}  // namespace foldproof
