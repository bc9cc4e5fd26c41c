// Differences between two states, sizes of states; sums of forces and torques, and rigid motion,
// for which forces vanish.
#pragma once

#include <string>

#include "reference/types.h"

namespace foldproof {

/// Largest distance between the columns of two 3 x N arrays; NaN if any is.
double largest_difference(const PerParticle3& a, const PerParticle3& b);

/// Number of entries in which two 3 x N arrays differ; NaN differs from everything.
double count_differing_entries(const PerParticle3& a, const PerParticle3& b);

/// Half the diagonal of the box around all positions, plus the distance of its centre from
/// the origin [m].
double extent(const PerParticle3& x);

/// A note on the sensitivity of a bound in roundings: "The smallest defect that this notices is
/// 3.1e-13 of the extent." bound: in epsilon of the scale.
std::string smallest_defect(double bound, const std::string& scale);

double largest_speed(const PerParticle3& v);  // m/s

/// |sum of F| over epsilon times sum |F_i|; NaN without any force. f: 3 x N [N].
double net_force(const PerParticle3& f);

/// |sum of x_i x F_i| about the mean of x, over epsilon times sum |x_i||F_i|; NaN without any
/// force. x: 3 x N [m].
double net_torque(const PerParticle3& x, const PerParticle3& f);

/// Velocity [m/s] of particles at x moved rigidly: v + w x (x - mean).
PerParticle3 rigid_velocity(const PerParticle3& x, const Vector3& v, const Vector3& w);

}  // namespace foldproof
