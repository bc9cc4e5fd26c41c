// Signs of determinants against whole numbers of any length, where rounding decides otherwise.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>

#include "reference/mesh/exact_sign.h"
#include "verification/oracles/exact_geometry.h"

using namespace foldproof;
using oracles::orientation;

namespace {

struct Four {
  Vector3 a, b, c, d;
};

/// Points of a plane but for the rounding of their coordinates. In half of the cases the side from
/// a to d, or one of the others, runs along an axis or a plane of two.
Four nearly_flat(std::mt19937_64& random, double size) {
  std::uniform_real_distribution<double> inside(-1, 1);
  const auto vector = [&] { return Vector3(inside(random), inside(random), inside(random)); };
  const auto along_axes = [&] {
    Vector3 v = vector();
    for (int axis = 0; axis < 3; ++axis)
      if (random() % 3 == 0) v[axis] = 0;
    return v;
  };
  const bool in_general = random() % 2 == 0;
  const Vector3 a = size * 3 * vector(), u = size * (in_general ? vector() : along_axes());
  const Vector3 v = size * (in_general ? vector() : along_axes());
  const double s = inside(random), t = inside(random);
  switch (random() % 3) {
    case 0:
      return {a, a + u, a + v, a + (s * u + t * v)};
    case 1:
      return {a, a + u, a + (s * u + t * v), a + v};
    default:
      return {a, a + (s * u + t * v), a + u, a + v};
  }
}

int side_by_wholes(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const auto lifted = [](const Eigen::Vector2d& p) { return Vector3(p.x(), p.y(), 0); };
  return orientation(lifted(a), lifted(b), lifted(c), Vector3(0.3, 0.7, 1));
}

}  // namespace

TEST_CASE(
    "the side of a plane is that of whole numbers, for points that are flat but for rounding") {
  std::mt19937_64 random(71);
  int below = 0, on = 0, above = 0, rounded_otherwise = 0;
  for (const double size : {1e-7, 0.3, 1e6})
    for (int k = 0; k < 2000; ++k) {
      const auto [a, b, c, d] = nearly_flat(random, size);
      const int side = orientation(a, b, c, d);
      (side < 0 ? below : side > 0 ? above : on) += 1;
      const double determinant = (b - a).cross(c - a).dot(d - a);
      rounded_otherwise += side != (determinant > 0) - (determinant < 0);
      REQUIRE(side_of_plane(a, b, c, d) == side);
      REQUIRE(side_of_plane(b, a, c, d) == -side);
      REQUIRE(side_of_plane(c, a, b, d) == side);
      REQUIRE(side_of_plane(d, c, b, a) == side);
    }
  CHECK(below > 500);
  CHECK(above > 500);
  CHECK(on > 100);
  CHECK(rounded_otherwise > 500);
}

TEST_CASE(
    "the side of a line is that of whole numbers, for points that are in line but for rounding") {
  std::mt19937_64 random(73);
  std::uniform_real_distribution<double> inside(-1, 1);
  int rounded_otherwise = 0;
  for (const double size : {1e-7, 0.3, 1e6})
    for (int k = 0; k < 2000; ++k) {
      const Eigen::Vector2d a = 3 * size * Eigen::Vector2d(inside(random), inside(random));
      const Eigen::Vector2d u = size * Eigen::Vector2d(inside(random), inside(random));
      const Eigen::Vector2d b = a + u, c = a + inside(random) * u;
      const int side = side_by_wholes(a, b, c);
      const Eigen::Vector2d p = b - a, q = c - a;
      const double area = p.x() * q.y() - p.y() * q.x();
      rounded_otherwise += side != (area > 0) - (area < 0);
      REQUIRE(side_of_line(a, b, c) == side);
      REQUIRE(side_of_line(b, a, c) == -side);
      REQUIRE(side_of_line(c, a, b) == side);
    }
  CHECK(rounded_otherwise > 300);
}

TEST_CASE("the sides of points in general position are those of whole numbers") {
  std::mt19937_64 random(79);
  std::uniform_real_distribution<double> inside(-1, 1);
  for (int k = 0; k < 500; ++k) {
    Eigen::Matrix<double, 3, 4> x;
    for (double& number : x.reshaped()) number = inside(random);
    REQUIRE(side_of_plane(x.col(0), x.col(1), x.col(2), x.col(3)) ==
            orientation(x.col(0), x.col(1), x.col(2), x.col(3)));
    const Eigen::Matrix<double, 2, 4> y = x.topRows<2>();
    REQUIRE(side_of_line(y.col(0), y.col(1), y.col(2)) ==
            side_by_wholes(y.col(0), y.col(1), y.col(2)));
  }
  CHECK(side_of_plane({0.1, 0.2, 0.3}, {1.1, 0.2, 0.3}, {0.1, 1.2, 0.3}, {0.7, 0.4, 0.9}) == 1);
  CHECK(side_of_line({0.1, 0.2}, {1.3, 0.5}, {0.4, 1.7}) == 1);
  CHECK(side_of_line({0.1, 0.2}, {0.4, 1.7}, {1.3, 0.5}) == -1);
}

TEST_CASE("corners that coincide are on every plane and line through them") {
  const Vector3 a(0.1, -0.7, 1.3), b(2.1, 0.3, 0.4), c(-0.6, 1.9, 0.8);
  CHECK(side_of_plane(a, b, c, a) == 0);
  CHECK(side_of_plane(a, b, c, c) == 0);
  CHECK(side_of_plane(a, a, b, c) == 0);
  CHECK(side_of_line({0.1, -0.7}, {2.1, 0.3}, {2.1, 0.3}) == 0);
  CHECK(side_of_line({0.1, -0.7}, {0.1, -0.7}, {2.1, 0.3}) == 0);
  CHECK(side_of_line({0.1, -0.7}, {0.4, -2.8}, {-0.2, 1.4}) == 0);  // multiples of the first
}

TEST_CASE("a difference of coordinates that no double holds counts in full") {
  const double large = 0x1p53;  // large + 1 is none
  CHECK(side_of_line({-1, 0}, {large, 1}, {large - 1, 1}) == 1);
  CHECK(side_of_line({-1, 0}, {large - 1, 1}, {large, 1}) == -1);
  CHECK(side_of_plane({-1, 0, 0}, {large, 1, 0}, {large - 1, 1, 0}, {-1, 0, 1}) == 1);
  CHECK(side_of_plane({0, 0, 0}, {1, 1, 0}, {-1, 1, 0}, {large, -large, 1}) == 1);
}
