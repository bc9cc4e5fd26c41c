// Parts of the study hard-limits: jumps of the step, and slivers that collapse.
#pragma once

#include <string>

#include "convergence/study.h"
#include "verification/subject.h"

namespace foldproof {

// Effect of a jump of the step on the energy of a vibration.

/// The finding hard-limits.energy-is-bounded-across-a-step-jump.<scheme>: an undamped sheet
/// vibrates in its fastest mode in steps of 0.009 (2/omega), which jump to 0.9 (2/omega) at one of
/// eight phases of the period.
NamedFinding step_jump(const Subject& subject, Scene scene, const std::string& scheme);

// When a ribbon of slivers loses a triangle, and that the step does not decide it.

/// The finding hard-limits.slivers-collapse-at-any-step. It runs the reference.
NamedFinding sliver_collapse();

}  // namespace foldproof
