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

TEST_CASE("signs are exact in planes and lines, however far apart the coordinates are") {
  const Vector3 a(0.1, -0.7, 1.3), b(2.1, 0.3, 0.4);
  CHECK(side_of_plane({0.1, 0.2, 0.3}, {1.1, 0.2, 0.3}, {0.1, 1.2, 0.3}, {0.7, 0.4, 0.9}) == 1);
  CHECK(side_of_plane(a, b, {-0.6, 1.9, 0.8}, a) == 0);
  CHECK(side_of_line({0.1, 0.2}, {1.3, 0.5}, {0.4, 1.7}) == 1);
  CHECK(side_of_line({0.1, -0.7}, {0.4, -2.8}, {-0.2, 1.4}) == 0);  // multiples of the first
  const double large = 0x1p53;                                      // large + 1 is none
  CHECK(side_of_line({-1, 0}, {large, 1}, {large - 1, 1}) == 1);
  CHECK(side_of_line({-1, 0}, {large - 1, 1}, {large, 1}) == -1);
  CHECK(side_of_plane({-1, 0, 0}, {large, 1, 0}, {large - 1, 1, 0}, {-1, 0, 1}) == 1);
  CHECK(side_of_plane({0, 0, 0}, {1, 1, 0}, {-1, 1, 0}, {large, -large, 1}) == 1);
}
