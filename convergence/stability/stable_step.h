// The largest stable step of motion near a scene's start: found from the forces, and by trying.
#pragma once

#include "verification/subject.h"

namespace foldproof {

/// A flat, free square of union-jack cells without forces, at rest: what the studies of
/// limits put theirs on.
Scene flat_sheet(int cells);
constexpr double flat_side = 0.61;  // its width [m]

/// A symmetric operator on displacements or velocities: 3 x N -> 3 x N forces.
using ForceOperator = std::function<PerParticle3(const PerParticle3&)>;

/// Elastic forces [N] of small displacements [m] from the scene's start, by central differences.
ForceOperator elastic_operator(const Subject& subject, const Scene& scene);

/// Damping forces [N] of velocities [m/s] at the scene's start.
ForceOperator damping_operator(const Subject& subject, const Scene& scene);

/// Of -M^{-1/2} F M^{-1/2} over the particles that are not led; the masses are the
/// scene's lumped ones.
struct LargestEigenvalue {
  double value;        // 1/s^2 or 1/s
  PerParticle3 shape;  // M^{-1/2} times its vector, 3 x N, normalised
};

/// By 400 rounds of power iteration, which approaches the eigenvalue from below.
LargestEigenvalue largest_eigenvalue(const Scene& scene, const ForceOperator& F);

/// The fastest elastic mode about the scene's start.
struct FastestMode {
  double omega;        // rad/s, from below
  PerParticle3 shape;  // displacement, 3 x N, normalised
};

FastestMode fastest_mode(const Subject& subject, const Scene& scene);

/// How the largest stable step is searched for.
struct StepSearch {
  double low, high;  // between these multiples of 2/omega
  int halvings = 8;
  int steps = 600;  // of each trial
};

/// The largest step at which a small disturbance of the start stays bounded, over 2/omega, found by
/// bisection with the scene's own integrator; NaN if it does not lie between `low` and `high`.
double largest_stable_step(const Subject& subject, const Scene& scene, double omega,
                           const StepSearch& search);

/// Numbers in [-1/2, 1/2), 3 x n, the same on every machine.
PerParticle3 disturbance_shape(Eigen::Index n);

/// Size of the disturbances of a flat sheet [m]: small enough to be linear, large enough
/// for differences.
constexpr double small_disturbance = 1e-7;

}  // namespace foldproof
