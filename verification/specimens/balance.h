// Sums of forces and torques, and rigid motion, for which both vanish.
#pragma once

#include "reference/types.h"

namespace foldproof {

/// |sum of F| over epsilon times sum |F_i|; NaN without any force. f: 3 x N [N].
double net_force(const PerParticle3& f);

/// |sum of x_i x F_i| about the mean of x, over epsilon times sum |x_i||F_i|; NaN without any
/// force. x: 3 x N [m].
double net_torque(const PerParticle3& x, const PerParticle3& f);

/// Velocity [m/s] of particles at x moved rigidly: v + w x (x - mean).
PerParticle3 rigid_velocity(const PerParticle3& x, const Vector3& v, const Vector3& w);

}  // namespace foldproof
