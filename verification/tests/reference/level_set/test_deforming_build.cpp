// How deforming bodies are made: displacements of nodes, sequences, and what is refused of them.
#include <catch2/catch.hpp>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "reference/level_set/deforming.h"
#include "reference/level_set/mesh_distance.h"
#include "reference/level_set/octree_nodes.h"

using namespace foldproof;
using Catch::Contains;

namespace {

const std::vector<Triangle> four_faces{{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {1, 0, 2}};

PerParticle3 irregular() {
  PerParticle3 x(3, 4);
  x << 0.71, 0.32, 0.43, 0.56, 0.47, 0.73, 0.26, 0.52, 0.38, 0.35, 0.43, 0.71;
  return x;
}

/// With nothing allowed beyond the band, kept surface points are the nearest ones.
OctreeSettings sampling(HangingNodes hanging) {
  return {{0, 0, 0}, 1, 4, 2, 0.008, 0.03, 0, 0, hanging};
}

/// Displacements at nodes against those of an affine motion at their nearest surface points.
void check_displacements(const std::vector<BranchNodes<Vector3>>& found, const Octree& tree,
                         const MeshDistance& mesh, const Eigen::Matrix3d& slope,
                         const Vector3& offset) {
  const std::vector<OctreePlace> places = branch_places(tree);
  REQUIRE(found.size() == places.size());
  double worst = 0;
  for (std::size_t b = 0; b < places.size(); ++b) {
    BranchNodes<Vector3> expected;
    for (int n = 0; n < 27; ++n) {
      const Vector3 p = node_position(tree.settings, places[b], n);
      const Distance distance = mesh.at(p);
      expected[n] = slope * (p - distance.phi * distance.normal) + offset;
    }
    if (tree.settings.hanging == HangingNodes::constrained)
      constrain(hanging_nodes(tree, places[b]), expected);
    for (int n = 0; n < 27; ++n) worst = std::max(worst, (found[b][n] - expected[n]).norm());
  }
  CHECK(worst < 1e-12);
}

}  // namespace

TEST_CASE("a node is displaced as its nearest surface point, to the next frame and from the last") {
  Eigen::Matrix3d slope;
  slope << 0.04, -0.07, 0.02, 0.05, -0.03, 0.06, -0.02, 0.03, 0.05;
  const Vector3 offset(0.01, -0.02, 0.015);
  MeshSequence sequence{four_faces, {0.3, 0.5, 1.1}, {irregular()}};
  for (int k = 0; k < 2; ++k)
    sequence.positions.push_back(
        ((Eigen::Matrix3d::Identity() + slope) * sequence.positions[k]).colwise() + offset);
  // the motion since the frame before, of the places where it ends
  const Eigen::Matrix3d back = slope * (Eigen::Matrix3d::Identity() + slope).inverse();
  const Vector3 back_offset = offset - back * offset;
  for (const HangingNodes hanging : {HangingNodes::free, HangingNodes::constrained}) {
    const DeformingBody body =
        make_deforming_body(sequence, sampling(hanging), BetweenFrames::carried);
    REQUIRE(body.frames.size() == 3);
    for (std::size_t k = 0; k < 3; ++k) {
      const DeformingFrame& frame = body.frames[k];
      const MeshDistance mesh = make_mesh_distance(sequence.positions[k], four_faces);
      CHECK(frame.time == sequence.times[k]);
      if (k == 0)
        CHECK(frame.from_previous.empty());
      else
        check_displacements(frame.from_previous, frame.field, mesh, back, back_offset);
      if (k == 2)
        CHECK(frame.to_next.empty());
      else
        check_displacements(frame.to_next, frame.field, mesh, slope, offset);
    }
  }
}

TEST_CASE("a triangle without area moves its surroundings as its first corner moves") {
  PerParticle3 x(3, 3), moved;
  x << 0.25, 0.5, 0.375, 0.375, 0.375, 0.375, 0.5, 0.5, 0.5;
  moved = x;
  moved.row(0) += Eigen::RowVector3d(0.03, 0.07, -0.01);
  const DeformingBody body =
      make_deforming_body({{{0, 1, 2}}, {0, 0.5}, {x, moved}}, sampling(HangingNodes::constrained),
                          BetweenFrames::carried);
  for (const BranchNodes<Vector3>& nodes : body.frames[0].to_next)
    for (const Vector3& u : nodes) CHECK((u - Vector3(0.03, 0, 0)).norm() < 1e-15);
}

TEST_CASE("a mesh sequence has frames of equally many vertices at times that rise") {
  const auto refused = [](const std::vector<double>& times, int vertices, const char* text) {
    const PerParticle3 last = PerParticle3::Constant(3, vertices, 0.4);
    CHECK_THROWS_WITH(make_deforming_body({four_faces, times, {irregular(), irregular(), last}},
                                          sampling(HangingNodes::free), BetweenFrames::carried),
                      Contains(text));
  };
  refused({}, 4, "it needs a frame");
  refused({0.3, 0.5}, 4, "a time for each");
  refused({0.3, 0.3, 0.5}, 4, "frame 1: the times must rise");
  refused({0.3, 0.5, NAN}, 4, "frame 2: the times must rise");
  refused({0.3, 0.5, 1.1}, 3, "frame 2: it must have as many vertices as the first");
  refused({0.3, 0.5, 1.1}, 5, "frame 2: it must have as many vertices as the first");
}
