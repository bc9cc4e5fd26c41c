#include "reference/level_set/object.h"

#include <utility>

namespace foldproof {

ObjectPoint RigidObject::at(const Vector3& p, const Span& span) const {
  const Pose pose = pose_at(motion, span.start);
  const Pose now = after(pose, place);
  const Distance distance = distance_to(solid, unplaced(now, p));
  ObjectPoint point{distance.phi, now.rotation * distance.normal, velocity_at(motion, p, span.start)};
  if (span.end > span.start) {
    const Vector3 carried = placed(pose_at(motion, span.end), unplaced(pose, p));
    point.velocity = (carried - p) / (span.end - span.start);
  }
  return point;
}

namespace {

void enter(ObjectPoint point, Nearest& nearest) {
  if (point.phi < 0) ++nearest.inside;
  if (point.phi < nearest.first.phi) std::swap(point, nearest.first);
  if (point.phi < nearest.second.phi) std::swap(point, nearest.second);
}

}  // namespace

ObjectPoint DeformingObject::at(const Vector3& p, const Span& span) const {
  const DeformingPoint now = deforming_at(*body, p, span.start);
  ObjectPoint point{now.phi, now.normal, now.velocity};
  if (span.end > span.start)
    point.velocity = (carried_along(*body, p, span.start, span.end) - p) / (span.end - span.start);
  return point;
}

Nearest nearest_of(std::span<const ObjectPoint> points) {
  Nearest nearest;
  for (const ObjectPoint& point : points) enter(point, nearest);
  return nearest;
}

Nearest nearest_objects(std::span<const Object> objects, const Vector3& p, const Span& span) {
  Nearest nearest;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    ObjectPoint point = std::visit([&](const auto& body) { return body.at(p, span); }, objects[i].body);
    point.part = int(i);
    enter(point, nearest);
  }
  return nearest;
}

}  // namespace foldproof
