// Small scenes in which something sticks, for the study of lag, limits and costs.
#pragma once

#include <Eigen/Core>

#include "verification/subject.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

constexpr double particle_mass = 0.002;  // kg

/// A particle that sticks at `place` [m] to a large level square about the origin that
/// moves as given. stiffness [N/m], forecast_time [s]. (Two more particles of its triangle
/// stick to nothing.)
Scene particle_on_palm(const Vector3& place, const Motion& motion, double stiffness,
                       double forecast_time);

/// A particle at rest at its place, disturbed along one direction.
class StuckParticle {
 public:
  StuckParticle(const Subject& subject, const char* method, double stiffness, double forecast_time);

  /// Of (omega x, v) over a step of h [s], 2 x 2.
  Eigen::MatrixXd step_matrix(double h);

 private:
  double omega_;
  Stepper stepper_;
  State rest_;
};

/// The spectral radius of a step of scheme C of two layers of soft cloth, the lower one held but
/// for its middle, the upper one's particles stuck to the lower one's triangles with k = m
/// (omega_h/h)^2 and the forecast time `share` of h.
double layers_radius(const Subject& subject, double omega_h, double share);

enum class StuckTo { nothing, surface, cloth };

/// Iterations of a solve of a damped sheet of n x n cells stuck so that k tau_s h/(2 m) is `number`
/// inside it, over the first steps of scheme C from random velocities.
double iterations_where(const Subject& subject, int n, StuckTo to, double number);

}  // namespace foldproof
