// Cloth prepared for rendering: depth maps, points moved out of objects, and smoothed surfaces.
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/mesh/shapes.h"
#include "reference/post/fold_projection.h"
#include "reference/post/smooth_cloth.h"

using namespace foldproof;

namespace {

Object ground() { return {"ground", RigidObject{HalfSpace{}, {}, Motion{}}, 0.3}; }

/// A half-space above z = height [m], turned by half a turn about x: its outside is below.
Object ceiling(double height) {
  return {"ceiling", RigidObject{HalfSpace{}, {{0, 1, 0, 0}, {0, 0, height}}, Motion{}}, 0.3};
}

/// Plain, within half a tolerance of 2^-10 m of 0.25 m.
FoldProjection coarse(int max_moves) {
  return {"plain", {0.25, 0.5, 0}, PinchedPoints::left_alone, 1.0 / 1024, max_moves};
}

ProjectedCloth project_point(const std::vector<Object>& objects, const Vector3& p,
                             const FoldProjection& projection) {
  return project_folds(objects, PerParticle3(p), 0.7, projection);
}

/// A ridge of wide cells over one of narrow cells, which Loop's rule rounds off less.
struct LayeredRidges {
  TriangleMesh mesh;
  PerParticle3 x;
};

LayeredRidges layered_ridges() {
  const TriangleMesh lower = make_sheet({SheetPattern::alternating, 1, 0.6, 8, 5}),
                     upper = make_sheet({SheetPattern::one_diagonal, 1, 0.6, 4, 3});
  PerParticle3 x(3, lower.rest.cols() + upper.rest.cols());
  x << lower.rest, upper.rest;
  x.rightCols(upper.rest.cols()).row(2).array() += 0.015;
  x.row(2).array() -= 0.9 * (x.row(0).array() - 0.5).abs();
  std::vector<Triangle> triangles = lower.triangles;
  const int n = lower.particles();
  for (const Triangle& t : upper.triangles) triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  return {make_triangle_mesh(x, triangles), x};
}

}  // namespace

TEST_CASE("at the reach of a map nothing changes, not by a bit") {
  for (int k = 1; k < 200; ++k) {
    const DepthBand by{0.0013 * k, 0.0031 * k + 0.017, 0.0071 * k};
    for (const DepthMap& map : depth_maps()) CHECK(map.at(by, by.reach) == by.reach);
  }
}

TEST_CASE("a point at its mapped distance stays, others end half a tolerance beyond theirs") {
  PerParticle3 x(3, 4);
  x << 0.3, 0.4, 0.6, 0.7, -0.7, 0.2, 0.8, 0.9, 0.25, 0.1875, 0.75, -0.375;
  const ProjectedCloth cloth = project_folds(std::vector{ground()}, x, 0.7, coarse(5));
  using enum ProjectionOutcome;
  CHECK(cloth.outcomes == std::vector{untouched, moved, untouched, moved});
  CHECK(cloth.count(moved) == 2);
  CHECK(cloth.before == PerParticle(x.row(2).transpose()));
  const double aim = 0.25 + 1.0 / 2048;
  CHECK(cloth.after == Eigen::Vector4d(0.25, aim, 0.75, aim));
  x(2, 1) = x(2, 3) = aim;
  CHECK(cloth.x == x);
}

TEST_CASE("a point has arrived at the very distance, and at the whole tolerance beyond it") {
  // the first move ends a quarter and half a tolerance above the ground: as far below the ceiling
  const ProjectedCloth least =
      project_point({ground(), ceiling(0.5 + 1.0 / 2048)}, {0.3, -0.7, -0.125}, coarse(1));
  CHECK(least.after[0] == 0.25);
  CHECK(least.outcomes == std::vector{ProjectionOutcome::moved});

  // f is odd in its last bit, the tolerance one bit: half of it is rounded up to the whole
  const double bit = std::ldexp(1, -54), f = 0.25 + bit;
  FoldProjection fine = coarse(1);
  fine.band.nearest = f, fine.tolerance = bit;
  const ProjectedCloth most = project_point({ground()}, {0.3, -0.7, 0}, fine);
  CHECK(most.after[0] == f + bit);
  CHECK(most.outcomes == std::vector{ProjectionOutcome::moved});
}

TEST_CASE("of places equally near to the distance the first one is kept") {
  const double aim = 0.25 + 1.0 / 2048;
  for (const int moves : {1, 2, 5}) {
    const ProjectedCloth cloth =
        project_point({ground(), ceiling(0.375)}, {0.3, -0.7, -0.0625}, coarse(moves));
    CHECK(cloth.x.col(0) == Vector3(0.3, -0.7, aim));
    CHECK(cloth.after[0] == 0.375 - aim);
    CHECK(cloth.before[0] == -0.0625);
    CHECK(cloth.outcomes == std::vector{ProjectionOutcome::unfinished});
  }
}

TEST_CASE("a smooth surface that meets nothing is checked once and kept") {
  const TriangleMesh sheet = make_sheet({SheetPattern::alternating, 1, 0.6, 4, 3});
  PerParticle3 x = sheet.rest;
  x.row(2) = 0.3 * x.row(0).array().square() - 0.2 * x.row(1).array();
  const SmoothedCloth cloth = smooth_cloth(ClothSmoother(sheet, 1), x);
  CHECK(cloth.rounds == 1);
  CHECK(cloth.pairs_left == 0);
  CHECK(cloth.share == PerParticle::Ones(cloth.x.cols()));
}

TEST_CASE("where cloth crosses itself its points are on the cloth after eleven rounds") {
  PerParticle3 x(3, 6);
  x << 0.1, 1.3, 0.2, 0.3, 0.6, 0.5, 0.2, 0.1, 1.2, 0.3, 0.7, 0.4, 0.1, 0.2, 0.1, -0.9, -0.6, 0.8;
  const TriangleMesh mesh = make_triangle_mesh(x, {{0, 1, 2}, {3, 4, 5}});
  const SmoothedCloth cloth = smooth_cloth(ClothSmoother(mesh, 1), x);
  CHECK(cloth.rounds >= 12);
  CHECK(cloth.pairs_left > 0);
  CHECK(cloth.share.minCoeff() == 0);
}

TEST_CASE("points of a smooth cloth are held back by halves") {
  const LayeredRidges ridges = layered_ridges();
  const SmoothedCloth cloth = smooth_cloth(ClothSmoother(ridges.mesh, 1), ridges.x);
  CHECK(cloth.pairs_left == 0);
  int between = 0;
  for (const double share : cloth.share) {
    int power = 0;
    CHECK((share == 0 || std::frexp(share, &power) == 0.5));
    between += share > 0 && share < 1;
  }
  CHECK(between > 0);
  CHECK(cloth.share.maxCoeff() == 1);
}
