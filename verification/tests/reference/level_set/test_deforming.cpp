// Deforming bodies in time: normals that cancel, and objects made of them.
#include <catch2/catch.hpp>

#include <memory>

#include "reference/fast/out_of_reach.h"
#include "reference/level_set/object.h"
#include "reference/level_set/octree_nodes.h"

using namespace foldproof;

namespace {

template <class T, class Function>
BranchNodes<T> sampled(const OctreeSettings& settings, const Function& function) {
  BranchNodes<T> nodes;
  for (int n = 0; n < 27; ++n) nodes[n] = function(node_position(settings, {0, {0, 0, 0}}, n));
  return nodes;
}

/// A half-space in a tree of one branch, over a cube of 8 m about the origin.
DeformingFrame frame_of(double time, const Vector3& normal, double offset) {
  DeformingFrame frame{time, {}, {}, {}, 0, 0};
  Octree& tree = frame.field;
  tree.settings.corner = {-4, -4, -4};
  tree.settings.width = 8;
  tree.settings.depth = 1;
  tree.branches = {{1, 0, 0, 1}};
  tree.part = {0};
  tree.phi = {
      sampled<double>(tree.settings, [&](const Vector3& p) { return normal.dot(p) - offset; })};
  index_descent_starts(tree);
  return frame;
}

/// Two frames a second apart: as the first has it, its surroundings X move by X/2.
DeformingBody growing(BetweenFrames between, const DeformingFrame& second) {
  DeformingBody body{{frame_of(0, {1, 0, 0}, 0), second}, between};
  const OctreeSettings& settings = second.field.settings;
  body.frames[0].to_next = {
      sampled<Vector3>(settings, [](const Vector3& p) { return Vector3(p / 2); })};
  body.frames[1].from_previous = {
      sampled<Vector3>(settings, [](const Vector3&) { return Vector3(0, 0, 0); })};
  return body;
}

}  // namespace

TEST_CASE("where the blended normals cancel, that of the earlier frame stands") {
  const DeformingBody body = growing(BetweenFrames::blended, frame_of(1, {-1, 0, 0}, 0.5));
  const DeformingPoint found = deforming_at(body, {0.75, 0.25, 1}, 0.5);
  CHECK(found.normal == Vector3(1, 0, 0));
  CHECK(found.phi == 0.5 * 0.75 + 0.5 * (-0.75 - 0.5));
}

TEST_CASE("a deforming object has the mean velocity over a span, and is never out of reach") {
  const DeformingObject object{std::make_shared<const DeformingBody>(
      growing(BetweenFrames::carried, frame_of(1, {0, 1, 0}, 0)))};
  const Vector3 p(-0.6, 0.2, -0.35);
  const Vector3 moved = advected_position(*object.body, p, 0.2, 0.7) - p;
  const DeformingPoint now = deforming_at(*object.body, p, 0.2);
  const ObjectPoint found = object.at(p, {0.2, 0.7, 0.1});
  CHECK((found.phi == now.phi && found.normal == now.normal));
  CHECK((found.velocity - moved / 0.5).norm() < 1e-13);
  CHECK((object.at(p, {0.2, 0.2, 0.1}).velocity - now.velocity).norm() < 1e-13);
  const std::vector<Object> objects{{"body", object, 0.6}};
  RememberedQuery remembered(objects, {0.2, 0.7, 0.1});
  for (const ObjectPoint& answer : remembered.at({0.4, 0.7, 0.9})) CHECK(answer.phi > 0);
  CHECK_FALSE(remembered.out_of_reach({0.4, 0.7, 0.9}, Vector3::Zero(), 0));
}
