// Prescribed motion, of particles and of bodies.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>

#include "reference/motion/motion.h"
#include "reference/motion/pose.h"

using namespace foldproof;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Turns about an axis along z through (0.3, -0.2, 5), drifts and swings, from 0.5 s to 2.5 s.
Motion motion_of_all_kinds() {
  Motion motion;
  motion.velocity = {0.7, -0.4, 1.1};
  motion.amplitude = {0.05, 0.6, -0.3};
  motion.frequency = 0.35;
  motion.phase = 0.9;
  motion.center = {0.3, -0.2, 5};
  motion.angular_velocity = {0, 0, 1.7};
  motion.from = 0.5;
  motion.until = 2.5;
  return motion;
}

/// The same written out for its axis; t from its start [s].
Vector3 written_out(const Vector3& start, double t) {
  const double c = std::cos(1.7 * t), s = std::sin(1.7 * t);
  const double x = start.x() - 0.3, y = start.y() + 0.2;
  const double swing = std::sin(2 * std::acos(-1.0) * 0.35 * t + 0.9) - std::sin(0.9);
  return {0.3 + c * x - s * y + 0.7 * t + 0.05 * swing,
          -0.2 + s * x + c * y - 0.4 * t + 0.6 * swing, start.z() + 1.1 * t - 0.3 * swing};
}

const Vector3 start(1.3, 0.8, -0.6);

Vector3 slope(const std::function<Vector3(double)>& x, double t) {
  const double h = 1e-5;
  return (x(t + h) - x(t - h)) / (2 * h);
}

}  // namespace

TEST_CASE("motion: a point turns, drifts and swings while the motion acts, and rests else") {
  const Motion motion = motion_of_all_kinds();
  for (const double t : {0.5, 0.8, 1.9, 2.5})
    CHECK((position_at(motion, start, t) - written_out(start, t - 0.5)).norm() < 1e-14);
  CHECK((position_at(motion, start, 0.2) - start).norm() < 1e-15);
  CHECK((position_at(motion, start, 7) - written_out(start, 2)).norm() < 1e-14);
}

TEST_CASE(
    "motion: the velocity is the slope of the path, the later one where the path has a kink") {
  const Motion motion = motion_of_all_kinds();
  const auto path = [&](double t) { return written_out(start, t - 0.5); };
  for (const double t : {0.5, 0.51, 1.3, 2.49})
    CHECK((velocity_at(motion, start, t) - slope(path, t)).norm() < 1e-8);
  for (const double t : {0.0, 0.499, 2.5, 3.0})
    CHECK(velocity_at(motion, start, t) == Vector3::Zero());
}

TEST_CASE("motion: by default a point is held for ever") {
  CHECK(position_at({}, start, 3) == start);
  CHECK(Motion{}.from == 0);
  CHECK(Motion{}.until == infinity);
  Motion drift;
  drift.velocity = {0, 2, 0};
  CHECK(position_at(drift, start, 4) == start + Vector3(0, 8, 0));
  CHECK(velocity_at(drift, start, 4) == drift.velocity);
}

TEST_CASE("motion: its continuation is smooth across the next event") {
  const PrescribedParticle particle{7, start, motion_of_all_kinds()};
  const auto at = [](const PrescribedParticle& p, double t) {
    return position_at(p.motion, p.start, t);
  };
  const PrescribedParticle before = smooth_continuation(particle, 0.3, 0.01);
  CHECK(before.particle == 7);
  CHECK(at(before, 1.9) == start);  // rests on
  const PrescribedParticle within = smooth_continuation(particle, 1.0, 0.01);
  CHECK(within.particle == 7);
  CHECK((at(within, 4) - written_out(start, 3.5)).norm() < 1e-14);  // goes on
  CHECK(within.motion.from == 0.5);
  CHECK(within.motion.until == infinity);
  const PrescribedParticle after = smooth_continuation(particle, 2.6, 0.01);
  CHECK(after.particle == 7);
  CHECK((at(after, 9) - written_out(start, 2)).norm() < 1e-14);  // rests at its end
}

TEST_CASE("motion: an event as little as the tolerance ahead counts as passed") {
  const PrescribedParticle particle{7, start, motion_of_all_kinds()};
  const double tolerance = 0.125;  // sums with the times are exact
  const auto has_begun = [&](double t) {
    return smooth_continuation(particle, t, tolerance).motion.until == infinity &&
           smooth_continuation(particle, t, tolerance).motion.velocity == particle.motion.velocity;
  };
  CHECK_FALSE(has_begun(0.25));
  CHECK(has_begun(0.375));
  CHECK(smooth_continuation(particle, 0.375, tolerance).motion.from == 0.375);
  CHECK(has_begun(2.25));
  CHECK_FALSE(has_begun(2.375));
  const PrescribedParticle ended = smooth_continuation(particle, 2.375, tolerance);
  CHECK((ended.start - written_out(start, 2)).norm() < 1e-14);
}

