// How deforming bodies are made: triangles without area, and sequences that are refused.
#include <catch2/catch.hpp>

#include <cmath>

#include "reference/level_set/deforming.h"

using namespace foldproof;
using Catch::Contains;

namespace {

const std::vector<Triangle> four_faces{{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {1, 0, 2}};

PerParticle3 irregular() {
  PerParticle3 x(3, 4);
  x << 0.71, 0.32, 0.43, 0.56, 0.47, 0.73, 0.26, 0.52, 0.38, 0.35, 0.43, 0.71;
  return x;
}

const OctreeSettings sampling{{0, 0, 0}, 1, 4, 2, 0.008, 0.03, 0, 0, HangingNodes::constrained};

}  // namespace

TEST_CASE("a triangle without area moves its surroundings as its first corner moves") {
  PerParticle3 x(3, 3), moved;
  x << 0.25, 0.5, 0.375, 0.375, 0.375, 0.375, 0.5, 0.5, 0.5;
  moved = x;
  moved.row(0) += Eigen::RowVector3d(0.03, 0.07, -0.01);
  const DeformingBody body =
      make_deforming_body({{{0, 1, 2}}, {0, 0.5}, {x, moved}}, sampling, BetweenFrames::carried);
  for (const BranchNodes<Vector3>& nodes : body.frames[0].to_next)
    for (const Vector3& u : nodes) CHECK((u - Vector3(0.03, 0, 0)).norm() < 1e-15);
}

TEST_CASE("a mesh sequence has frames of equally many vertices at times that rise") {
  const auto refused = [](const std::vector<double>& times, int vertices, const char* text) {
    const PerParticle3 last = PerParticle3::Constant(3, vertices, 0.4);
    CHECK_THROWS_WITH(make_deforming_body({four_faces, times, {irregular(), irregular(), last}},
                                          sampling, BetweenFrames::carried),
                      Contains(text));
  };
  refused({}, 4, "it needs a frame");
  refused({0.3, 0.5}, 4, "a time for each");
  refused({0.3, 0.3, 0.5}, 4, "frame 1: the times must rise");
  refused({0.3, 0.5, NAN}, 4, "frame 2: the times must rise");
  refused({0.3, 0.5, 1.1}, 3, "frame 2: it must have as many vertices as the first");
  refused({0.3, 0.5, 1.1}, 5, "frame 2: it must have as many vertices as the first");
}
