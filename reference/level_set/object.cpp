#include "reference/level_set/object.h"

#include <cmath>
#include <utility>

namespace foldproof {

namespace {

// phi changes by no more than this per distance: a distance by 1. Each slope of its trilinear interpolant
// along an axis is a mean of differences along edges of the cell, at most 1, so that all three make sqrt(3)
// at most. Nodes that miss the distance by e (they hang, or marching missed) add 2 e/width to a slope: 2 is
// enough for e = 0.077 widths.
constexpr double steepest = 2;

}  // namespace

RigidDuring RigidObject::during(const Span& span) const {
  const Pose pose = pose_at(motion, span.start);
  const Pose now = after(pose, place);
  const Eigen::Matrix3d turned = now.rotation.toRotationMatrix();
  RigidDuring during{&solid, turned, turned.transpose(), now.translation, {}, {}, pose.translation};
  if (span.end > span.start) {
    const Pose end = pose_at(motion, span.end);
    const Eigen::Matrix3d turn = (end.rotation * pose.rotation.conjugate()).toRotationMatrix();
    during.spin = (turn - Eigen::Matrix3d::Identity()) / (span.end - span.start);
    during.drift = (end.translation - pose.translation) / (span.end - span.start);
  } else {
    during.drift = velocity_at(motion, during.pivot, span.start);
    for (int axis = 0; axis < 3; ++axis)
      during.spin.col(axis) =
          velocity_at(motion, during.pivot + Vector3::Unit(axis), span.start) - during.drift;
  }
  return during;
}

ObjectPoint RigidDuring::at(const Vector3& p) const {
  // by columns: pairs of coordinates are written at once, as they are read; of single ones the reader would
  // wait
  const Vector3 away = p - moved;
  const Distance distance =
      distance_to(*solid, back.col(0) * away.x() + back.col(1) * away.y() + back.col(2) * away.z());
  return {distance.phi, turned * distance.normal, velocity_at(p)};
}

namespace {

void enter(ObjectPoint point, Nearest& nearest) {
  if (point.phi < 0) ++nearest.inside;
  if (point.phi < nearest.first.phi) std::swap(point, nearest.first);
  if (point.phi < nearest.second.phi) std::swap(point, nearest.second);
}

}  // namespace

ObjectPoint DeformingDuring::at(const Vector3& p) const {
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

ObjectsDuring::ObjectsDuring(std::span<const Object> objects, const Span& span) : answers_(objects.size()) {
  for (const Object& object : objects)
    std::visit([&](const auto& body) { bodies_.emplace_back(body.during(span)); }, object.body);
  for (std::size_t i = 0; i < objects.size(); ++i) friction_.push_back(objects[i].friction);
}

std::span<ObjectPoint> ObjectsDuring::at(const Vector3& p) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    answers_[i] = std::visit([&](const auto& body) { return body.at(p); }, bodies_[i]);
    answers_[i].part = int(i);
    answers_[i].friction = friction_[i];
  }
  asked_ = p;
  return answers_;
}

bool ObjectsDuring::out_of_reach(const Vector3& p, const Vector3& v, double time) const {
  const double moved = steepest * (p - asked_).norm();  // NaN before the first question
  for (const ObjectPoint& answer : answers_) {          // in whatever order it was put since
    const double room = answer.phi - moved;             // m, at least
    if (!(room > 0) || std::isinf(room)) return false;
    const auto& body = bodies_[std::size_t(answer.part)];
    const double squared_speed =
        std::visit([&](const auto& during) { return during.squared_speed_past(p, v); }, body);
    if (!(room * room > time * time * squared_speed)) return false;
  }
  return true;
}

Nearest nearest_objects(std::span<const Object> objects, const Vector3& p, const Span& span) {
  return nearest_of(ObjectsDuring(objects, span).at(p));
}

}  // namespace foldproof
