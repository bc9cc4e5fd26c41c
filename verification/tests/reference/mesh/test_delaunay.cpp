// Delaunay triangulations: what is left out, what is refused, and the order.
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

std::string refusal_of(const Points& points) {
  try {
    delaunay(matrix_of(points));
  } catch (const InputError& error) {
    return error.what();
  }
  return "not refused";
}

/// Whether three points on the grid, of whole numbers, are triangulated.
bool is_kept(const Points& points) {
  const std::string said = refusal_of(points);
  if (said == "not refused") {
    CHECK(delaunay(matrix_of(points)).size() == 1);
    return true;
  }
  CHECK(said == "delaunay: all points lie on a line; give some beside it");
  return false;
}

/// The same points, turned by quarters and mirrored.
Points turned(Points points, int way) {
  for (auto& [x, y] : points) {
    if (way & 1) x = -x;
    if (way & 2) y = -y;
    if (way & 4) std::swap(x, y);
    x += 3, y -= 7;
  }
  return points;
}

}  // namespace

TEST_CASE("five points have the Delaunay triangles found by hand, each from its smallest index") {
  // a square about a point, turned a little, listed out of order; the point is the last but one
  const Points points{{2.0, 2.2}, {-1.9, 2.0}, {-2.1, -2.0}, {0.1, 0.3}, {2.1, -1.9}};
  CHECK(delaunay(matrix_of(points)) ==
        std::vector<Triangle>{{0, 1, 3}, {0, 3, 4}, {1, 2, 3}, {2, 4, 3}});
  const Points far = {{1e6 + 2, 5e3}, {1e6 - 1, 5e3 + 0.25}, {1e6 + 0.5, 5e3 + 4}};
  CHECK(delaunay(matrix_of(far)) == std::vector<Triangle>{{0, 2, 1}});
}

TEST_CASE("triangles at most two units of the grid high are left out, whichever side is longest") {
  const double unit = std::ldexp(1, 30);
  for (int way = 0; way < 8; ++way) {
    INFO(way);
    for (const double share : {0.25, 0.375, 0.75}) {
      // the height over a side along an axis is a whole number
      CHECK(is_kept(turned({{0, 0}, {share * unit, 3}, {unit, 0}}, way)));
      CHECK_FALSE(is_kept(turned({{0, 0}, {share * unit, 2}, {unit, 0}}, way)));
      // over a side of slope 1/2, twice the area is 2^30 times y - x/2, the side 1.118 * 2^30
      const double x = share * unit;
      CHECK(is_kept(turned({{0, 0}, {x - 1, x / 2 + 2}, {unit, unit / 2}}, way)));    // 2.24
      CHECK_FALSE(is_kept(turned({{0, 0}, {x, x / 2 + 2}, {unit, unit / 2}}, way)));  // 1.79
    }
  }
}

TEST_CASE("a triangle of the border that is too flat is left out of a larger triangulation") {
  const double unit = std::ldexp(1, 30);
  const Points points{{0, 0}, {unit / 4, -2}, {unit, 0}, {unit / 2, unit / 8}};
  for (const double below : {2.0, 3.0}) {
    Points bent = points;
    bent[1][1] = -below;
    // the flat point is joined to the three others, or hangs over the long side
    CHECK(delaunay(matrix_of(bent)).size() == 2);
  }
  Points bent = points;
  bent[1][1] = 2;  // inside
  CHECK(delaunay(matrix_of(bent)) == std::vector<Triangle>{{0, 1, 3}, {1, 2, 3}});
  bent[1][1] = 3;
  CHECK(delaunay(matrix_of(bent)) == std::vector<Triangle>{{0, 1, 3}, {0, 2, 1}, {1, 2, 3}});
}

TEST_CASE("points of one place on the grid coincide, wherever they are in the list") {
  // the extent is 2^30 units
  const double unit = std::ldexp(1, 30);
  const Points corners{{0, 0}, {unit, 0.25 * unit}, {0.5 * unit, unit}};
  for (size_t of = 0; of < 3; ++of) {
    Points points = corners;
    points.push_back({corners[of][0] + 0.375, corners[of][1] - 0.375});
    if (of == 0) points.back() = {0.375, 0.375};
    if (of == 1) points.back() = {unit - 0.375, 0.25 * unit + 0.375};
    CHECK(refusal_of(points) == "delaunay: points " + std::to_string(of) +
                                    " and 3 coincide to 1e-9 of the extent; remove one");
    for (double& coordinate : points.back()) coordinate += coordinate > 0.9 * unit ? -3 : 3;
    CHECK(refusal_of(points) == "not refused");
  }
  CHECK(refusal_of({{0.3, 0.7}, {1.9, 0.2}, {0.8, 0.8}, {1.9, 0.2}, {0.3, 0.7}, {1.9, 0.2}}) ==
        "delaunay: points 0 and 4 coincide to 1e-9 of the extent; remove one");
  CHECK(refusal_of({{2.3, 0.7}, {1.9, 0.2}, {0.8, 0.8}, {2.3, 0.7}, {2.3, 0.7}}) ==
        "delaunay: points 0 and 3 coincide to 1e-9 of the extent; remove one");
}

TEST_CASE("points that span nothing, too much or no number are refused") {
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK(refusal_of({}) == "delaunay: 0 points; give at least three");
  CHECK(refusal_of({{0.1, 0.2}, {0.7, 0.3}}) == "delaunay: 2 points; give at least three");
  CHECK(refusal_of({{0.1, 0.2}, {0.7, 0.3}, {0.4, 0.9}}) == "not refused");
  CHECK(refusal_of({{0.1, 0.2}, {0.7, 0.3}, {0.4, infinity}}) ==
        "delaunay: point 2: a coordinate is not finite; give numbers in m");
  CHECK(refusal_of({{std::nan(""), 0.2}, {0.7, 0.3}, {0.4, 0.1}}) ==
        "delaunay: point 0: a coordinate is not finite; give numbers in m");
  CHECK(refusal_of({{0.2, 0.3}, {0.2, 0.3}, {0.2, 0.3}}) ==
        "delaunay: the points' extent is 0.000000 m; give distinct points");
  CHECK(refusal_of({{-1.5e308, 0}, {1.5e308, 0.3}, {0.2, 0.7}}) ==
        "delaunay: the points' extent is inf m; give distinct points");
}
