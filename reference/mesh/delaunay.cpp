#include "reference/mesh/delaunay.h"

#include <algorithm>
#include <boost/polygon/voronoi.hpp>
#include <cmath>
#include <cstdint>
#include <string>

namespace foldproof {
namespace {

using GridPoint = boost::polygon::point_data<std::int32_t>;  // each coordinate in [0, 2^30]
using VoronoiDiagram = boost::polygon::voronoi_diagram<double>;

void reject_bad_points(const Eigen::Matrix2Xd& points) {
  if (points.cols() < 3) {
    throw InputError("delaunay: " + std::to_string(points.cols()) + " points; give at least three");
  }
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if (points.col(i).allFinite()) continue;
    throw InputError("delaunay: point " + std::to_string(i) +
                     ": a coordinate is not finite; give numbers in m");
  }
}

std::vector<GridPoint> round_to_grid(const Eigen::Matrix2Xd& points) {
  const Eigen::Vector2d lower = points.rowwise().minCoeff();
  const double extent = (points.rowwise().maxCoeff() - lower).maxCoeff();
  if (!(extent > 0) || !std::isfinite(extent)) {
    throw InputError("delaunay: the points' extent is " + std::to_string(extent) +
                     " m; give distinct points");
  }
  std::vector<GridPoint> grid;
  grid.reserve(points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector2d scaled = (points.col(i) - lower) / extent * double(1 << 30);
    grid.emplace_back(std::int32_t(std::lround(scaled.x())), std::int32_t(std::lround(scaled.y())));
  }
  return grid;
}

void reject_coincident(const std::vector<GridPoint>& grid) {
  std::vector<int> order(grid.size());
  for (size_t i = 0; i < grid.size(); ++i) order[i] = int(i);
  std::sort(order.begin(), order.end(),
            [&grid](int i, int j) { return grid[i] == grid[j] ? i < j : grid[i] < grid[j]; });
  for (size_t k = 1; k < order.size(); ++k) {
    if (grid[order[k - 1]] != grid[order[k]]) continue;
    throw InputError("delaunay: points " + std::to_string(order[k - 1]) + " and " +
                     std::to_string(order[k]) + " coincide to 1e-9 of the extent; remove one");
  }
}

/// Higher than two units of the grid: rounding (0.71 units per point) cannot have flipped such a
/// triangle.
bool is_high(const std::vector<GridPoint>& grid, const Triangle& triangle) {
  const auto side = [&grid](int from, int to) {
    return std::array<std::int64_t, 2>{std::int64_t(grid[to].x()) - grid[from].x(),
                                       std::int64_t(grid[to].y()) - grid[from].y()};
  };
  const std::array<std::int64_t, 2> s = side(triangle[0], triangle[1]),
                                    t = side(triangle[0], triangle[2]);
  const std::array<std::int64_t, 2> u = side(triangle[1], triangle[2]);
  const double twice_area = double(s[0] * t[1] - s[1] * t[0]);  // below 2^62: exact in 64 bits
  const double longest =
      std::max({std::hypot(s[0], s[1]), std::hypot(t[0], t[1]), std::hypot(u[0], u[1])});
  return twice_area > 2 * longest;
}

Triangle from_smallest(Triangle triangle) {
  std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
  return triangle;
}

/// The points nearest to a vertex of the Voronoi diagram lie on a circle about it: three of them,
/// or more in special position.
std::vector<int> points_around(const VoronoiDiagram::vertex_type& vertex) {
  std::vector<int> around;
  const VoronoiDiagram::edge_type* edge = vertex.incident_edge();
  do {
    around.push_back(int(edge->cell()->source_index()));
    edge = edge->rot_next();
  } while (edge != vertex.incident_edge());
  return around;
}

}  // namespace

std::vector<Triangle> delaunay(const Eigen::Matrix2Xd& points) {
  reject_bad_points(points);
  const std::vector<GridPoint> grid = round_to_grid(points);
  reject_coincident(grid);
  VoronoiDiagram diagram;
  boost::polygon::construct_voronoi(grid.begin(), grid.end(), &diagram);

  std::vector<Triangle> triangles;
  for (const VoronoiDiagram::vertex_type& vertex : diagram.vertices()) {
    const std::vector<int> around = points_around(vertex);
    for (size_t k = 2; k < around.size(); ++k) {
      const Triangle triangle{around[0], around[k - 1], around[k]};
      if (is_high(grid, triangle)) triangles.push_back(from_smallest(triangle));
    }
  }
  if (triangles.empty())
    throw InputError("delaunay: all points lie on a line; give some beside it");
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

}  // namespace foldproof
