// One implicit velocity to be solved for, as the reference solves it and as dense
// linear algebra does.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "reference/dynamics/system.h"
#include "reference/scene/scene.h"

namespace foldproof {

/// A crumpled sheet, its damping, and random velocities to start from; some of them may be known.
struct Problem {
  System system;
  State s;
  DampingOperator damping;
  PerParticle3 guess;  // 3 x N [m/s]
};

Problem make_problem(const Scene& scene, unsigned seed);

/// (M - s D) and M w0 of a problem, with the rows and columns of known velocities kept apart.
struct DenseProblem {
  Eigen::MatrixXd A;               // of the free coordinates [kg]
  Eigen::VectorXd b;               // [kg m/s], what known velocities contribute included
  Eigen::VectorXd mass;            // of the free coordinates [kg]
  Eigen::VectorXd momentum;        // M w0 of the free coordinates [kg m/s]
  std::vector<Eigen::Index> free;  // coordinates
};

/// The dense problem for half a step s [s], its D made of the modes of all dampers.
DenseProblem make_dense(const Problem& problem, double s);

/// sqrt(sum |r_k|^2/m_k) [kg^(1/2) m/s].
double weighted_norm(const Eigen::VectorXd& r, const Eigen::VectorXd& mass);

/// What a residual is compared with, straight from the words of ResidualScale.
double scale_of(const DenseProblem& dense, ResidualScale scale);

}  // namespace foldproof
