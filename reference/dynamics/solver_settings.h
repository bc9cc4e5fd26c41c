// Accuracy settings of linear solves, and their results.
#pragma once

namespace foldproof {

/// Reference for the relative residual, in the mass-weighted norm |r|^2 = sum_i
/// |r_i|^2/m_i [kg m^2/s^2]:
enum class ResidualScale {
  momentum,  // the right-hand side M w0, sqrt(sum m_i |w0_i|^2): an error relative to the velocity
  // residual of the explicit guess: an error relative to the change due to damping, the same in
  // every inertial frame
  initial_residual
};

struct SolverSettings {
  double tolerance = 1e-10;  // relative residual at which a solve stops [1]
  int max_iterations = 1000;
  ResidualScale scale = ResidualScale::momentum;
};

struct SolveResult {
  int iterations;
  // relative, as accumulated by the iteration [1]; NaN if the data were not finite
  double residual;
  bool converged;  // residual <= tolerance
  // stopped early at a direction of zero or negative curvature: the matrix is not positive definite
  bool indefinite;
};

}  // namespace foldproof
