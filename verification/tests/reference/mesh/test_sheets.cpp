// Sheets of each pattern, and the triangulation of their random points.
#include <Eigen/Geometry>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "reference/mesh/delaunay.h"
#include "reference/mesh/shapes.h"

using namespace foldproof;

TEST_CASE("sheets of two columns and rows have the triangles drawn by hand") {
  const std::vector<Triangle> rising{{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4},
                                     {3, 4, 7}, {3, 7, 6}, {4, 5, 8}, {4, 8, 7}};
  const std::vector<Triangle> in_turn{{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4},
                                      {3, 4, 6}, {4, 7, 6}, {4, 5, 7}, {5, 8, 7}};
  const std::vector<Triangle> chequered{{0, 1, 4}, {0, 4, 3}, {1, 2, 4}, {2, 5, 4},
                                        {3, 4, 6}, {4, 7, 6}, {4, 5, 8}, {4, 8, 7}};
  // 10   11   12
  //    8    9
  // 5    6    7
  //    3    4
  // 0    1    2
  const std::vector<Triangle> crossed{{0, 1, 3}, {1, 6, 3},  {6, 5, 3},   {5, 0, 3},
                                      {1, 2, 4}, {2, 7, 4},  {7, 6, 4},   {6, 1, 4},
                                      {5, 6, 8}, {6, 11, 8}, {11, 10, 8}, {10, 5, 8},
                                      {6, 7, 9}, {7, 12, 9}, {12, 11, 9}, {11, 6, 9}};
  const std::vector<Triangle> offset{{0, 4, 3}, {0, 1, 4}, {1, 5, 4}, {1, 2, 5}, {2, 6, 5},
                                     {3, 4, 7}, {4, 8, 7}, {4, 5, 8}, {5, 9, 8}, {5, 6, 9}};
  const std::array all{rising, in_turn, chequered, crossed, offset};
  for (int pattern = 0; pattern < 5; ++pattern) {
    const TriangleMesh sheet = make_sheet({SheetPattern(pattern), 1.3, 0.9, 2, 2});
    CHECK(sheet.triangles == all[size_t(pattern)]);
    CHECK(sheet.rest.rowwise().minCoeff() == Vector3(0, 0, 0));
    CHECK(sheet.rest.rowwise().maxCoeff() == Vector3(1.3, 0.9, 0));
  }
}

TEST_CASE("vertices of squares lie on a grid, graded or not, and centres half way along it") {
  // cells of 1 and 4 parts, of 1, 2 and 4
  const PerParticle3 graded = make_sheet({SheetPattern::criss_cross, 5, 7, 2, 3, 0, 0, 4}).rest;
  PerParticle3 x = PerParticle3::Zero(3, 18);
  const double third = 1.0 / 3, root = std::sqrt(2);
  x.row(0) << 0, 1, 5, third, 7 * third, 0, 1, 5, third, 7 * third, 0, 1, 5, third, 7 * third, 0, 1,
      5;
  x.row(1) << 0, 0, 0, root - 1, root - 1, 1, 1, 1, 2 * root - 1, 2 * root - 1, 3, 3, 3,
      4 * root - 1, 4 * root - 1, 7, 7, 7;
  CHECK((graded - x).cwiseAbs().maxCoeff() < 1e-14);
  const PerParticle3 even = make_sheet({SheetPattern::union_jack, 2, 3, 2, 3}).rest;
  for (int v = 0; v < 12; ++v) CHECK((even.col(v) - Vector3(v % 3, v / 3, 0)).norm() < 1e-14);
}

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
