// Triangles of one plane that meet, and crossings of rays.
#include <catch2/catch.hpp>

#include "reference/bodies/ray_parity.h"
#include "reference/mesh/self_intersection.h"

using namespace foldproof;

TEST_CASE("rays through edges and corners cross one triangle, on the lower sides of a cube") {
  // corners at nodes 1 and 4 of every row, or a hair above 4; each face of two triangles
  const double above = GENERATE(0.0, 5e-7);
  PerParticle3 x(3, 8);
  for (int k = 0; k < 8; ++k)
    x.col(k) = 0.5 * Vector3(k & 1 ? 4 + above : 1, k & 2 ? 4 + above : 1, k & 4 ? 4 + above : 1);
  const std::vector<Triangle> cube{{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                   {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                   {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  const Lattice lattice{Vector3::Zero(), 0.5, {6, 7, 8}};
  const std::vector<std::uint8_t> votes = ray_parity(x, cube, lattice);
  for (long index = 0; index < lattice.size(); ++index) {
    const Node n = lattice.node(index);
    int expected = 0;
    for (size_t axis = 0; axis < 3; ++axis) {
      const auto crosses = [&](size_t across) { return 1 <= n[across] && n[across] < 4 + above; };
      expected += 1 < n[axis] && n[axis] <= 4 && crosses((axis + 1) % 3) && crosses((axis + 2) % 3);
    }
    CHECK(int(votes[size_t(index)]) == expected);
  }
}

TEST_CASE("disagreement: signs against the majority of rays, and rays against each other") {
  Grid grid;
  grid.lattice = {Vector3::Zero(), 1, {3, 2, 2}};
  //          near the surface  on it   outside          inside
  grid.phi = {0.2, -0.2, -0.1, 0, 0.3, 0.4, 0.5, 0.6, -0.3, -0.4, -0.5, -0.6};
  const std::vector<std::uint8_t> parity{3, 0, 1, 1, 0, 1, 2, 3, 0, 1, 2, 3};
  const Disagreement found = disagreement(grid, parity, grid.phi[0]);
  CHECK(found.with_sign == std::vector<long>{6, 7, 8, 9});
  CHECK(found.among_rays == std::vector<long>{5, 6, 9, 10});
  CHECK(disagreement(grid, parity, -1).with_sign == std::vector<long>{0, 1, 2, 6, 7, 8, 9});
}

TEST_CASE("triangles of one plane intersect where only their edges cross") {
  PerParticle3 x(3, 6);
  x << 0, 4, 2, 0, 4, 2, 0, 0, 3, 2, 2, -1, 0, 0, 0, 0, 0, 0;
  const std::vector<Triangle> star{{0, 1, 2}, {3, 4, 5}};
  CHECK(self_intersections(x, star).size() == 1);
  x.rightCols(3).row(0).array() += 4.5;
  CHECK(self_intersections(x, star).empty());
}
