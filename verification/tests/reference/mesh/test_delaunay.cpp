// Delaunay triangulations: order, what is left out and what is refused.
#include <Eigen/Geometry>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "reference/mesh/delaunay.h"

using namespace foldproof;

namespace {

using Points = std::vector<std::array<double, 2>>;

Eigen::Matrix2Xd matrix_of(const Points& points) {
  Eigen::Matrix2Xd matrix(2, Eigen::Index(points.size()));
  for (size_t i = 0; i < points.size(); ++i)
    matrix.col(Eigen::Index(i)) << points[i][0], points[i][1];
  return matrix;
}

/// Whether three points on the grid, of whole numbers, are triangulated when they are turned by
/// quarters and mirrored.
bool is_kept(Points points, int way) {
  for (auto& [x, y] : points) {
    if (way & 1) x = -x;
    if (way & 2) y = -y;
    if (way & 4) std::swap(x, y);
    x += 3, y -= 7;
  }
  try {
    return delaunay(matrix_of(points)).size() == 1;
  } catch (const InputError&) {
    return false;
  }
}

const double unit = std::ldexp(1, 30);

}  // namespace

TEST_CASE("five points have the Delaunay triangles found by hand, each from its smallest index") {
  // a square about a point, turned a little, listed out of order; the point is the last but one
  const Points points{{2.0, 2.2}, {-1.9, 2.0}, {-2.1, -2.0}, {0.1, 0.3}, {2.1, -1.9}};
  CHECK(delaunay(matrix_of(points)) ==
        std::vector<Triangle>{{0, 1, 3}, {0, 3, 4}, {1, 2, 3}, {2, 4, 3}});
  const Points far = {{1e6 + 2, 5e3}, {1e6 - 1, 5e3 + 0.25}, {1e6 + 0.5, 5e3 + 4}};
  CHECK(delaunay(matrix_of(far)) == std::vector<Triangle>{{0, 2, 1}});
}

TEST_CASE("points on common circles are triangulated, and points on a line but for rounding") {
  Eigen::Matrix2Xd grid(2, 7 * 9);
  for (int i = 0; i < 63; ++i) grid.col(i) << (i % 7) * 0.3, (i / 7) * 0.3;
  for (const double angle : {0.0, 0.37})
    CHECK(delaunay(Eigen::Rotation2Dd(angle).toRotationMatrix() * grid).size() == 2 * 6 * 8);
}

TEST_CASE("triangles at most two units of the grid high are left out, whichever side is longest") {
  for (int way = 0; way < 8; ++way)
    for (const double fraction : {0.25, 0.375, 0.75}) {
      // the height over a side along an axis is a whole number
      const double x = fraction * unit;
      CHECK(is_kept({{0, 0}, {x, 3}, {unit, 0}}, way));
      CHECK_FALSE(is_kept({{0, 0}, {x, 2}, {unit, 0}}, way));
      // over a side of slope 1/2, twice the area is 2^30 times y - x/2, the side 1.118 * 2^30
      CHECK(is_kept({{0, 0}, {x - 1, x / 2 + 2}, {unit, unit / 2}}, way));    // 2.24
      CHECK_FALSE(is_kept({{0, 0}, {x, x / 2 + 2}, {unit, unit / 2}}, way));  // 1.79
    }
  CHECK(delaunay(matrix_of({{0, 0}, {unit / 4, 2}, {unit, 0}, {unit / 2, unit / 8}})) ==
        std::vector<Triangle>{{0, 1, 3}, {1, 2, 3}});
}

TEST_CASE("too few points, points of one place on the grid or on a line are refused") {
  const double infinity = std::numeric_limits<double>::infinity();
  // the extent is 2^30 units
  const auto with = [](double x, double y) {
    return Points{{0, 0}, {unit, 0.25 * unit}, {0.5 * unit, unit}, {x, y}};
  };
  for (const auto& [points, said] : std::vector<std::pair<Points, std::string>>{
           {{}, "delaunay: 0 points;"},
           {{{0.1, 0.2}, {0.7, 0.3}}, "delaunay: 2 points;"},
           {with(0.7, -infinity), "delaunay: point 3: a coordinate is not finite"},
           {{{0.2, 0.3}, {0.2, 0.3}, {0.2, 0.3}}, "delaunay: the points' extent is 0.0"},
           {{{-1.5e308, 0}, {1.5e308, 0.3}, {0.2, 0.7}}, "delaunay: the points' extent is inf"},
           {{{0.1, 0.3}, {0.5, 0.3}, {1.7, 0.3}}, "delaunay: all points lie on a line"},
           {with(0.375, 0.375), "delaunay: points 0 and 3 coincide"},
           {with(unit - 0.375, 0.25 * unit + 0.375), "delaunay: points 1 and 3 coincide"},
           {{{0.3, 0.7}, {1.9, 0.2}, {0.8, 0.8}, {1.9, 0.2}, {0.3, 0.7}, {1.9, 0.2}},
            "delaunay: points 0 and 4 coincide"}})
    CHECK_THROWS_WITH(delaunay(matrix_of(points)), Catch::StartsWith(said));
  CHECK_NOTHROW(delaunay(matrix_of(with(3, 3))));
}
