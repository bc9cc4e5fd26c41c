// When a ribbon of slivers loses a triangle, and that the step does not decide it.
#pragma once

#include "verification/verdict.h"

namespace foldproof {

/// The finding hard-limits.slivers-collapse-whatever-the-step. It runs the reference.
NamedFinding sliver_collapse();

}  // namespace foldproof
