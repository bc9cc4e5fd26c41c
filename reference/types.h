// The words everything else is written in: state, work, and the unit convention.
//
// Units are SI throughout: m, s, kg, N, J. Angles are in radians in code, in degrees in case files
// (each key says so).
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <iterator>
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

/// Positions, velocities and bonds at one time: all that a step depends on.
struct State {
  double time = 0;               // s
  PerParticle3 x;                // 3 x N [m]
  PerParticle3 v;                // 3 x N [m/s]
  std::vector<Bond> bonds = {};  // by patch, particle, triangle
};

/// Counted work: what a method costs, whatever the machine. Returned or added to, never global.
struct Work {
  long elastic_evaluations = 0;  // evaluations of all elastic and external forces of the system
  // times the position-dependent terms of the damping forces were computed
  long damping_preparations = 0;
  long damping_products = 0;        // products D(x) v
  long stiffness_preparations = 0;  // times the forces' derivative by the positions was computed
  long stiffness_products = 0;      // products of it with a displacement
  long newton_iterations = 0;       // over all nonlinear systems
  long solves = 0;                  // linear systems solved for a velocity
  // over all solves; an unsymmetric system's count two, as their products do
  long cg_iterations = 0;
  long object_queries = 0;  // points that were asked where they are to the collision objects
  // of those that were to be moved, how many had their velocity corrected
  long object_contacts = 0;
  long strain_sweeps = 0;  // of strain limiting over all springs
  // largest violation of a strain limit that a call left, over the rest length [1]
  double strain_left = 0;
  long close_pairs = 0;  // pairs of cloth features nearer than the thickness that were answered
  // pairs of cloth features asked whether their motion takes them together
  long crossing_queries = 0;
  long crossings = 0;          // of those, pairs that were kept apart by an impulse
  long zones = 0;              // rigid impact zones
  long zone_particles = 0;     // particles in them
  long bonds = 0;              // bonds of sticking at the step's start
  long unfinished_solves = 0;  // solves, linear or not, that stopped before they kept their promise
  double worst_residual = 0;   // largest relative residual returned by a solve [1]
};

// All numbers of a Work, in an order that stays: what is added up, and of what the worst counts.
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

// Whoever adds a number is stopped here until it is in one of the lists.
static_assert(sizeof(Work) == std::size(summed_counters) * sizeof(long) +
                                  std::size(worst_counters) * sizeof(double));

/// Shows `visit` every number of a Work, const or not: counts as long, the rest as double.
template <class SomeWork, class Visit>
void for_each_counter(SomeWork& w, const Visit& visit) {
  for (auto count : summed_counters) visit(w.*count);
  for (auto worst : worst_counters) visit(w.*worst);
}

/// Sets `worst` to `value` if that is larger or NaN; a NaN stays whatever comes after it.
inline void update_worst(double& worst, double value) {
  if (!std::isnan(worst) && !(value <= worst)) worst = value;
}

/// Adds what a part of a run cost.
inline void add(Work& sum, const Work& part) {
  for (auto count : summed_counters) sum.*count += part.*count;
  for (auto worst : worst_counters) update_worst(sum.*worst, part.*worst);
}

/// Bad input: the message says what, where and what to do.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace foldproof
