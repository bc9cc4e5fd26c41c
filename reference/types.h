// The words everything else is written in: state, work, and the unit convention.
//
// Units are SI throughout: m, s, kg, N, J. Angles are in radians in code, in degrees in case files (each key
// says so).
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace foldproof {

using Vector3 = Eigen::Vector3d;
using PerParticle = Eigen::VectorXd;    // N
using PerParticle3 = Eigen::Matrix3Xd;  // 3 x N; column i belongs to particle i

/// A particle that sticks to a place in the frame of a sticky patch's triangle (forces/sticking.h).
struct Bond {
  int patch, triangle, particle;  // patch: of the scene's list; triangle: of the patch's
  Vector3 place;  // weights of the triangle's second and third corner [1], height above it [m]
};

struct KeptPairs;  // filters/cloth_pairs.h

/// What lasts from step to step beside positions and velocities.
struct Memory {
  std::vector<Bond> bonds;  // by patch, particle, triangle
  std::shared_ptr<const KeptPairs>
      pairs;  // that may come near each other; they spare a search and change no bit
};

/// Positions and velocities at one time, and what must be remembered.
struct State {
  double time = 0;  // s
  PerParticle3 x;   // 3 x N [m]
  PerParticle3 v;   // 3 x N [m/s]
  Memory memory = {};
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
  long cg_iterations = 0;    // over all solves; an unsymmetric system's count two, as their products do
  long object_queries = 0;   // points that were asked where they are to the collision objects
  long object_contacts = 0;  // of those that were to be moved, how many had their velocity corrected
  long strain_sweeps = 0;    // of strain limiting over all springs
  double strain_left = 0;    // largest violation of a strain limit that a call left, over the rest length [1]
  long close_pairs = 0;      // pairs of cloth features nearer than the thickness that were answered
  long crossing_queries = 0;   // pairs of cloth features asked whether their motion takes them together
  long crossings = 0;          // of those, pairs that were kept apart by an impulse
  long zones = 0;              // rigid impact zones
  long zone_particles = 0;     // particles in them
  long bonds = 0;              // bonds of sticking at the step's start
  long unfinished_solves = 0;  // solves, linear or not, that stopped before they kept their promise
  double worst_residual = 0;   // largest relative residual returned by a solve [1]
};

/// Shows `see` every number of a Work, const or not, in an order that stays: counts as long, the rest as double.
template <class SomeWork, class See>
void for_each_number_of_work(SomeWork& w, const See& see) {
  for (auto* count :
       {&w.elastic_evaluations, &w.damping_preparations, &w.damping_products, &w.stiffness_preparations,
        &w.stiffness_products, &w.newton_iterations, &w.solves, &w.cg_iterations, &w.object_queries,
        &w.object_contacts, &w.strain_sweeps, &w.close_pairs, &w.crossing_queries, &w.crossings, &w.zones,
        &w.zone_particles, &w.bonds, &w.unfinished_solves})
    see(*count);
  for (auto* worst : {&w.strain_left, &w.worst_residual}) see(*worst);
}

// Whoever adds a number is stopped here until it is shown above.
static_assert(sizeof(Work) == 20 * sizeof(double));

/// Sets `worst` to `value` if that is larger or NaN; a NaN stays whatever comes after it.
inline void keep_worst(double& worst, double value) {
  if (!std::isnan(worst) && !(value <= worst)) worst = value;
}

/// Bad input: the message says what, where and what to do.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace foldproof
