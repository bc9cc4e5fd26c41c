// The exact decisions against separating directions, cubes and dense sampling. Small whole numbers
// as coordinates, so that planes, edges and corners coincide often.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <limits>
#include <random>

#include "verification/oracles/exact_geometry.h"
#include "verification/oracles/separated_triangles.h"

using namespace foldproof;
using namespace foldproof::oracles;

namespace {

Corners3 small_triangle(std::mt19937& bits) {
  std::uniform_int_distribution<int> coordinate(-2, 2);
  Corners3 t;
  do
    for (Vector3& corner : t)
      corner = Vector3(coordinate(bits), coordinate(bits), coordinate(bits));
  while (normal_of(t).isZero(0));
  return t;
}

TriangleSoup cube(double side) { return box_between(Vector3::Zero(), Vector3::Constant(side)); }

}  // namespace

TEST_CASE("triangles meet just where no direction parts them") {
  std::mt19937 bits(19);
  int meetings = 0;
  for (int k = 0; k < 20000; ++k) {
    const Corners3 s = small_triangle(bits), t = small_triangle(bits);
    const bool meet = triangles_meet(s, t);
    meetings += meet;
    REQUIRE(meet == !are_separated(s, t));
    REQUIRE(meet == triangles_meet(t, s));
  }
  CHECK(meetings > 5000);
}

TEST_CASE("a last bit decides on which side of a plane a point is") {
  const Vector3 a(0.1, 0.2, 0.3), b(1.1, 0.2, 0.3), c(0.1, 1.2, 0.3);
  const double above = std::nextafter(0.3, 1);
  CHECK(orientation(a, b, c, {0.7, 0.4, above}) == 1);
  CHECK(orientation(a, b, c, {0.7, 0.4, 0.3}) == 0);
  CHECK(orientation(a, c, b, {0.7, 0.4, above}) == -1);
  const Vector3 far(0, 0, std::numeric_limits<double>::denorm_min());
  // the product underflows in double
  CHECK(orientation({0, 0, 0}, {1e-200, 0, 0}, {0, 1e-200, 0}, far) == 1);
}

TEST_CASE("points are inside a cube, on it or outside") {
  const double side = 0.3;
  const TriangleSoup surface = cube(side);
  std::mt19937 bits(23);
  std::uniform_int_distribution<int> coordinate(-1, 3);
  for (int k = 0; k < 2000; ++k) {
    const Vector3 p = side / 2 * Vector3(coordinate(bits), coordinate(bits), coordinate(bits));
    const bool outside = (p.array() < 0).any() || (p.array() > side).any();
    const bool inside = (p.array() > 0).all() && (p.array() < side).all();
    const Side expected = outside ? Side::outside : inside ? Side::inside : Side::on_surface;
    REQUIRE(side_of(surface, p) == expected);
  }
}

TEST_CASE("a triangle is clear of a ball just where its nearest point is") {
  const Corners3 face = {Vector3(-1, -1, 0.5), Vector3(2, -1, 0.5), Vector3(-1, 2, 0.5)};
  CHECK(clears_ball(face, Vector3::Zero(), std::nextafter(0.5, 0)));
  CHECK_FALSE(clears_ball(face, Vector3::Zero(), 0.5));
  const Corners3 edge = {Vector3(-1, 0.25, 0), Vector3(1, 0.25, 0), Vector3(0.3, 2, 1)};
  CHECK(clears_ball(edge, Vector3::Zero(), std::nextafter(0.25, 0)));
  CHECK_FALSE(clears_ball(edge, Vector3::Zero(), 0.25));
  const Corners3 corner = {Vector3(3, 4, 0), Vector3(5, 4, 0), Vector3(3, 9, 1)};
  CHECK(clears_ball(corner, Vector3::Zero(), std::nextafter(5, 0)));
  CHECK_FALSE(clears_ball(corner, Vector3::Zero(), 5));
}

TEST_CASE("triangles within a body are found, though they meet no triangle of it") {
  TriangleSoup cloth{PerParticle3(3, 9), {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}}};
  cloth.x.leftCols(3) << 0.1, 0.2, 0.1, 0.1, 0.1, 0.2, 0.15, 0.15, 0.15;       // inside
  cloth.x.middleCols(3, 3) << 0.1, 0.2, 0.1, 0.1, 0.1, 0.2, 0.35, 0.36, 0.37;  // outside
  cloth.x.rightCols(3) << 0.1, 0.2, 0.1, 0.1, 0.1, 0.2, 0.25, 0.3, 0.36;       // through the top
  CHECK(triangles_in_body(cloth, cube(0.3)) == std::vector<int>{0, 2});
}
