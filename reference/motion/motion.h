// Prescribed motion: where a point that is led, not simulated, is at any time, and how fast.
#pragma once

#include <vector>

#include "reference/types.h"

namespace foldproof {

/// A smooth motion given in closed form: rotation about a fixed axis, then a shift that drifts and
/// oscillates.
///   X(t) = C + R(angular_velocity t) (X0 - C) + velocity t + amplitude (sin(2 pi frequency t + phase) -
///   sin(phase))
/// All zero: held at rest. X(0) = X0.
struct Motion {
  Vector3 velocity = Vector3::Zero();          // m/s
  Vector3 amplitude = Vector3::Zero();         // m
  double frequency = 0;                        // Hz
  double phase = 0;                            // rad
  Vector3 center = Vector3::Zero();            // C, a point of the axis [m]
  Vector3 angular_velocity = Vector3::Zero();  // along the axis [rad/s]
};

/// Position [m] and velocity [m/s] at time t [s] of the point that is at `start` [m] at time 0.
Vector3 position_at(const Motion& motion, const Vector3& start, double t);
Vector3 velocity_at(const Motion& motion, const Vector3& start, double t);

/// A particle whose motion is prescribed.
struct PrescribedParticle {
  int particle;
  Vector3 start;  // position at time 0 [m]
  Motion motion;
};

/// Velocities that a solve has to take as known.
struct KnownVelocity {
  int particle;
  Vector3 velocity;  // m/s
};

/// The velocities at time t.
std::vector<KnownVelocity> velocities_at(const std::vector<PrescribedParticle>& led, double t);

/// The mean velocities over [t, t + h]: x + h v then ends exactly on the prescribed path.
std::vector<KnownVelocity> mean_velocities(const std::vector<PrescribedParticle>& led, const PerParticle3& x,
                                           double t, double h);

/// Writes the known velocities into v (3 x N [m/s]).
void impose(const std::vector<KnownVelocity>& known, PerParticle3& v);

}  // namespace foldproof
