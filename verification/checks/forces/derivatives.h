// Derivatives of forces as dense matrices: the reference's, and by differences.
#pragma once

#include "verification/specimens/probe.h"

namespace foldproof {

/// The reference's derivative of all forces at given velocities, 3N x 3N [N/m], coordinates
/// particle by particle.
Eigen::MatrixXd force_derivative(const Scene& scene, const State& s);

/// The subject's by central differences with `step` and half of it [m], extrapolated.
Eigen::MatrixXd differences_of_forces(const Probe& probe, const State& s, double step);

}  // namespace foldproof
