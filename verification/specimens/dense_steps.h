// Steps of other papers' methods on small cloth, with dense matrices: models to compare with.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "reference/scene/scene.h"
#include "verification/specimens/probe.h"

namespace foldproof {

/// Parts used of the damping forces' derivative by positions: all; without the term that breaks its
/// symmetry (Baraff and Witkin 1998); none.
enum class DampingDerivative { whole, symmetric_part, none };

/// A scene whose held particles stay in place; forces are the subject's.
class DenseCloth {
 public:
  DenseCloth(const Subject& subject, const Scene& scene);

  /// Newmark's method with average acceleration (Grinspun et al. 2003: beta 1/4, gamma 1/2):
  ///   x' = x + h (v + v')/2,   v' = v + h (a + a')/2
  /// by Newton's method with the matrix of the last state that needed one, to rounding; undamped
  /// cloth, and one h for all steps. Throws std::runtime_error if it does not get there.
  State average_acceleration(const State& s, double h);

  /// One linear solve with the forces linearised about s, using `part` of the damping derivative:
  /// needs springs only.
  ///   (M - h D - h^2 K) (w - v) = h (F + h K v),   x' = x + h w
  State one_solve(const State& s, double h, DampingDerivative part) const;

  double energy(const State& s) const;  // kinetic and potential [J]

 private:
  Eigen::VectorXd forces(const PerParticle3& x, const PerParticle3& v) const;
  Eigen::MatrixXd stiffness(const State& s, const PerParticle3& v) const;
  Eigen::MatrixXd asymmetric_term(const State& s) const;

  Scene scene_;
  Probe probe_;
  Eigen::VectorXd mass_;            // of each coordinate [kg]
  std::vector<Eigen::Index> free_;  // coordinates
  Eigen::MatrixXd inverse_;         // of the matrix of Newton steps; empty before the first
};

}  // namespace foldproof
