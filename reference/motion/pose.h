// Rigid motion of a body: position, orientation, and the velocity of each of its points.
#pragma once

#include <Eigen/Geometry>
#include <variant>
#include <vector>

#include "reference/motion/motion.h"
#include "reference/types.h"

namespace foldproof {

/// A rigid placement: x = R X + T for the point X of the body.
struct Pose {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  // R
  Vector3 translation = Vector3::Zero();                         // T [m]
};

Vector3 to_world(const Pose& pose, const Vector3& X);  // [m]
Vector3 to_body(const Pose& pose, const Vector3& x);   // the X of a placed x [m]
Pose after(const Pose& second, const Pose& first);     // first, then second

struct Keyframe {
  double time;  // s
  Pose pose;
};

/// Poses at given times, in ascending order: between two the translation is linear and the rotation
/// turns at a constant rate about a fixed axis, the short way (slerp). The body rests before the
/// first and after the last.
struct Keyframes {
  std::vector<Keyframe> keys;  // at least one
};

using RigidMotion = std::variant<Motion, Keyframes>;

/// Throws InputError unless there is a keyframe and the times ascend.
Keyframes make_keyframes(std::vector<Keyframe> keys);

Pose pose_at(const RigidMotion& motion, double t);

/// Velocity [m/s] at time t [s] of the body's point that is at x [m] then; at a keyframe, the
/// velocity of the interval that begins.
Vector3 velocity_at(const RigidMotion& motion, const Vector3& x, double t);

}  // namespace foldproof
