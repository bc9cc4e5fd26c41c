// Prescribed motion and poses of rigid bodies against formulas written out here, and their limits.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "reference/motion/pose.h"

using namespace foldproof;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
const Vector3 start(2.1, 0.4, -0.8);  // m

/// x turned about the direction of `axis` by `angle` [rad], by Rodrigues' formula.
Vector3 turned(const Vector3& x, const Vector3& axis, double angle) {
  const Vector3 n = axis.normalized();
  return std::cos(angle) * x + std::sin(angle) * n.cross(x) + (1 - std::cos(angle)) * n.dot(x) * n;
}

/// Turns, drifts and swings from 0.4 s to 1.7 s.
Motion general_motion() {
  return {{0.31, -0.47, 0.83}, {0.13, 0.29, -0.17}, 0.37, 0.6,
          {0.3, -0.7, 1.9},    {0.7, -1.3, 0.4},    0.4,  1.7};
}

/// The arm from the centre of general_motion to x after t seconds of acting.
Vector3 arm_after(const Vector3& x, double t) {
  const Motion m = general_motion();
  return turned(x - m.center, m.angular_velocity, m.angular_velocity.norm() * t);
}

Vector3 expected_position(const Vector3& x, double t) {
  const Motion m = general_motion();
  return m.center + arm_after(x, t) + t * m.velocity +
         (std::sin(2 * pi * 0.37 * t + 0.6) - std::sin(0.6)) * m.amplitude;
}

bool are_near(const Vector3& a, const Vector3& b) { return (a - b).norm() < 1e-14; }

/// A quaternion that turns about `axis` by `angle` [rad].
Eigen::Quaterniond rotation_by(const Vector3& axis, double angle) {
  const Vector3 n = std::sin(angle / 2) * axis.normalized();
  return {std::cos(angle / 2), n.x(), n.y(), n.z()};
}

const Vector3 tilt(0.2, 0.9, -0.5), hinge(-0.6, 0.3, 0.7);  // axes
const Vector3 first_place(0.4, -1.1, 0.7), second_place(1.3, 0.2, -0.9),
    third_place(-0.8, 0.6, 2.3);

/// Key times 0.3, 0.9 and 2.4 s; turns by 1.1 rad about `hinge`, then by -0.7 rad about `tilt`.
Keyframes three_keys() {
  const Eigen::Quaterniond first = rotation_by(tilt, 0.8), second = rotation_by(hinge, 1.1) * first,
                           third = rotation_by(tilt, -0.7) * second;
  return make_keyframes(
      {{0.3, {first, first_place}}, {0.9, {second, second_place}}, {2.4, {third, third_place}}});
}

}  // namespace

TEST_CASE("a start that is as far ahead as the tolerance counts as passed") {
  Motion motion = general_motion();
  motion.from = 0.5, motion.until = 1.75;
  const PrescribedParticle moving = smooth_continuation({5, start, motion}, 0.375, 0.125);
  CHECK(moving.particle == 5);
  CHECK(moving.start == start);
  CHECK(moving.motion.velocity == motion.velocity);
  CHECK(moving.motion.from == 0.375);  // it moves from that time on
  CHECK(moving.motion.until == infinite);
  CHECK(smooth_continuation({5, start, motion}, 1.5, 0.125).motion.from == 0.5);
  // and so does an end
  CHECK(smooth_continuation({5, start, motion}, 1.5625, 0.125).motion.velocity == motion.velocity);
  motion.from = 0.4;
  const PrescribedParticle ended = smooth_continuation({5, start, motion}, 1.625, 0.125);
  CHECK(are_near(ended.start, expected_position(start, 1.75 - 0.4)));
  CHECK(ended.motion.velocity == Vector3::Zero());
}

TEST_CASE("a turn between keyframes takes the short way, whichever sign its quaternions have") {
  Keyframes keys = three_keys();
  const Vector3 place = to_world(pose_at(keys, 0.45), start),
                velocity = velocity_at(keys, start, 0.45);
  keys.keys[1].pose.rotation.coeffs() *= -1;
  CHECK(are_near(to_world(pose_at(keys, 0.45), start), place));
  CHECK(are_near(velocity_at(keys, start, 0.45), velocity));
  // by 4.1 rad one way is by 2.18 rad the other; half a turn is about the axis that is given
  const auto place_after_turn = [](const Eigen::Quaterniond& to) {
    const Keyframes two = make_keyframes({{0.3, {}}, {0.9, {to, Vector3::Zero()}}});
    return to_world(pose_at(two, 0.45), start);
  };
  CHECK(are_near(place_after_turn(rotation_by(tilt, 4.1)),
                 turned(start, tilt, 0.25 * (4.1 - 2 * pi))));
  CHECK(are_near(place_after_turn({0, 0.6, 0, 0.8}), turned(start, {0.6, 0, 0.8}, pi / 4)));
}

TEST_CASE("a body that does not turn stays in its place, wherever its centre is") {
  Motion motion;
  motion.center = {0.3, -0.7, 1.9};
  CHECK((position_at(motion, start, 3.7) - start).norm() < 1e-15);
  CHECK(velocity_at(motion, start, 3.7) == Vector3::Zero());
  CHECK(pose_at(motion, 3.7).translation.norm() < 1e-15);
  CHECK((to_world(pose_at(motion, 3.7), start) - start).norm() < 1e-15);
  motion.velocity = {0, 0.5, 0};
  CHECK((position_at(motion, start, 2) - start - Vector3(0, 1, 0)).norm() < 1e-15);
}

TEST_CASE("the events of prescribed particles ascend, each once, without those that are over") {
  Motion late, early;
  late.from = 0.7, late.until = 1.9;
  early.from = 0.3, early.until = 0.7;
  const std::vector<PrescribedParticle> particles{
      {4, start, late}, {7, start, early}, {9, start, {}}};
  CHECK(event_times(particles, 0.3) == std::vector<double>{0.7, 1.9});
  CHECK(event_times(particles, 0.1) == std::vector<double>{0.3, 0.7, 1.9});
  CHECK(event_times(particles, 1.9).empty());  // and some motions never end
}
