#include "reference/motion/motion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace foldproof {

namespace {

Vector3 rotate_about_axis(const Motion& motion, const Vector3& start, double t) {
  const double rate = motion.angular_velocity.norm();
  if (rate == 0) return start - motion.center;
  return Eigen::AngleAxisd(rate * t, motion.angular_velocity / rate) * (start - motion.center);
}

/// The time for which the motion has acted by time t [s].
double active_duration(const Motion& motion, double t) {
  return std::clamp(t, motion.from, motion.until) - motion.from;
}

}  // namespace

Vector3 position_at(const Motion& motion, const Vector3& start, double time) {
  const double t = active_duration(motion, time);
  const double swing =
      std::sin(2 * pi * motion.frequency * t + motion.phase) - std::sin(motion.phase);
  return motion.center + rotate_about_axis(motion, start, t) + t * motion.velocity +
         swing * motion.amplitude;
}

Vector3 velocity_at(const Motion& motion, const Vector3& start, double time) {
  if (time < motion.from || time >= motion.until) return Vector3::Zero();
  const double t = active_duration(motion, time);
  const double omega = 2 * pi * motion.frequency;
  const double swing_rate = omega * std::cos(omega * t + motion.phase);
  return motion.angular_velocity.cross(rotate_about_axis(motion, start, t)) + motion.velocity +
         swing_rate * motion.amplitude;
}

std::vector<double> event_times(const std::vector<PrescribedParticle>& prescribed, double start) {
  std::vector<double> times;
  for (const PrescribedParticle& p : prescribed)
    for (const double time : {p.motion.from, p.motion.until})
      if (time > start && std::isfinite(time)) times.push_back(time);
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

PrescribedParticle smooth_continuation(const PrescribedParticle& prescribed, double t,
                                       double tolerance) {
  const Motion& motion = prescribed.motion;
  if (t + tolerance < motion.from) return {prescribed.particle, prescribed.start, {}};
  if (t + tolerance >= motion.until)
    return {prescribed.particle, position_at(motion, prescribed.start, motion.until), {}};
  PrescribedParticle moving = prescribed;
  moving.motion.from = std::min(motion.from, t);
  moving.motion.until = std::numeric_limits<double>::infinity();
  return moving;
}

std::vector<KnownVelocity> velocities_at(const std::vector<PrescribedParticle>& prescribed,
                                         double t) {
  std::vector<KnownVelocity> known;
  known.reserve(prescribed.size());
  for (const PrescribedParticle& p : prescribed)
    known.push_back({p.particle, velocity_at(p.motion, p.start, t)});
  return known;
}

std::vector<KnownVelocity> mean_velocities(const std::vector<PrescribedParticle>& prescribed,
                                           const PerParticle3& x, double t, double h) {
  std::vector<KnownVelocity> known;
  known.reserve(prescribed.size());
  for (const PrescribedParticle& p : prescribed) {
    const Vector3 end = position_at(p.motion, p.start, t + h);
    known.push_back({p.particle, (end - x.col(p.particle)) / h});
  }
  return known;
}

void impose(const std::vector<KnownVelocity>& known, PerParticle3& v) {
  for (const KnownVelocity& k : known) v.col(k.particle) = k.velocity;
}

}  // namespace foldproof
