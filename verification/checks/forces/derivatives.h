// Derivatives of forces as dense matrices: from the reference, and by finite differences.
#pragma once

#include "verification/specimens/probe.h"

namespace foldproof {

/// The reference's derivative of all forces with respect to the positions, at fixed velocities: 3N
/// x 3N [N/m], ordered by particle.
Eigen::MatrixXd force_derivative(const Scene& scene, const State& s);

/// The subject's derivative by central differences with `step` and `step`/2 [m], extrapolated.
Eigen::MatrixXd differences_of_forces(const Probe& probe, const State& s, double step);

}  // namespace foldproof
