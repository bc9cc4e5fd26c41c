// Vertices that are merged.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "reference/mesh/seams.h"
#include "reference/mesh/shapes.h"

using namespace foldproof;

TEST_CASE("vertices merge with the first one that stays, and the others are renumbered in order") {
  // 0 and 2 are near; 4 is near 2, not 0, and stays; 5 is near 4 and, nearer to it, to 6
  PerParticle3 x = PerParticle3::Zero(3, 7);
  x.row(0) << 0.1, 7, 0.3, 0, 0.5, 0.7, 0.74;
  x(1, 3) = 7;
  const TriangleSoup sewn = close_seams(
      {x, {{0, 1, 3}, {3, 2, 1}, {5, 1, 3}, {1, 6, 3}}, {"a.obj", {2, 3, 5, 7, 11, 13, 17}, {23}}},
      0.25);
  CHECK(sewn.rest == PerParticle3(x(Eigen::all, {0, 1, 3, 4})));
  CHECK(sewn.triangles == std::vector<Triangle>{{0, 1, 2}, {2, 0, 1}, {3, 1, 2}, {1, 3, 2}});
  CHECK(sewn.origin.file == "a.obj");
  CHECK(sewn.origin.vertex_lines == std::vector<int>{2, 3, 7, 11});
}

TEST_CASE("vertices merge at the distance itself, not beyond, in every direction") {
  const auto merges = [](const Vector3& p, const Vector3& q, double distance) {
    PerParticle3 x(3, 4);
    x << p, Vector3(40, 3, -7), Vector3(20, 4, 90), q;
    return close_seams({x, {{0, 1, 2}}, {}}, distance).rest.cols() == 3;
  };
  for (const double distance : {0.25, 4.0})
    for (const Vector3& place : {Vector3(-3, 5.75, 1.5), Vector3(0.75, -0.25, -9)})
      for (int k = 0; k < 27; ++k) {
        const Vector3 way = distance * Vector3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
        CHECK(merges(place, place + way, distance) == (way.norm() <= distance));
        CHECK(merges(place, place + 0.55 * way, distance));  // at most 0.96 of the distance
      }
  CHECK(merges({3, 4, 1}, {6, 8, 1}, 5));
  CHECK_FALSE(merges({3, 4, 1}, {6, 8, 1}, std::nextafter(5, 0)));
}

TEST_CASE("what cannot be sewn is refused with its place, whichever two corners merge") {
  const double infinity = std::numeric_limits<double>::infinity();
  PerParticle3 x = PerParticle3::Zero(3, 5);
  x(0, 1) = x(1, 2) = x(2, 3) = 5;
  x(0, 4) = 0.1;
  const MeshOrigin origin{"a.obj", {1, 2, 3, 5, 8}, {9, 10}};
  for (const Triangle& bad : {Triangle{0, 4, 1}, {1, 4, 0}, {4, 2, 0}, {4, 0, 3}}) {
    CHECK_THROWS_WITH(close_seams({x, {{0, 1, 2}, bad}, origin}, 0.2),
                      Catch::StartsWith("a.obj:10: two corners of this triangle are so near"));
  }
  for (const double bad : {infinity, std::nan("")}) {
    PerParticle3 y = x;
    y(1, 3) = bad;
    CHECK_THROWS_WITH(close_seams({y, {{0, 1, 2}}, origin}, 0.1),
                      Catch::StartsWith("a.obj:5: a coordinate is not finite"));
  }
}
