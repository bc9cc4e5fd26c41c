// How the methods that are not the paper's end a step: prescribed motion and the paper's hook for filters.
#pragma once

#include "reference/dynamics/system.h"

namespace foldproof {

/// The state after a step of h [s] that would move x by h v_move and end with v_end (3 x N [m/s]): prescribed
/// particles are put on their paths, the filters correct the velocity that moves the cloth, v_end takes up the
/// change that they made, and is then corrected itself.
State end_of_step(const System& system, const State& now, double h, PerParticle3 v_move, PerParticle3 v_end);

}  // namespace foldproof
