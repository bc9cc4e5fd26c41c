#include "reference/bodies/thin_parts.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "reference/mesh/box_tree.h"
#include "reference/mesh/mesh_locations.h"

namespace foldproof {

namespace {

constexpr double step = 0.25, deepest = 1.5, thick = 0.75;  // of the search inward [cells]
constexpr double parallel = 0.966;                          // cosine of 15 degrees
constexpr int near = 3;                                     // cells
constexpr double pierced = 0.1;                             // of the surface of thin parts
constexpr size_t most_spared = 4;                           // points

struct SurfacePoint {
  Vector3 position, normal;
  int triangle;
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
  const Lattice& lattice = grid.lattice;
  const Vector3 at = (p - lattice.origin) / lattice.spacing;
  Node low, high;
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = std::max(0, int(std::ceil(at[axis] - near)));
    high[axis] = std::min(lattice.nodes[axis] - 1, int(std::floor(at[axis] + near)));
  }
  for (int k = low[2]; k <= high[2]; ++k)
    for (int j = low[1]; j <= high[1]; ++j)
      for (int i = low[0]; i <= high[0]; ++i)
        if (grid.phi[size_t(lattice.index({i, j, k}))] < 0) return true;
  return false;
}

/// Triangles in a tree, for the wall behind a point.
class Walls {
 public:
  Walls(const PerParticle3& x, const std::vector<Triangle>& triangles)
      : x_(x), triangles_(triangles), tree_(make_box_tree(triangle_bounds(x, triangles), 4)) {}

  struct Wall {
    double depth = std::numeric_limits<double>::infinity();  // m
    Vector3 normal = Vector3::Zero();
  };

  /// The nearest wall behind the point that faces away from it, at most `reach` [m] deep.
  Wall behind(const SurfacePoint& from, double reach) const {
    Wall nearest;
    Bounds way(from.position);
    way.extend(Vector3(from.position - reach * from.normal));
    std::vector<int> waiting{0};
    while (!waiting.empty()) {
      const int at = waiting.back();
      waiting.pop_back();
      const BoxNode& node = tree_.nodes[size_t(at)];
      if (!node.bounds.intersects(way)) continue;
      if (node.right >= 0) {
        waiting.push_back(node.right);
        waiting.push_back(at + 1);
        continue;
      }
      for (int i = node.first; i < node.first + node.count; ++i)
        meet(tree_.order[size_t(i)], from, reach, nearest);
    }
    return nearest;
  }

 private:
  void meet(int t, const SurfacePoint& from, double reach, Wall& nearest) const {
    const Triangle& corners = triangles_[size_t(t)];
    const Vector3 a = x_.col(corners[0]), b = x_.col(corners[1]) - a, c = x_.col(corners[2]) - a;
    const Vector3 n = b.cross(c), along = -from.normal, to = from.position - a;
    const double determinant = n.dot(along);
    if (t == from.triangle || !(determinant > 0)) return;
    const double depth = -n.dot(to) / determinant;
    if (!(depth >= 0 && depth <= std::min(reach, nearest.depth))) return;
    const Vector3 hit = to + depth * along;
    const double v = b.cross(hit).dot(n), u = hit.cross(c).dot(n), whole = n.squaredNorm();
    if (u >= 0 && v >= 0 && u + v <= whole) nearest = {depth, n.normalized()};
  }

  const PerParticle3& x_;
  const std::vector<Triangle>& triangles_;
  BoxTree tree_;
};

/// Calls act(point) at points spread evenly over the area, one for each `area` [m^2].
template <class Act>
long for_each_point(const PerParticle3& x, const std::vector<Triangle>& triangles, double area,
                    const Act& act) {
  long count = 0;
  double sum = 0.5 * area;
  for (int t = 0; t < int(triangles.size()); ++t) {
    const Triangle& corners = triangles[size_t(t)];
    const Vector3 a = x.col(corners[0]), b = x.col(corners[1]) - a, c = x.col(corners[2]) - a;
    const Vector3 n = b.cross(c);
    for (sum += n.norm() / 2; sum >= area; sum -= area, ++count) {
      // a sequence that fills the square evenly, whatever its length
      double u = std::fmod(0.7548776662466927 * double(count) + 0.5, 1);
      double v = std::fmod(0.5698402909980532 * double(count) + 0.5, 1);
      if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
      }
      act(SurfacePoint{a + u * b + v * c, n.normalized(), t});
    }
  }
  return count;
}

}  // namespace

std::optional<ThinParts> find_thin_parts(const PerParticle3& x,
                                         const std::vector<Triangle>& triangles, const Grid& grid) {
  const double cell = grid.lattice.spacing;
  long thin = 0;
  std::vector<SurfacePoint> suspects;
  const long points = for_each_point(x, triangles, cell * cell / 2, [&](const SurfacePoint& point) {
    const Behind found = behind(grid, point);
    if (found != Behind::thick) ++thin;
    if (found == Behind::nothing) suspects.push_back(point);
  });
  if (suspects.size() <= most_spared) return std::nullopt;
  const Walls walls(x, triangles);
  std::vector<std::pair<double, Vector3>> lost, holes;  // thickness and place
  for (const SurfacePoint& point : suspects) {
    const auto wall = walls.behind(point, 2 * cell);
    const bool has_wall = std::isfinite(wall.depth);
    if (!has_inside_near(grid, point.position))
      lost.emplace_back(has_wall ? wall.depth : 0, point.position);
    else if (has_wall && wall.normal.dot(point.normal) < -parallel)
      holes.emplace_back(wall.depth, point.position);
  }
  if (double(lost.size() + holes.size()) > pierced * double(thin))
    lost.insert(lost.end(), holes.begin(), holes.end());
  if (lost.size() <= most_spared) return std::nullopt;
  std::ranges::nth_element(lost, lost.begin() + long(lost.size() / 2), {},
                           &std::pair<double, Vector3>::first);
  const auto& [thickness, place] = lost[lost.size() / 2];
  return ThinParts{double(lost.size()) / double(points), place, thickness};
}

std::string describe(const ThinParts& parts, const Grid& grid, double longest, Repair repair) {
  const auto digits = [](double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.3g", value);
    return std::string(text);
  };
  std::string text = "behind " + digits(100 * parts.lost) + " % of its surface, such as at " +
                     position_name(parts.place) + ", the grid of " + digits(grid.lattice.spacing) +
                     " m has no inside: cloth falls through. ";
  if (!(parts.thickness > 0))
    return text + "No triangle faces the other way there: close the mesh, or remove that part";
  const double cells = std::ceil(2 * longest / parts.thickness);
  text += "It is about " + digits(parts.thickness) + " m thick there; set field = ";
  text += repair == Repair::refuse ? "\"exact\" or \"octree\"" : "\"octree\"";
  // a cube of 500 cells takes a gigabyte
  return cells <= 500 ? text + ", or cells = " + std::to_string(int(cells)) : text;
}

}  // namespace foldproof
