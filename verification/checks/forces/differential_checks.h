// Checks of the elastic forces' derivative, which the fully implicit methods use.
#pragma once

#include <vector>

#include "verification/verdict.h"
#include "verification/specimens/measured.h"

namespace foldproof {

std::vector<Check> differential_checks();

/// Of the derivative of all forces, damping included, at given velocities.
std::vector<Check> force_differential_checks();

/// The reference's derivative of all forces at given velocities, 3N x 3N [N/m], coordinates particle by
/// particle.
Eigen::MatrixXd force_derivative(const Scene& scene, const State& s);

/// The subject's by central differences with `step` and half of it [m], extrapolated.
Eigen::MatrixXd differences_of_forces(const Probe& probe, const State& s, double step);

}  // namespace foldproof
