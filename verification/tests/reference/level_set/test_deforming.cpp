// Deforming bodies in time: frames whose distances and displacements are linear in space, so that
// every answer has a closed form.
#include <catch2/catch.hpp>

#include <Eigen/LU>
#include <cmath>
#include <memory>

#include "reference/fast/out_of_reach.h"
#include "reference/level_set/object.h"
#include "reference/level_set/octree_nodes.h"

using namespace foldproof;

namespace {

struct Affine {
  Eigen::Matrix3d slope;
  Vector3 offset;

  Vector3 at(const Vector3& p) const { return slope * p + offset; }
  /// The X with X + fraction u(X) = p.
  Vector3 origin(const Vector3& p, double fraction) const {
    return (Eigen::Matrix3d::Identity() + fraction * slope).inverse() * (p - fraction * offset);
  }
};

struct Plane {
  Vector3 normal;
  double offset;

  double at(const Vector3& p) const { return normal.dot(p) - offset; }
};

/// One interval: the planes at its ends, and the displacement as either frame has it.
struct Expected {
  double start, end;  // s
  Plane before, after;
  Affine ahead, back;
};

Affine affine(double a, double b, double c, const Vector3& offset) {
  Eigen::Matrix3d slope;
  slope << a, 0.05, -c, b, -0.08, 0.11, 0.03, c, -a;
  return {slope, offset};
}

const Plane planes[] = {
    {Vector3(2, 3, 6) / 7, 0.11}, {Vector3(6, -2, 3) / 7, -0.23}, {Vector3(-3, 6, 2) / 7, 0.31}};

const Expected intervals[] = {
    {0.3, 0.8, planes[0], planes[1], affine(0.1, -0.07, 0.04, {0.3, -0.2, 0.1}),
     affine(0.06, 0.09, -0.1, {-0.15, 0.25, 0.2})},
    {0.8, 2.1, planes[1], planes[2], affine(-0.12, 0.05, 0.07, {0.2, 0.15, -0.3}),
     affine(0.08, -0.03, 0.1, {0.1, -0.35, 0.25})}};

template <class T, class Function>
BranchNodes<T> sampled(const OctreeSettings& settings, const Function& function) {
  BranchNodes<T> nodes;
  for (int n = 0; n < 27; ++n) nodes[n] = function(node_position(settings, {0, {0, 0, 0}}, n));
  return nodes;
}

/// A tree of one branch, trilinear in each of its eight cells.
Octree tree_of(const Plane& plane, const Vector3& corner, double width) {
  Octree tree;
  tree.settings.corner = corner;
  tree.settings.width = width;
  tree.settings.depth = 1;
  tree.branches = {{1, 0, 0, 1}};
  tree.part = {0};
  tree.phi = {sampled<double>(tree.settings, [&](const Vector3& p) { return plane.at(p); })};
  index_descent_starts(tree);
  return tree;
}

std::vector<BranchNodes<Vector3>> displacements(const Octree& tree, const Affine& u) {
  return {sampled<Vector3>(tree.settings, [&](const Vector3& p) { return u.at(p); })};
}

DeformingFrame frame_of(double time, const Plane& plane, const Vector3& corner, double width) {
  return {time, tree_of(plane, corner, width), {}, {}, 0, 0};
}

DeformingBody body_of(BetweenFrames between) {
  DeformingBody body{{}, between};
  const double times[] = {0.3, 0.8, 2.1};
  for (int k = 0; k < 3; ++k)
    body.frames.push_back(frame_of(times[k], planes[k], {-3, -2.5, -2.75}, 6));
  for (int k = 0; k < 2; ++k) {
    const Octree& tree = body.frames[k].field;
    body.frames[k].to_next = displacements(tree, intervals[k].ahead);
    body.frames[k + 1].from_previous = displacements(tree, intervals[k].back);
  }
  return body;
}

DeformingPoint expected_at(BetweenFrames between, const Expected& e, const Vector3& p, double t) {
  const double s = (t - e.start) / (e.end - e.start);
  const bool carried = between == BetweenFrames::carried;
  const Vector3 a = carried ? e.ahead.origin(p, s) : p, b = carried ? e.back.origin(p, s - 1) : p;
  return {(1 - s) * e.before.at(a) + s * e.after.at(b),
          ((1 - s) * e.before.normal + s * e.after.normal).normalized(),
          ((1 - s) * e.ahead.at(a) + s * e.back.at(b)) / (e.end - e.start)};
}

void check_point(const DeformingPoint& found, const DeformingPoint& expected) {
  CHECK(std::abs(found.phi - expected.phi) < 1e-13);
  CHECK((found.normal - expected.normal).norm() < 1e-13);
  CHECK((found.velocity - expected.velocity).norm() < 1e-13);
}

const Vector3 places[] = {{0.4, -0.7, 0.9}, {-0.6, 0.2, -0.35}, {0.05, 1.1, 0.45}};

/// Two frames, a second apart, over a cube of 8 m: planes x = 0 and y = 0, displacement 2 X and 0.
DeformingBody swinging() {
  DeformingBody body{{}, BetweenFrames::carried};
  body.frames.push_back(frame_of(0, {{1, 0, 0}, 0}, {-4, -4, -4}, 8));
  body.frames.push_back(frame_of(1, {{0, 1, 0}, 0}, {-4, -4, -4}, 8));
  const Octree& tree = body.frames[0].field;
  body.frames[0].to_next = displacements(tree, {2 * Eigen::Matrix3d::Identity(), {0, 0, 0}});
  body.frames[1].from_previous = displacements(tree, {Eigen::Matrix3d::Zero(), {0, 0, 0}});
  return body;
}

}  // namespace

