// One solve for the implicit velocity, for the reference and for dense linear algebra.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "reference/dynamics/system.h"
#include "reference/scene/scene.h"

namespace foldproof {

/// A crumpled sheet, its damping, and random initial velocities, some of which may be prescribed.
struct Problem {
  System system;
  State s;
  DampingOperator damping;
  PerParticle3 guess;  // 3 x N [m/s]
};

Problem make_problem(const Scene& scene, unsigned seed);

/// A system of these masses alone, to be solved with these settings.
System system_of(const PerParticle& mass, const PerParticle& inverse_mass,
                 const SolverSettings& settings);

/// (M - s D) and M w0 of a problem, with the rows and columns of known velocities kept apart.
struct DenseProblem {
  Eigen::MatrixXd A;               // of the free coordinates [kg]
  Eigen::VectorXd b;               // [kg m/s], including the contribution of known velocities
  Eigen::VectorXd mass;            // of the free coordinates [kg]
  Eigen::VectorXd momentum;        // M w0 of the free coordinates [kg m/s]
  std::vector<Eigen::Index> free;  // coordinates
};

/// The dense problem for half a step s [s], its D made of the modes of all dampers.
DenseProblem make_dense(const Problem& problem, double s);

/// sqrt(sum |r_k|^2/m_k) [kg^(1/2) m/s].
double weighted_norm(const Eigen::VectorXd& r, const Eigen::VectorXd& mass);

/// The reference value of a residual, straight from the definition of ResidualScale.
double scale_of(const DenseProblem& dense, ResidualScale scale);

}  // namespace foldproof
