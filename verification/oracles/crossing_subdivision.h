// A second opinion on whether moving features meet: halved times, fixed directions, no roots.
#pragma once

#include "verification/oracles/exact_crossing_times.h"

namespace foldproof::oracles {

enum class MeetDecision { meet, apart, unclear };

/// Over a short time, two features are apart if some fixed direction parts them at its start and at
/// its end; and they meet if their plane passes while, seen along some fixed direction, they stay
/// one over the other. Times are halved `halvings` times at most; what is then neither, such as
/// touching, is unclear. In whole numbers throughout.
MeetDecision decide_by_subdivision(Features features, const Motion& motion, int halvings);

}  // namespace foldproof::oracles
