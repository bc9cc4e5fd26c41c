// Smoothed surfaces of cloth that crosses itself.
#include <catch2/catch.hpp>

#include "reference/post/smooth_cloth.h"

using namespace foldproof;

TEST_CASE("where cloth crosses itself its points are on the cloth after eleven rounds") {
  PerParticle3 x(3, 6);
  x << 0.1, 1.3, 0.2, 0.3, 0.6, 0.5, 0.2, 0.1, 1.2, 0.3, 0.7, 0.4, 0.1, 0.2, 0.1, -0.9, -0.6, 0.8;
  const TriangleMesh mesh = make_triangle_mesh(x, {{0, 1, 2}, {3, 4, 5}});
  const SmoothedCloth cloth = smooth_cloth(ClothSmoother(mesh, 1), x);
  CHECK(cloth.rounds >= 12);
  CHECK(cloth.pairs_left > 0);
  CHECK(cloth.share.minCoeff() == 0);
}
