// The largest stable step of motion near a scene's start: found from the forces, and by trying.
#pragma once

#include "verification/subject.h"

namespace foldproof {

/// The fastest elastic mode about the scene's start.
struct FastestMode {
  double omega;        // rad/s
  PerParticle3 shape;  // displacement, 3 x N, normalised
};

/// Power iteration on M^{-1/2} K M^{-1/2}, with products by central differences of the subject's forces; the
/// masses are the scene's lumped ones. It approaches omega from below.
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

/// Size of the disturbances of a flat sheet [m]: small enough to be linear, large enough for differences.
constexpr double small_disturbance = 1e-7;

}  // namespace foldproof