TEST_CASE("between frames phi, N and v are blended at the point, or where its motion came from") {
  for (const BetweenFrames between : {BetweenFrames::blended, BetweenFrames::carried}) {
    const DeformingBody body = body_of(between);
    for (const Vector3& p : places) {
      for (const double t : {0.3, 0.45, 0.7})
        check_point(deforming_at(body, p, t), expected_at(between, intervals[0], p, t));
      for (const double t : {0.8, 1.1, 2.0})  // at a frame, the interval that begins
        check_point(deforming_at(body, p, t), expected_at(between, intervals[1], p, t));
      // before the first frame, and from the last on, the body rests
      for (const double t : {-0.4, 0.299})
        check_point(deforming_at(body, p, t), {planes[0].at(p), planes[0].normal, {0, 0, 0}});
      for (const double t : {2.1, 3.5})
        check_point(deforming_at(body, p, t), {planes[2].at(p), planes[2].normal, {0, 0, 0}});
    }
  }
}

TEST_CASE("where the blended normals cancel, that of the earlier frame stands") {
  DeformingBody body = swinging();
  body.between = BetweenFrames::blended;
  body.frames[1].field = tree_of({{-1, 0, 0}, 0.5}, {-4, -4, -4}, 8);
  const DeformingPoint found = deforming_at(body, {0.75, 0.25, 1}, 0.5);
  CHECK(found.normal == Vector3(1, 0, 0));
  CHECK(found.phi == 0.5 * 0.75 + 0.5 * (-0.75 - 0.5));
}

TEST_CASE("the search for where a point came from ends after fifty steps that do not converge") {
  // halfway X = p - X, which goes to and fro between 0 and p; fifty steps end at p
  const Vector3 p(0.75, 0.25, 1);
  const DeformingPoint found = deforming_at(swinging(), p, 0.5);
  CHECK(found.phi == 0.5 * 0.75 + 0.5 * 0.25);
  CHECK((found.velocity - p).norm() < 1e-15);
}

TEST_CASE("a deforming object has the mean velocity over a span, and is never out of reach") {
  const DeformingObject object{
      std::make_shared<const DeformingBody>(body_of(BetweenFrames::carried))};
  const Vector3 p = places[1];
  const Vector3 moved = advected_position(*object.body, p, 0.5, 1.7) - p;
  const DeformingPoint now = deforming_at(*object.body, p, 0.5);
  const ObjectPoint found = object.at(p, {0.5, 1.7, 0.2});
  check_point({found.phi, found.normal, found.velocity}, {now.phi, now.normal, moved / 1.2});
  CHECK((object.at(p, {0.5, 0.5, 0.2}).velocity - now.velocity).norm() < 1e-13);
  const std::vector<Object> objects{{"body", object, 0.6}};
  RememberedQuery remembered(objects, {0.5, 1.7, 0.2});
  for (const ObjectPoint& answer : remembered.at({0.4, -0.7, 3.9})) CHECK(answer.phi > 0);
  CHECK_FALSE(remembered.out_of_reach({0.4, -0.7, 3.9}, Vector3::Zero(), 0));
}