TEST_CASE("motion: known velocities belong to their particles") {
  Motion drift;
  drift.velocity = {0, 2, 0};
  const std::vector<PrescribedParticle> particles{{2, start, motion_of_all_kinds()},
                                                  {0, 2 * start, drift}};
  const std::vector<KnownVelocity> now = velocities_at(particles, 1.1);
  REQUIRE(now.size() == 2);
  CHECK(now[0].particle == 2);
  CHECK(now[0].velocity == velocity_at(particles[0].motion, start, 1.1));
  CHECK(now[1].velocity == drift.velocity);

  PerParticle3 x = PerParticle3::Constant(3, 3, 0.4);
  const std::vector<KnownVelocity> mean = mean_velocities(particles, x, 1.1, 0.3);
  REQUIRE(mean.size() == 2);
  CHECK(mean[0].particle == 2);
  CHECK((x.col(2) + 0.3 * mean[0].velocity - written_out(start, 0.9)).norm() < 1e-14);
  CHECK((x.col(0) + 0.3 * mean[1].velocity - 2 * start - Vector3(0, 2.8, 0)).norm() < 1e-14);

  PerParticle3 v = PerParticle3::Constant(3, 3, 9);
  impose(now, v);
  CHECK(v.col(2) == now[0].velocity);
  CHECK(v.col(0) == drift.velocity);
  CHECK(v.col(1) == Vector3::Constant(9));
}

// ----
// bodies --------------------------------------------------------------------------------------

namespace {

const Vector3 axis = Vector3(1, 2, -2) / 3;
Eigen::Quaterniond turned_by(double angle) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis));
}

/// Turns by 0.4 and then by 1.2 more about one axis; the second rotation is given by its opposite
/// quaternion, twice as long.
Keyframes three_keys() {
  Eigen::Quaterniond second = turned_by(0.4);
  second.coeffs() *= -2;
  return make_keyframes({{1.0, {Eigen::Quaterniond::Identity(), {0.5, -1, 2}}},
                         {1.5, {second, {1.5, 1, 2.5}}},
                         {3.5, {turned_by(1.6), {-2.5, 0, 4}}}});
}

void require_pose(const Pose& pose, double angle, const Vector3& translation) {
  CHECK((pose.rotation.toRotationMatrix() - turned_by(angle).toRotationMatrix()).norm() < 1e-14);
  CHECK((pose.translation - translation).norm() < 1e-14);
}

}  // namespace

TEST_CASE("pose: between keyframes a body shifts and turns evenly, the short way") {
  const RigidMotion motion = three_keys();
  require_pose(pose_at(motion, 0.2), 0, {0.5, -1, 2});
  require_pose(pose_at(motion, 1), 0, {0.5, -1, 2});
  require_pose(pose_at(motion, 1.125), 0.1, {0.75, -0.5, 2.125});
  require_pose(pose_at(motion, 1.5), 0.4, {1.5, 1, 2.5});
  require_pose(pose_at(motion, 3), 1.3, {-1.5, 0.25, 3.625});
  require_pose(pose_at(motion, 3.5), 1.6, {-2.5, 0, 4});
  require_pose(pose_at(motion, 9), 1.6, {-2.5, 0, 4});
}

TEST_CASE(
    "pose: the velocity of a body's point is the slope of its path, at a keyframe the later") {
  const RigidMotion keyed = three_keys(), free = motion_of_all_kinds();
  const Vector3 X(0.7, -0.3, 0.9);
  for (const RigidMotion& motion : {keyed, free}) {
    const auto path = [&](double t) { return to_world(pose_at(motion, t), X); };
    for (const double t : {1.2, 1.49, 1.9, 2.3})
      CHECK((velocity_at(motion, path(t), t) - slope(path, t)).norm() < 1e-8);
  }
  const auto path = [&](double t) { return to_world(pose_at(keyed, t), X); };
  for (const double t : {1.0, 1.5})
    CHECK((velocity_at(keyed, path(t), t) - slope(path, t + 2e-5)).norm() < 1e-3);
  for (const double t : {0.9, 3.5, 4.0}) CHECK(velocity_at(keyed, path(t), t) == Vector3::Zero());
}

TEST_CASE("pose: a body moves as each of its points does") {
  const Motion motion = motion_of_all_kinds();
  for (const double t : {0.1, 0.9, 2.2, 4.0}) {
    CHECK((to_world(pose_at(motion, t), start) - position_at(motion, start, t)).norm() < 1e-14);
    CHECK((velocity_at(RigidMotion(motion), position_at(motion, start, t), t) -
           velocity_at(motion, start, t))
              .norm() < 1e-14);
  }
}

TEST_CASE("pose: there and back, and one after the other") {
  const Pose a{turned_by(0.8), {1, -2, 0.5}},
      b{Eigen::Quaterniond(Eigen::AngleAxisd(-1.1, Vector3::UnitX())), {0.2, 0.3, -4}};
  CHECK((to_body(a, to_world(a, start)) - start).norm() < 1e-14);
  CHECK((to_world(after(b, a), start) - to_world(b, to_world(a, start))).norm() < 1e-14);
  CHECK(to_world({}, start) == start);
}

TEST_CASE("pose: keyframes are there, and their times rise") {
  CHECK_THROWS_WITH(make_keyframes({}), Catch::Contains("at least one keyframe"));
  CHECK(make_keyframes({{2, {}}}).keys.size() == 1);
  for (const double last : {1.5, 1.2})
    CHECK_THROWS_WITH(make_keyframes({{1, {}}, {1.5, {}}, {last, {}}}),
                      Catch::Contains("keyframe 2: the times of keyframes must rise"));
  CHECK_THROWS_WITH(make_keyframes({{1, {}}, {1, {}}, {2, {}}}), Catch::Contains("keyframe 1:"));
  for (const Keyframe& key : three_keys().keys) CHECK(key.pose.rotation.norm() == Approx(1));
}
