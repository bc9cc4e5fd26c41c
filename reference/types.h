// The words everything else is written in: state, work, and the unit convention.
//
// Units are SI throughout: m, s, kg, N, J. Angles are in radians in code, in degrees in case files (each key
// says so).
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <stdexcept>
#include <string>

namespace foldproof {

using Vector3 = Eigen::Vector3d;
using PerParticle = Eigen::VectorXd;    // N
using PerParticle3 = Eigen::Matrix3Xd;  // 3 x N; column i belongs to particle i

/// Positions and velocities at one time.
struct State {
  double time = 0;  // s
  PerParticle3 x;   // 3 x N [m]
  PerParticle3 v;   // 3 x N [m/s]
};

/// Counted work: what a method costs, whatever the machine. Returned or added to, never global.
struct Work {
  long elastic_evaluations = 0;     // evaluations of all elastic and external forces of the system
  long damping_preparations = 0;    // times the position-dependent terms of the damping forces were computed
  long damping_products = 0;        // products D(x) v
  long stiffness_preparations = 0;  // times the forces' derivative by the positions was computed
  long stiffness_products = 0;      // products of it with a displacement
  long newton_iterations = 0;       // over all nonlinear systems
  long solves = 0;                  // linear systems solved for a velocity
  long cg_iterations = 0;           // over all solves; an unsymmetric system's count two, as their products do
  long object_queries = 0;          // points that were asked where they are to the collision objects
  long object_contacts = 0;         // of those that were to be moved, how many had their velocity corrected
  long unfinished_solves = 0;       // solves, linear or not, that stopped before they kept their promise
  double worst_residual = 0;        // largest relative residual returned by a solve [1]
};

/// Sets `worst` to `value` if that is larger or NaN; a NaN stays whatever comes after it.
inline void keep_worst(double& worst, double value) {
  if (!std::isnan(worst) && !(value <= worst)) worst = value;
}

/// Bad input: the message says what, where and what to do.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace foldproof
