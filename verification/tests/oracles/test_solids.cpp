// The oracles of solids against a second way: sampled triangles, areas counted in cells.
#include <catch2/catch.hpp>

#include <Eigen/Geometry>
#include <cmath>

#include "verification/oracles/solid_prisms.h"
#include "verification/oracles/triangle_distance.h"

namespace foldproof {

using oracles::WholePrism;

TEST_CASE("a prism's inside has its polygon's area and its height") {
  // a notch: area 96 - 36
  const WholePrism prism{{{0, 0}, {12, 0}, {12, 8}, {6, 2}, {0, 8}}, -3, 2};
  long inside = 0, surface = 0;
  for (long x = -1; x <= 13; ++x)
    for (long y = -1; y <= 9; ++y)
      for (long z = -4; z <= 3; ++z) {
        const int side = oracles::inside_prism(prism, {x, y, z});
        inside += side > 0;
        surface += side == 0;
      }
  // Pick: area = interior + border/2 - 1, with border 12 + 8 + 6 + 6 + 8 = 40 lattice points
  const long interior = 60 - 40 / 2 + 1;
  CHECK(inside == interior * 4);
  CHECK(surface == 40 * 6 + interior * 2);
}

TEST_CASE("nested prisms are inside by turns") {
  const WholePrism outer{{{-9, -9}, {9, -9}, {9, 9}, {-9, 9}}, -9, 9};
  const WholePrism inner{{{-4, -4}, {4, -4}, {4, 4}, {-4, 4}}, -4, 4};
  CHECK(oracles::inside_nested({outer, inner}, {0, 1, 2}) < 0);
  CHECK(oracles::inside_nested({outer, inner}, {0, 6, 2}) > 0);
  CHECK(oracles::inside_nested({outer, inner}, {4, 1, 2}) == 0);
  CHECK(oracles::inside_nested({outer, inner}, {0, 1, 12}) < 0);
}

TEST_CASE("distance to a triangle is that to a fine sampling of it") {
  PerParticle3 x(3, 3);
  x << 0.3, 1.9, -0.4, 0.1, 0.7, 1.3, -0.2, 0.5, 0.9;
  constexpr int fine = 400;
  for (const Vector3& p : {Vector3(0.5, 0.6, 2.1), Vector3(-1, -1, 0.3), Vector3(2.5, 1.7, 0.1),
                           Vector3(0.6, 0.7, 0.4)}) {
    double least = INFINITY;
    for (int i = 0; i <= fine; ++i)
      for (int j = 0; i + j <= fine; ++j)
        least = std::min(least, (p - x * Vector3(fine - i - j, i, j) / fine).norm());
    const double distance = oracles::distance_to_triangles(x, {{0, 1, 2}}, p).value;
    CHECK(distance <= least);
    CHECK(distance >= least - 2.5 / fine);  // the longest edge is 2.5 m
  }
}

}  // namespace foldproof
