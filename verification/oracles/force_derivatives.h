// How the forces of definitions.h change with the positions while the velocities stay: by automatic
// differentiation of the forces as they are defined, in 50 digits, and by differences of them.
#pragma once

#include "verification/oracles/definitions.h"

namespace foldproof::oracles {

// Elastic and damping force together, sin(theta/2) from the atan2 form. The inputs count as exact.

/// By the four corners of a hinge [N/m], each factor taken where the input says.
MatrixEstimate bending_force_derivative_autodiff(const HingeInput& hinge);

/// The same by central differences: shares no derivative rule with the former.
MatrixEstimate bending_force_derivative_differences(const HingeInput& hinge);

/// By the two ends of a spring: a 6 x 6 matrix [N/m], and how far any entry of the truth
/// may lie from it.
struct SpringMatrixEstimate {
  Eigen::Matrix<double, 6, 6> value;
  double uncertainty = 0;
};

SpringMatrixEstimate spring_force_derivative_autodiff(const SpringInput& spring);

}  // namespace foldproof::oracles
