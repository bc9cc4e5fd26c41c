// Basic types: state, work, and the unit convention.
//
// Units are SI throughout: m, s, kg, N, J. Angles are in radians in code, in degrees in case files
// (each key says so).
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <iterator>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

namespace foldproof {

using std::numbers::pi;

using Vector3 = Eigen::Vector3d;
using PerParticle = Eigen::VectorXd;    // N
using PerParticle3 = Eigen::Matrix3Xd;  // 3 x N; column i belongs to particle i

/// A particle that sticks to a place in the frame of a sticky patch's triangle (forces/sticking.h).
struct Bond {
  int patch, triangle, particle;  // patch: of the scene's list; triangle: of the patch's
  Vector3 place;  // weights of the triangle's second and third corner [1], height above it [m]
};

/// Positions, velocities and bonds at one time: everything that a step depends on.
struct State {
  double time = 0;               // s
  PerParticle3 x;                // 3 x N [m]
  PerParticle3 v;                // 3 x N [m/s]
  std::vector<Bond> bonds = {};  // by patch, particle, triangle
};

class KeptValues;  // fast/kept_values.h

/// Counted work: the cost of a method, independent of the machine. Returned or accumulated,
/// never global. It counts every value that a method uses: one that the run has kept counts like
/// one that is computed.
struct Work {
  long elastic_evaluations = 0;  // evaluations of all elastic and external forces of the system
  // evaluations of the position-dependent terms of the damping forces
  long damping_preparations = 0;
  long damping_products = 0;  // products D(x) v
  // evaluations of the derivative of the forces with respect to the positions
  long stiffness_preparations = 0;
  long stiffness_products = 0;  // products of it with a displacement
  long newton_iterations = 0;   // over all nonlinear systems
  long solves = 0;              // linear systems solved for a velocity
  // over all solves; iterations of unsymmetric systems count two, one per product
  long cg_iterations = 0;
  long object_queries = 0;  // points queried against the collision objects
  // moving points whose velocity was corrected
  long object_contacts = 0;
  long strain_sweeps = 0;  // sweeps of strain limiting over all springs
  // largest relative violation of a strain limit after a call [1]
  double strain_left = 0;
  long close_pairs = 0;  // pairs of cloth features nearer than the thickness that were repelled
  // pairs of cloth features tested for collision along their motion
  long crossing_queries = 0;
  long crossings = 0;       // of those, pairs kept apart by an impulse
  long zones = 0;           // rigid impact zones
  long zone_particles = 0;  // particles in them
  long bonds = 0;           // bonds of sticking at the step's start
  // solves, linear or not, that stopped before reaching their tolerance
  long unfinished_solves = 0;
  double worst_residual = 0;  // largest relative residual returned by a solve [1]

  // Values that the run keeps for its next steps, not a counter. Null: nothing is kept.
  std::shared_ptr<KeptValues> kept = {};
};

// All numbers of a Work, in a fixed order: first the summed ones, then those whose worst is kept.
inline constexpr long Work::*summed_counters[] = {&Work::elastic_evaluations,
                                                  &Work::damping_preparations,
                                                  &Work::damping_products,
                                                  &Work::stiffness_preparations,
                                                  &Work::stiffness_products,
                                                  &Work::newton_iterations,
                                                  &Work::solves,
                                                  &Work::cg_iterations,
                                                  &Work::object_queries,
                                                  &Work::object_contacts,
                                                  &Work::strain_sweeps,
                                                  &Work::close_pairs,
                                                  &Work::crossing_queries,
                                                  &Work::crossings,
                                                  &Work::zones,
                                                  &Work::zone_particles,
                                                  &Work::bonds,
                                                  &Work::unfinished_solves};
inline constexpr double Work::*worst_counters[] = {&Work::strain_left, &Work::worst_residual};

// Add every new counter to one of these lists.
static_assert(sizeof(Work) == std::size(summed_counters) * sizeof(long) +
                                  std::size(worst_counters) * sizeof(double) +
                                  sizeof(std::shared_ptr<KeptValues>));

/// Calls `visit` with every number of a Work, const or not: counts as long, the rest as double.
template <class SomeWork, class Visit>
void for_each_counter(SomeWork& w, const Visit& visit) {
  for (auto count : summed_counters) visit(w.*count);
  for (auto worst : worst_counters) visit(w.*worst);
}

/// Sets `worst` to `value` if that is larger or NaN; a NaN stays.
inline void update_worst(double& worst, double value) {
  if (!std::isnan(worst) && !(value <= worst)) worst = value;
}

/// Adds the cost of a part of a run.
inline void add(Work& sum, const Work& part) {
  for (auto count : summed_counters) sum.*count += part.*count;
  for (auto worst : worst_counters) update_worst(sum.*worst, part.*worst);
}

/// Bad input: the message says what, where and what to do.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace foldproof
