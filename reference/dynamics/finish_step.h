// How the methods that are not the paper's end a step: prescribed motion and the paper's
// hook for filters.
#pragma once

#include "reference/dynamics/system.h"

namespace foldproof {

/// What a method has found: the velocity that moves x over the step, and the one that ends
/// it (3 x N [m/s]).
struct StepVelocities {
  PerParticle3 move, end;
};

/// The state after a step of h [s]: prescribed particles are put on their paths, the filters
/// correct the velocity that moves the cloth, the one that ends the step takes up the change that
/// they made, and is then corrected itself.
State finish_step(const System& system, const State& now, double h, StepVelocities v, Work& work);

}  // namespace foldproof
