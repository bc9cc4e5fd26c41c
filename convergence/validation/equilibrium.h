// A sheet at rest under its forces, found without its motion.
#pragma once

#include "reference/scene/scene.h"
#include "verification/subject.h"

namespace foldproof {

struct Equilibrium {
  PerParticle3 x;     // 3 x N [m]
  double unbalanced;  // largest force on a free particle, over its weight [1]
  int steps;
  // all pivots of the energy's Hessian are positive: a minimum; a turn about the vertical, which
  // costs a sheet that hangs from one particle nothing, does not count
  bool stable;
};

/// Follows the forces from the scene's start, without inertia: steps of backward Euler that forget
/// their velocity, no longer than twice the mesh's smallest height, which grow to Newton's. Forces
/// are the subject's; their derivative is the reference's, and decides the way and the stability
/// only. Unfinished after 600 steps. The scene has gravity, and no objects, limits or damping.
Equilibrium equilibrium_of(const Subject& subject, const Scene& scene);

}  // namespace foldproof
