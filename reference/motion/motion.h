// Prescribed motion: position and velocity of a prescribed point at any time.
#pragma once

#include <limits>
#include <vector>

#include "reference/types.h"

namespace foldproof {

/// A motion given in closed form: rotation about a fixed axis, then a shift that drifts and
/// oscillates. It acts smoothly between two times, and rests before and after. With t counted from
/// its start:
///   X(t) = C + R(angular_velocity t) (X0 - C) + velocity t +
///          amplitude (sin(2 pi frequency t + phase) - sin(phase))
/// All zero: held at rest. X0 is the position until it starts.
struct Motion {
  Vector3 velocity = Vector3::Zero();                                // m/s
  Vector3 amplitude = Vector3::Zero();                               // m
  double frequency = 0;                                              // Hz
  double phase = 0;                                                  // rad
  Vector3 center = Vector3::Zero();                                  // C, a point of the axis [m]
  Vector3 angular_velocity = Vector3::Zero();                        // along the axis [rad/s]
  double from = 0, until = std::numeric_limits<double>::infinity();  // when it acts [s]
};

/// Position [m] and velocity [m/s] at time t [s] of the point that is at `start` [m] until the
/// motion starts. Where the velocity jumps, the later one is returned.
Vector3 position_at(const Motion& motion, const Vector3& start, double t);
Vector3 velocity_at(const Motion& motion, const Vector3& start, double t);

/// A particle whose motion is prescribed.
struct PrescribedParticle {
  int particle;
  Vector3 start;  // position until its motion starts [m]
  Motion motion;
};

/// The times after `start` at which a motion starts or stops, ascending, each once [s].
std::vector<double> event_times(const std::vector<PrescribedParticle>& prescribed, double start);

/// The same particle with its motion just after `t` [s] continued smoothly for
/// ever; identical to the given motion until the next event. Events as little as
/// `tolerance` [s] after t count as passed.
PrescribedParticle smooth_continuation(const PrescribedParticle& prescribed, double t,
                                       double tolerance);

/// A velocity that a solve takes as known.
struct KnownVelocity {
  int particle;
  Vector3 velocity;  // m/s
};

/// The velocities at time t.
std::vector<KnownVelocity> velocities_at(const std::vector<PrescribedParticle>& prescribed,
                                         double t);

/// The mean velocities over [t, t + h]: x + h v then ends exactly on the prescribed path.
std::vector<KnownVelocity> mean_velocities(const std::vector<PrescribedParticle>& prescribed,
                                           const PerParticle3& x, double t, double h);

/// Writes the known velocities into v (3 x N [m/s]).
void impose(const std::vector<KnownVelocity>& known, PerParticle3& v);

}  // namespace foldproof
