// Objects that deform: their level sets and motion, and how they are built.
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

#include "reference/fast/out_of_reach.h"
#include "reference/level_set/deforming.h"
#include "reference/level_set/object.h"
#include "reference/level_set/octree_nodes.h"
#include "reference/mesh/shapes.h"

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

TEST_CASE("frames that intersect themselves are the union, by their winding number") {
  const TriangleMesh ball = make_icosphere(0.15, 3);
  const auto frame = [&](double apart) {
    PerParticle3 x(3, 2 * ball.particles());
    x << ball.rest.colwise() + Vector3(0.5 - apart / 2, 0.5, 0.5),
        ball.rest.colwise() + Vector3(0.5 + apart / 2, 0.5, 0.5);
    return x;
  };
  MeshSequence balls{ball.triangles, {0, 0.5}, {frame(0.15), frame(0.4)}, Inside::winding};
  for (const Triangle& t : ball.triangles)
    balls.triangles.push_back(
        {t[0] + ball.particles(), t[1] + ball.particles(), t[2] + ball.particles()});
  OctreeSettings fine = sampling;
  fine.depth = 5;
  const DeformingBody body = make_deforming_body(balls, fine, BetweenFrames::carried);
  for (const int k : {0, 1}) {
    const double apart = k == 0 ? 0.15 : 0.4;
    int within = 0;
    for (int i = 0; i < 1000; ++i) {
      const Vector3 p(0.15 + 0.07 * (i % 10), 0.2 + 0.06 * (i / 10 % 10), 0.21 + 0.06 * (i / 100));
      const auto from = [&](double side) {
        return (p - Vector3(0.5 + side * apart / 2, 0.5, 0.5)).norm() - 0.15;
      };
      const double phi = deforming_at(body, p, 0.5 * k).phi, truth = std::min(from(1), from(-1));
      if (truth > 0) CHECK(std::abs(phi - truth) < 0.02);
      // inside both, no surface is nearer than the circle in which the balls meet
      if (truth < -0.02) CHECK(phi < (std::max(from(1), from(-1)) < 0 ? -0.03 : -0.005));
      within += truth < -0.02;
    }
    CHECK(within > 20);
  }
  balls.triangles = four_faces;
  balls.positions = {irregular(), irregular()};
  for (Triangle& t : balls.triangles) std::swap(t[0], t[1]);
  CHECK_THROWS_WITH(make_deforming_body(balls, fine, BetweenFrames::carried),
                    Contains("frame 0: repair finds no inside"));
}
