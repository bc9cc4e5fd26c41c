// The matrix of a method's step about an equilibrium, found by stepping small disturbances: what it
// says about stability is exact for linear motion.
#pragma once

#include <Eigen/Core>
#include <string_view>

#include "verification/oracles/exact_solutions.h"
#include "verification/subject.h"

namespace foldproof {

/// Small motion about the start of a scene, which must be an equilibrium at rest: coordinates q [m
/// sqrt(kg)] of some displacements. Disturbances are (omega0 q, dq/dt), both in sqrt(J).
struct SmallMotion {
  Scene scene;
  Eigen::MatrixXd shapes;  // 3 N x n [1/sqrt(kg)], orthonormal in the masses
  double omega0;           // [rad/s]
  // of a particle's place [m]: small enough to be linear, large enough for differences
  double disturbance;
};

/// A corner of a hinge that moves across its plane, the other three held: x'' = -omega0^2 x - 2
/// zeta omega0 x' as long as the angle is small. omega0 and the damping that makes zeta follow by
/// hand from BMF03 section 4.
SmallMotion hinge_oscillator(double zeta);

/// A sheet of 3 x 2 cells, flat, clamped at two columns of particles; six are free. Springs and
/// hinges are of comparable stiffness; their damping [N s/m], [N s] does not commute with it unless
/// it is in proportion.
Scene clamped_sheet(double spring_damping, double bending_damping);

/// All displacements of the particles that the scene does not hold.
SmallMotion free_motion(Scene scene, double omega0);

/// One displacement: shape 3 x N [m], of any size.
SmallMotion motion_along(Scene scene, const PerParticle3& shape, double omega0);

/// K and C of q'' = -K q - C q': n x n [1/s^2], [1/s], from the subject's forces; symmetric halves.
struct LinearForces {
  Eigen::MatrixXd stiffness, damping;
};
LinearForces linear_forces(const Subject& subject, const SmallMotion& motion);

/// A motion as the subject has made it ready for one of the reference's methods.
struct SteppedMotion {
  const Subject& subject;
  SmallMotion motion;
  int history;  // states that the method looks back on
  std::unique_ptr<PreparedScene> prepared;
};

/// Throws NotOffered if the subject does not step.
SteppedMotion stepped_motion(const Subject& subject, SmallMotion motion,
                             std::string_view integrator);

/// A step and the one before it, which methods without history do not see [s].
struct Steps {
  double now, before;
};

/// Takes the latest `history` disturbances, the oldest first, to those one step later; 2 n history
/// square, by central differences.
Eigen::MatrixXd step_matrix(const SteppedMotion& of, Steps steps);

/// Two steps, first and then second, again and again: the matrix of one such pair.
Eigen::MatrixXd pair_matrix(const SteppedMotion& of, double first, double second);

/// The paper's scheme of that name, A, B or C, for the oracles.
oracles::Scheme derived_scheme(std::string_view integrator);

/// Largest |eigenvalue|; NaN if the matrix is not finite.
double spectral_radius(const Eigen::MatrixXd& matrix);

/// Where a largest stable step is looked for.
struct StepRange {
  double low, high;  // s
  double threshold;  // a spectral radius above 1 + threshold counts as growth
  int halvings = 24;
};

/// The first step from low on, in strides of a seventh, whose matrix grows, bisected [s]. 0 if
/// `low` grows, infinite if nothing up to `high` does.
double largest_constant_step(const SteppedMotion& of, const StepRange& range);

/// The largest norm of the powers 1 to `powers` of a matrix: how much of a disturbance can come of
/// it on the way, stable or not. At least 1, its power 0.
double transient_growth(const Eigen::MatrixXd& matrix, int powers);

/// The matrix of one step without history, in the norm sqrt(2 E), E = q.K q/2 + v.v/2: K^{1/2} q
/// takes the place of omega0 q. stiffness: K, positive definite.
Eigen::MatrixXd in_energy_norm(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& stiffness,
                               double omega0);

}  // namespace foldproof
