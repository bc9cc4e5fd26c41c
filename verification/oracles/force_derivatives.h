// Derivatives of the forces of definitions.h with respect to the positions at fixed velocities: by
// automatic differentiation of the definitions, in 50 digits, and by finite differences.
#pragma once

#include "verification/oracles/definitions.h"

namespace foldproof::oracles {

// Elastic and damping force together, sin(theta/2) from the atan2 form. The inputs count as exact.

/// With respect to the four corners of a hinge [N/m], each factor evaluated as the input specifies.
MatrixEstimate bending_force_derivative_autodiff(const HingeInput& hinge);

/// The same by central differences: shares no derivative rule with the former.
MatrixEstimate bending_force_derivative_differences(const HingeInput& hinge);

/// With respect to the two ends of a spring: a 6 x 6 matrix [N/m], and the
/// uncertainty of any entry.
struct SpringMatrixEstimate {
  Eigen::Matrix<double, 6, 6> value;
  double uncertainty = 0;
};

SpringMatrixEstimate spring_force_derivative_autodiff(const SpringInput& spring);

}  // namespace foldproof::oracles
