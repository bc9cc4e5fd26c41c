// Repaired meshes: which way triangles are turned.
#include <catch2/catch.hpp>
#include <random>

#include "reference/bodies/repair.h"
#include "reference/mesh/shapes.h"

using namespace foldproof;

namespace {

std::vector<Triangle> flipped(std::vector<Triangle> triangles, const std::vector<size_t>& which) {
  for (const size_t t : which) std::swap(triangles[t][1], triangles[t][2]);
  return triangles;
}

}  // namespace

TEST_CASE("triangles without area, by their shape, are left out of a repair") {
  for (const double size : {1e-4, 1.0, 1e4})
    for (int turn = 0; turn < 3; ++turn) {
      // area over the longest side squared: half of the height
      PerParticle3 x(3, 6);
      x << 0, 1, 0.4, 0, 1, 0.4, 0, 0, 1.9e-12, 0, 0, 2.1e-12, 0, 0, 0, 1, 1, 1;
      const auto turned = [&](int first) {
        return Triangle{first + turn, first + (turn + 1) % 3, first + (turn + 2) % 3};
      };
      const TriangleSoup soup{size * x, {turned(0), turned(3)}, {}};
      CHECK(orient_triangles(soup) == std::vector<Triangle>{turned(3)});
    }
}

TEST_CASE("the larger part of a patch's area keeps its orientation") {
  const TriangleMesh ball = make_icosphere(0.9, 1);
  std::mt19937 random(8);
  for (int k = 0; k < 20; ++k) {
    std::vector<size_t> some, others;
    for (size_t t = 0; t < ball.triangles.size(); ++t)
      (random() % 3 == 0 ? some : others).push_back(t);
    CHECK(orient_triangles({ball.rest, flipped(ball.triangles, some), {}}) == ball.triangles);
    CHECK(orient_triangles({ball.rest, flipped(ball.triangles, others), {}}) ==
          flipped(flipped(ball.triangles, some), others));
  }
}

TEST_CASE("patches are turned by their own larger area, of equal ones to their first triangle") {
  // a strip of triangles (0, 1, 2), (2, 1, 3), (2, 3, 4) with their heights; another far beside it
  const auto strip = [](double first, double rest) {
    PerParticle3 x = PerParticle3::Zero(3, 10);
    x.row(0) << -first, 0, 0, rest, rest, 15, 20, 20, 22, 22;
    x.row(1) << 0, -1, 1, -1, 1, 0, -1, 1, -1, 1;
    return x;
  };
  const std::vector<Triangle> even{{0, 1, 2}, {2, 1, 3}, {2, 3, 4},
                                   {5, 6, 7}, {7, 6, 8}, {7, 8, 9}};
  const auto turned = [&](double first, const std::vector<size_t>& which) {
    return orient_triangles({strip(first, 2), flipped(even, which), {}});
  };
  // areas: first, 2, 2; and 5, 2, 2
  CHECK(turned(5, {0}) == flipped(even, {0, 1, 2}));
  CHECK(turned(3, {0}) == even);
  CHECK(turned(4, {0}) == flipped(even, {0, 1, 2}));
  CHECK(turned(4, {1, 2}) == even);
  CHECK(turned(5, {2, 4}) == even);
  // three triangles at the edge 0-1, of which two run the same way: sheets of their own
  const std::vector<Triangle> fins{{0, 1, 2}, {0, 1, 3}, {1, 0, 4}};
  CHECK(orient_triangles({strip(5, 2), fins, {}}) == fins);
}
