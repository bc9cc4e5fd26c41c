// End of a step for the methods that are not the paper's: prescribed motion and the paper's
// hook for filters.
#pragma once

#include "reference/dynamics/system.h"

namespace foldproof {

/// Result of a method: the velocity that moves x over the step, and the velocity at its
/// end (3 x N [m/s]).
struct StepVelocities {
  PerParticle3 move, end;
};

/// The state after a step of h [s]: prescribed particles are put on their paths, and the filters
/// correct the velocity that moves the cloth. The same change is added to the velocity at the end
/// of the step, which is then corrected itself.
State finish_step(const System& system, const State& now, double h, StepVelocities v, Work& work);

}  // namespace foldproof
