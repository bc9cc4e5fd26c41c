#include "reference/level_set/deforming.h"

#include <algorithm>

#include "reference/level_set/octree_nodes.h"

namespace foldproof {

namespace {

/// Two frames and the time between them; `next` is null while the body rests.
struct Interval {
  const DeformingFrame *now, *next;
  double part;      // 0 at `now`, 1 at `next`
  double duration;  // s
};

Interval interval_at(const DeformingBody& body, double t) {
  const std::vector<DeformingFrame>& frames = body.frames;
  const auto next =
      std::upper_bound(frames.begin(), frames.end(), t,
                       [](double time, const DeformingFrame& frame) { return time < frame.time; });
  if (next == frames.begin()) return {&frames.front(), nullptr, 0, 0};
  if (next == frames.end()) return {&frames.back(), nullptr, 0, 0};
  const DeformingFrame& now = *(next - 1);
  const double duration = next->time - now.time;
  return {&now, &*next, (t - now.time) / duration, duration};
}

/// The trilinear displacement at p; outside the cube, at the cube's nearest point.
Vector3 displacement_at(const Octree& tree, const std::vector<BranchNodes<Vector3>>& nodes,
                        const Vector3& p) {
  const OctreeSettings& cube = tree.settings;
  const Vector3 q = p.cwiseMax(cube.corner).cwiseMin(cube.corner + Vector3::Constant(cube.width));
  const OctreeLeaf leaf = leaf_at(tree, q);
  const BranchNodes<Vector3>& values = nodes[tree.branches[leaf.branch].channels];
  const int first = first_corner(leaf.child);
  Vector3 sum = Vector3::Zero();
  for (int k = 0; k < 8; ++k) {
    double weight = 1;
    for (int axis = 0; axis < 3; ++axis)
      weight *= k >> axis & 1 ? leaf.local[axis] : 1 - leaf.local[axis];
    sum += weight * values[first + corner_steps[k]];
  }
  return sum;
}

struct Origin {
  Vector3 place, displacement;
};

/// The place X that a fraction `share` of a frame's displacement u takes to p, and u there:
///   X + share u(X) = p
/// share: s for the interval's first frame, s - 1 for its last. The iteration converges where
/// neighbouring points move apart or together by less than their distance.
Origin origin_of(const Octree& tree, const std::vector<BranchNodes<Vector3>>& u, const Vector3& p,
                 double share) {
  constexpr int most = 50;
  const double close = 1e-14 * tree.settings.width;
  Origin origin{p, displacement_at(tree, u, p)};
  for (int i = 0; i < most; ++i) {
    const Vector3 place = p - share * origin.displacement;
    const double moved = (place - origin.place).norm();
    origin = {place, displacement_at(tree, u, place)};
    if (moved <= close) break;
  }
  return origin;
}

DeformingPoint interpolate(const Interval& interval, const Origin& a, const Origin& b) {
  const double s = interval.part;
  const Distance before = interval.now->field.at(a.place), after = interval.next->field.at(b.place);
  const Vector3 gradient = (1 - s) * before.normal + s * after.normal;
  const double length = gradient.norm();
  return {(1 - s) * before.phi + s * after.phi,
          length > 0 ? Vector3(gradient / length) : before.normal,
          ((1 - s) * a.displacement + s * b.displacement) / interval.duration};
}

}  // namespace

DeformingPoint deforming_at(const DeformingBody& body, const Vector3& p, double t) {
  const Interval interval = interval_at(body, t);
  if (!interval.next) {
    const Distance rest = interval.now->field.at(p);
    return {rest.phi, rest.normal, Vector3::Zero()};
  }
  const auto& ahead = interval.now->to_next;
  const auto& back = interval.next->from_previous;
  const Octree &now = interval.now->field, &next = interval.next->field;
  if (body.between == BetweenFrames::blended)
    return interpolate(interval, {p, displacement_at(now, ahead, p)},
                       {p, displacement_at(next, back, p)});
  const double s = interval.part;
  return interpolate(interval, origin_of(now, ahead, p, s), origin_of(next, back, p, s - 1));
}

Vector3 advected_position(const DeformingBody& body, const Vector3& p, double start, double end) {
  Vector3 q = p;
  for (double t = start; t < end;) {
    const auto next = std::upper_bound(
        body.frames.begin(), body.frames.end(), t,
        [](double time, const DeformingFrame& frame) { return time < frame.time; });
    const double until = next == body.frames.end() ? end : std::min(end, next->time);
    q += (until - t) * deforming_at(body, q, t).velocity;
    t = until;
  }
  return q;
}

}  // namespace foldproof
