#include "reference/level_set/object.h"

#include <cmath>
#include <utility>

namespace foldproof {

RigidOverSpan RigidObject::over(const Span& span) const {
  const Pose pose = pose_at(motion, span.start);
  const Pose now = after(pose, place);
  const Eigen::Matrix3d rotation = now.rotation.toRotationMatrix();
  RigidOverSpan over{&solid, rotation, rotation.transpose(), now.translation,
                     {},     {},       pose.translation};
  if (span.end > span.start) {
    const Pose end = pose_at(motion, span.end);
    const Eigen::Matrix3d turn = (end.rotation * pose.rotation.conjugate()).toRotationMatrix();
    over.spin = (turn - Eigen::Matrix3d::Identity()) / (span.end - span.start);
    over.drift = (end.translation - pose.translation) / (span.end - span.start);
  } else {
    over.drift = velocity_at(motion, over.pivot, span.start);
    for (int axis = 0; axis < 3; ++axis)
      over.spin.col(axis) =
          velocity_at(motion, over.pivot + Vector3::Unit(axis), span.start) - over.drift;
  }
  return over;
}

ObjectPoint RigidOverSpan::at(const Vector3& p) const {
  // by columns: coordinates are written in pairs, as they are read; single writes would stall the
  // read
  const Vector3 away = p - translation;
  const Distance distance =
      distance_to(*solid, inverse_rotation.col(0) * away.x() + inverse_rotation.col(1) * away.y() +
                              inverse_rotation.col(2) * away.z());
  return {distance.phi, rotation * distance.normal, velocity_at(p)};
}

namespace {

void record(ObjectPoint point, Nearest& nearest) {
  if (point.phi < 0) ++nearest.inside;
  if (point.phi < nearest.first.phi) std::swap(point, nearest.first);
  if (point.phi < nearest.second.phi) std::swap(point, nearest.second);
}

}  // namespace

ObjectPoint DeformingOverSpan::at(const Vector3& p) const {
  const DeformingPoint now = deforming_at(*body, p, span.start);
  ObjectPoint point{now.phi, now.normal, now.velocity};
  if (span.end > span.start)
    point.velocity =
        (advected_position(*body, p, span.start, span.end) - p) / (span.end - span.start);
  return point;
}

bool face_each_other(const ObjectPoint& a, const ObjectPoint& b) {
  constexpr double cosine = -0.5;  // of 120 degrees
  return a.normal.dot(b.normal) < cosine;
}

Nearest nearest_of(std::span<const ObjectPoint> points) {
  Nearest nearest;
  for (const ObjectPoint& point : points) record(point, nearest);
  return nearest;
}

ObjectsOverSpan::ObjectsOverSpan(std::span<const Object> objects, const Span& span)
    : answers_(objects.size()) {
  for (const Object& object : objects)
    std::visit([&](const auto& body) { bodies_.emplace_back(body.over(span)); }, object.body);
  for (std::size_t i = 0; i < objects.size(); ++i) friction_.push_back(objects[i].friction);
}

std::span<ObjectPoint> ObjectsOverSpan::at(const Vector3& p) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    answers_[i] = std::visit([&](const auto& body) { return body.at(p); }, bodies_[i]);
    answers_[i].part = int(i);
    answers_[i].friction = friction_[i];
  }
  return answers_;
}

Nearest nearest_objects(std::span<const Object> objects, const Vector3& p, const Span& span) {
  return nearest_of(ObjectsOverSpan(objects, span).at(p));
}

}  // namespace foldproof
