// What a jump of the step does to the energy of a vibration.
#pragma once

#include <string>

#include "verification/subject.h"

namespace foldproof {

/// The finding hard-limits.step-jump.<scheme>: an undamped sheet vibrates in its fastest mode in steps of
/// 0.009 (2/omega), which jump to 0.9 (2/omega) at one of eight phases of the period.
NamedFinding step_jump(const Subject& subject, Scene scene, const std::string& scheme);

}  // namespace foldproof
