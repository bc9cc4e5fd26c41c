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
  Motion motion;
  motion.velocity = {0.31, -0.47, 0.83};
  motion.amplitude = {0.13, 0.29, -0.17};
  motion.frequency = 0.37;
  motion.phase = 0.6;
  motion.center = {0.3, -0.7, 1.9};
  motion.angular_velocity = {0.7, -1.3, 0.4};
  motion.from = 0.4;
  motion.until = 1.7;
  return motion;
}

/// Where general_motion has taken x after t seconds of acting.
Vector3 expected_position(const Vector3& x, double t) {
  const Motion m = general_motion();
  return m.center + turned(x - m.center, m.angular_velocity, m.angular_velocity.norm() * t) +
         t * m.velocity + (std::sin(2 * pi * 0.37 * t + 0.6) - std::sin(0.6)) * m.amplitude;
}

Vector3 expected_velocity(const Vector3& x, double t) {
  const Motion m = general_motion();
  return m.angular_velocity.cross(
             turned(x - m.center, m.angular_velocity, m.angular_velocity.norm() * t)) +
         m.velocity + 2 * pi * 0.37 * std::cos(2 * pi * 0.37 * t + 0.6) * m.amplitude;
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

TEST_CASE("a motion turns about its centre, drifts and swings while it acts") {
  const Motion motion = general_motion();
  CHECK(are_near(position_at(motion, start, 0.1), start));
  CHECK(are_near(position_at(motion, start, 0.9), expected_position(start, 0.9 - 0.4)));
  CHECK(are_near(position_at(motion, start, 2.3), expected_position(start, 1.7 - 0.4)));
}

TEST_CASE("the velocity of a motion is that of its turn, drift and swing") {
  const Motion motion = general_motion();
  CHECK(are_near(velocity_at(motion, start, 0.9), expected_velocity(start, 0.9 - 0.4)));
  CHECK(are_near(velocity_at(motion, start, 0.4), expected_velocity(start, 0)));
  CHECK(velocity_at(motion, start, 1.7) == Vector3::Zero());
  CHECK(velocity_at(motion, start, 0.39) == Vector3::Zero());
}

TEST_CASE("a point turns at one radian per second as at any other rate") {
  Motion motion;
  motion.center = {0.3, -0.7, 1.9};
  motion.angular_velocity = Vector3::UnitY();
  const Vector3 expected = motion.center + turned(start - motion.center, Vector3::UnitY(), 0.7);
  CHECK(are_near(position_at(motion, start, 0.7), expected));
  CHECK(are_near(to_world(pose_at(motion, 0.7), start), expected));
}

TEST_CASE("a motion is at rest unless told otherwise, from the beginning and for ever") {
  Motion motion;
  CHECK(motion.velocity == Vector3::Zero());
  CHECK(motion.amplitude == Vector3::Zero());
  CHECK(motion.center == Vector3::Zero());
  CHECK(motion.angular_velocity == Vector3::Zero());
  CHECK(motion.frequency == 0);
  CHECK(motion.phase == 0);
  CHECK(motion.from == 0);
  CHECK(motion.until == infinite);
}

TEST_CASE("an event at the time asked from is over, and what never ends has no event") {
  Motion endless, brief;
  endless.from = 0.7;
  brief.from = 0.3, brief.until = 1.9;
  const std::vector<PrescribedParticle> particles{{4, start, endless}, {7, start, brief}};
  CHECK(event_times(particles, 0.3) == std::vector<double>{0.7, 1.9});
  CHECK(event_times(particles, 0.25) == std::vector<double>{0.3, 0.7, 1.9});
  CHECK(event_times(particles, 0.8) == std::vector<double>{1.9});
  CHECK(event_times(particles, 1.9).empty());
}

TEST_CASE("before its motion a particle is continued at rest where it starts") {
  Motion motion = general_motion();
  motion.from = 0.5, motion.until = 1.75;
  const PrescribedParticle resting = smooth_continuation({5, start, motion}, 0.25, 0.125);
  CHECK(resting.particle == 5);
  CHECK(resting.start == start);
  CHECK(resting.motion.velocity == Vector3::Zero());
  CHECK(resting.motion.amplitude == Vector3::Zero());
  CHECK(resting.motion.angular_velocity == Vector3::Zero());
}

TEST_CASE("a start that is as far ahead as the tolerance counts as passed") {
  Motion motion = general_motion();
  motion.from = 0.5, motion.until = 1.75;
  const PrescribedParticle moving = smooth_continuation({5, start, motion}, 0.375, 0.125);
  CHECK(moving.particle == 5);
  CHECK(moving.start == start);
  CHECK(moving.motion.velocity == motion.velocity);
  CHECK(moving.motion.from == 0.375);  // it moves from that time on
  CHECK(moving.motion.until == infinite);
}

TEST_CASE("a motion under way goes on for ever from its own start") {
  Motion motion = general_motion();
  motion.from = 0.5, motion.until = 1.75;
  const PrescribedParticle moving = smooth_continuation({5, start, motion}, 1.5, 0.125);
  CHECK(moving.motion.from == 0.5);
  CHECK(moving.motion.until == infinite);
  CHECK(moving.motion.angular_velocity == motion.angular_velocity);
  CHECK(moving.start == start);
}

TEST_CASE("an end that is as far ahead as the tolerance leaves the particle at its last place") {
  Motion motion = general_motion();
  motion.from = 0.4, motion.until = 1.75;
  for (const double time : {1.625, 1.6875, 1.75, 2.5}) {
    const PrescribedParticle ended = smooth_continuation({5, start, motion}, time, 0.125);
    CHECK(ended.particle == 5);
    CHECK(are_near(ended.start, expected_position(start, 1.75 - 0.4)));
    CHECK(ended.motion.velocity == Vector3::Zero());
    CHECK(ended.motion.amplitude == Vector3::Zero());
  }
  CHECK(smooth_continuation({5, start, motion}, 1.5625, 0.125).motion.velocity == motion.velocity);
}

TEST_CASE("known velocities are those of each particle's own motion") {
  Motion other = general_motion();
  other.velocity = {0.9, 0.8, 0.3}, other.amplitude.setZero(), other.angular_velocity.setZero();
  const Vector3 elsewhere(-0.6, 1.4, 0.2);
  const std::vector<PrescribedParticle> prescribed{{3, start, general_motion()},
                                                   {1, elsewhere, other}};
  const std::vector<KnownVelocity> known = velocities_at(prescribed, 0.9);
  REQUIRE(known.size() == 2);
  CHECK(known[0].particle == 3);
  CHECK(are_near(known[0].velocity, expected_velocity(start, 0.5)));
  CHECK(known[1].particle == 1);
  CHECK(are_near(known[1].velocity, other.velocity));

  PerParticle3 v = PerParticle3::Constant(3, 5, 0.27);
  impose(known, v);
  CHECK(v.col(3) == known[0].velocity);
  CHECK(v.col(1) == known[1].velocity);
  for (const int free : {0, 2, 4}) CHECK(v.col(free) == Vector3::Constant(0.27));
}

TEST_CASE("a mean velocity takes a particle from where it is to where it has to be") {
  PerParticle3 x(3, 3);
  x << 0.7, 0.3, 0.2, -0.4, 1.6, 0.5, 0.1, 0.8, -0.9;
  const double t = 0.6, h = 0.35;
  const std::vector<KnownVelocity> known =
      mean_velocities({{2, start, general_motion()}, {0, 2 * start, general_motion()}}, x, t, h);
  REQUIRE(known.size() == 2);
  CHECK(known[0].particle == 2);
  CHECK(are_near(x.col(2) + h * known[0].velocity, expected_position(start, t + h - 0.4)));
  CHECK(known[1].particle == 0);
  CHECK(are_near(x.col(0) + h * known[1].velocity, expected_position(2 * start, t + h - 0.4)));
}

TEST_CASE("a pose turns, then shifts, and is undone in reverse") {
  const Pose pose{rotation_by(hinge, 1.1), first_place};
  CHECK(are_near(to_world(pose, start), turned(start, hinge, 1.1) + first_place));
  CHECK(are_near(to_body(pose, to_world(pose, start)), start));
  CHECK(are_near(to_body(pose, start), turned(start - first_place, hinge, -1.1)));
  CHECK(are_near(to_world(Pose{}, start), start));
  CHECK(Pose{}.translation == Vector3::Zero());
}

TEST_CASE("of two poses the first acts first") {
  const Pose first{rotation_by(hinge, 1.1), first_place},
      second{rotation_by(tilt, -0.7), second_place};
  const Vector3 expected =
      turned(turned(start, hinge, 1.1) + first_place, tilt, -0.7) + second_place;
  CHECK(are_near(to_world(after(second, first), start), expected));
}

TEST_CASE("the pose of a motion takes each point where the motion takes it") {
  for (const double time : {0.1, 0.9, 2.3}) {
    const Pose pose = pose_at(general_motion(), time);
    const double acted = time < 0.4 ? 0 : std::min(time, 1.7) - 0.4;
    CHECK(are_near(to_world(pose, start), expected_position(start, acted)));
    CHECK(are_near(to_world(pose, first_place), expected_position(first_place, acted)));
  }
}

TEST_CASE("the velocity of a moved body is that of its point at the place asked for") {
  const Vector3 x = expected_position(start, 0.5);
  CHECK(
      are_near(velocity_at(RigidMotion(general_motion()), x, 0.9), expected_velocity(start, 0.5)));
  CHECK(velocity_at(RigidMotion(general_motion()), x, 1.9) == Vector3::Zero());
}

TEST_CASE("between keyframes a body turns evenly about one axis and moves in a straight line") {
  const Keyframes keys = three_keys();
  const double part = (0.45 - 0.3) / (0.9 - 0.3);
  const Vector3 expected = turned(turned(start, tilt, 0.8), hinge, part * 1.1) + first_place +
                           part * (second_place - first_place);
  CHECK(are_near(to_world(pose_at(keys, 0.45), start), expected));
  const double later = (2.1 - 0.9) / (2.4 - 0.9);
  const Vector3 wanted = turned(turned(turned(start, tilt, 0.8), hinge, 1.1), tilt, later * -0.7) +
                         second_place + later * (third_place - second_place);
  CHECK(are_near(to_world(pose_at(keys, 2.1), start), wanted));
}

TEST_CASE("between keyframes the velocity is that of the turn and of the line") {
  const Keyframes keys = three_keys();
  const auto expected = [&](double part) {
    const Vector3 origin = first_place + part * (second_place - first_place);
    return Vector3((1.1 / 0.6 * hinge.normalized()).cross(start - origin) +
                   (second_place - first_place) / 0.6);
  };
  CHECK(are_near(velocity_at(keys, start, 0.45), expected(0.25)));
  CHECK(are_near(velocity_at(keys, start, 0.3), expected(0)));  // that of the interval that begins
  const Vector3 next = (-0.7 / 1.5 * tilt.normalized()).cross(start - second_place) +
                       (third_place - second_place) / 1.5;
  CHECK(are_near(velocity_at(keys, start, 0.9), next));
}

TEST_CASE("before the first keyframe and from the last one on a body rests") {
  const Keyframes keys = three_keys();
  const Vector3 first = turned(start, tilt, 0.8) + first_place,
                last =
                    turned(turned(turned(start, tilt, 0.8), hinge, 1.1), tilt, -0.7) + third_place;
  CHECK(are_near(to_world(pose_at(keys, 0.1), start), first));
  CHECK(are_near(to_world(pose_at(keys, 0.3), start), first));
  CHECK(are_near(to_world(pose_at(keys, 2.4), start), last));
  CHECK(are_near(to_world(pose_at(keys, 3.7), start), last));
  for (const double time : {0.1, 2.4, 3.7})
    CHECK(velocity_at(keys, start, time) == Vector3::Zero());
  const Keyframes only = make_keyframes({{0.6, {rotation_by(tilt, 0.8), first_place}}});
  for (const double time : {0.1, 0.6, 0.9}) {
    CHECK(are_near(to_world(pose_at(only, time), start), first));
    CHECK(velocity_at(only, start, time) == Vector3::Zero());
  }
}

TEST_CASE("a turn between keyframes takes the short way, whichever sign its quaternions have") {
  Keyframes keys = three_keys();
  const Pose pose = pose_at(keys, 0.45);
  const Vector3 velocity = velocity_at(keys, start, 0.45);
  keys.keys[1].pose.rotation.coeffs() *= -1;
  CHECK(are_near(to_world(pose_at(keys, 0.45), start), to_world(pose, start)));
  CHECK(are_near(velocity_at(keys, start, 0.45), velocity));
  // by 4.1 rad one way is by 2.18 rad the other
  const Keyframes wide = make_keyframes(
      {{0.3, {rotation_by(tilt, 0), first_place}}, {0.9, {rotation_by(tilt, 4.1), first_place}}});
  CHECK(are_near(to_world(pose_at(wide, 0.45), start),
                 turned(start, tilt, 0.25 * (4.1 - 2 * pi)) + first_place));
}

TEST_CASE("half a turn between keyframes is about the axis that its quaternion gives") {
  const Keyframes half =
      make_keyframes({{0.3, {{1, 0, 0, 0}, first_place}}, {0.9, {{0, 0.6, 0, 0.8}, first_place}}});
  CHECK(are_near(to_world(pose_at(half, 0.45), start),
                 turned(start, {0.6, 0, 0.8}, pi / 4) + first_place));
}

TEST_CASE("times of keyframes must rise, and the first one that does not is named") {
  const auto keys_at = [](const std::vector<double>& times) {
    std::vector<Keyframe> keys;
    for (const double time : times) keys.push_back({time, {}});
    return keys;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(make_keyframes({}), "a keyframed motion needs at least one keyframe");
  CHECK_THROWS_WITH(make_keyframes(keys_at({0.3, 0.3})),
                    "keyframe 1: the times of keyframes must rise");
  CHECK_THROWS_WITH(make_keyframes(keys_at({0.3, 0.2, 0.9})),
                    "keyframe 1: the times of keyframes must rise");
  CHECK_THROWS_WITH(make_keyframes(keys_at({0.3, 0.7, 0.5})),
                    "keyframe 2: the times of keyframes must rise");
  CHECK_THROWS_AS(make_keyframes(keys_at({0.3, nan})), InputError);
  CHECK(make_keyframes(keys_at({0.3, 0.300001, 0.7})).keys.size() == 3);
}

TEST_CASE("every keyframe's rotation is normalised and its place kept") {
  std::vector<Keyframe> keys = three_keys().keys;
  for (Keyframe& key : keys) key.pose.rotation.coeffs() *= 3;
  const Keyframes made = make_keyframes(keys);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    CHECK(made.keys[i].pose.rotation.norm() == Approx(1).epsilon(1e-15));
    CHECK(made.keys[i].pose.translation == keys[i].pose.translation);
    CHECK(made.keys[i].time == keys[i].time);
  }
}

TEST_CASE("a body that does not turn stays in its place, wherever its centre is") {
  Motion motion;
  motion.center = {0.3, -0.7, 1.9};
  const Vector3 start(2.1, 0.4, -0.8);
  CHECK((position_at(motion, start, 3.7) - start).norm() < 1e-15);
  CHECK(velocity_at(motion, start, 3.7) == Vector3::Zero());
  const Pose pose = pose_at(motion, 3.7);
  CHECK(pose.translation.norm() < 1e-15);
  CHECK((to_world(pose, start) - start).norm() < 1e-15);
  motion.velocity = {0, 0.5, 0};
  CHECK((position_at(motion, start, 2) - start - Vector3(0, 1, 0)).norm() < 1e-15);
}

TEST_CASE("the events of prescribed particles ascend, each once, without those that are over") {
  Motion late, early;
  late.from = 0.7, late.until = 1.9;
  early.from = 0.3, early.until = 0.7;
  const std::vector<PrescribedParticle> particles{{4, Vector3::Zero(), late},
                                                  {7, Vector3::Zero(), early}};
  CHECK(event_times(particles, 0.3) == std::vector<double>{0.7, 1.9});
  CHECK(event_times(particles, 0.1) == std::vector<double>{0.3, 0.7, 1.9});
}

TEST_CASE("prescribed motion has no velocity before it begins and from its end on") {
  Motion motion;
  motion.from = 0.3, motion.until = 0.7;
  motion.velocity = {1, 0, 0};
  for (const double time : {0.1, 0.7, 0.9})
    CHECK(velocity_at(motion, Vector3(1, 2, 3), time) == Vector3::Zero());
  for (const double time : {0.3, 0.5})
    CHECK(velocity_at(motion, Vector3(1, 2, 3), time) == motion.velocity);
}

TEST_CASE("rotations of keyframes are normalised") {
  Keyframe key{0, {}};
  key.pose.rotation.coeffs() *= 2;
  CHECK(make_keyframes({key}).keys[0].pose.rotation.norm() == 1);
}
