#include "reference/motion/pose.h"

#include <algorithm>

namespace foldproof {

namespace {

/// The keyframe interval that holds t, and the fraction of it at t.
struct Interval {
  const Keyframe *from, *to;
  double part;  // 0 at `from`, 1 at `to`
};

/// Empty pointers where the body rests: `from` then is the nearest keyframe.
Interval interval_at(const Keyframes& motion, double t) {
  const std::vector<Keyframe>& keys = motion.keys;
  const auto next =
      std::upper_bound(keys.begin(), keys.end(), t,
                       [](double time, const Keyframe& key) { return time < key.time; });
  if (next == keys.begin()) return {&keys.front(), nullptr, 0};
  if (next == keys.end()) return {&keys.back(), nullptr, 0};
  const Keyframe& from = *(next - 1);
  return {&from, &*next, (t - from.time) / (next->time - from.time)};
}

/// The rotation from one keyframe to the next, the short way: Eigen's angle is at most pi.
Eigen::AngleAxisd turn(const Keyframe& from, const Keyframe& to) {
  return Eigen::AngleAxisd(to.pose.rotation * from.pose.rotation.conjugate());
}

Pose pose_of(const Motion& motion, double t) {
  const Vector3 origin = position_at(motion, Vector3::Zero(), t);
  const double rate = motion.angular_velocity.norm();
  if (rate == 0) return {Eigen::Quaterniond::Identity(), origin};
  const double acted = std::clamp(t, motion.from, motion.until) - motion.from;
  return {Eigen::Quaterniond(Eigen::AngleAxisd(rate * acted, motion.angular_velocity / rate)),
          origin};
}

Pose pose_of(const Keyframes& motion, double t) {
  const auto [from, to, part] = interval_at(motion, t);
  if (!to) return from->pose;
  const Eigen::AngleAxisd whole = turn(*from, *to);
  const Eigen::Quaterniond partial(Eigen::AngleAxisd(part * whole.angle(), whole.axis()));
  return {partial * from->pose.rotation,
          (1 - part) * from->pose.translation + part * to->pose.translation};
}

Vector3 velocity_of(const Motion& motion, const Vector3& x, double t) {
  return velocity_at(motion, to_body(pose_of(motion, t), x), t);
}

Vector3 velocity_of(const Keyframes& motion, const Vector3& x, double t) {
  const auto [from, to, part] = interval_at(motion, t);
  if (!to) return Vector3::Zero();
  const double duration = to->time - from->time;
  const Eigen::AngleAxisd whole = turn(*from, *to);
  const Vector3 angular_velocity = whole.angle() / duration * whole.axis();
  const Vector3 origin = pose_of(motion, t).translation;
  return angular_velocity.cross(x - origin) +
         (to->pose.translation - from->pose.translation) / duration;
}

}  // namespace

Vector3 to_world(const Pose& pose, const Vector3& X) {
  return pose.rotation * X + pose.translation;
}

Vector3 to_body(const Pose& pose, const Vector3& x) {
  return pose.rotation.conjugate() * (x - pose.translation);
}

Pose after(const Pose& second, const Pose& first) {
  return {second.rotation * first.rotation, to_world(second, first.translation)};
}

Keyframes make_keyframes(std::vector<Keyframe> keys) {
  if (keys.empty()) throw InputError("a keyframed motion needs at least one keyframe");
  for (std::size_t i = 1; i < keys.size(); ++i)
    if (!(keys[i].time > keys[i - 1].time))
      throw InputError("keyframe " + std::to_string(i) + ": the times of keyframes must rise");
  for (Keyframe& key : keys) key.pose.rotation.normalize();
  return {std::move(keys)};
}

Pose pose_at(const RigidMotion& motion, double t) {
  return std::visit([&](const auto& m) { return pose_of(m, t); }, motion);
}

Vector3 velocity_at(const RigidMotion& motion, const Vector3& x, double t) {
  return std::visit([&](const auto& m) { return velocity_of(m, x, t); }, motion);
}

}  // namespace foldproof
