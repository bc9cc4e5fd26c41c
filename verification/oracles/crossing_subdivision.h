// A second opinion on whether moving features meet: time bisection and fixed directions,
// no root finding.
#pragma once

#include "verification/oracles/exact_crossing_times.h"

namespace foldproof::oracles {

enum class MeetDecision { meet, apart, unclear };

/// Over a short time, two features stay apart if some fixed direction separates them at its start
/// and at its end. They meet if they pass through a common plane while they overlap when seen along
/// some fixed direction. The time is halved at most `halvings` times; anything still undecided,
/// such as touching, is unclear. In integers throughout.
MeetDecision decide_by_subdivision(Features features, const ExactMotion& motion, int halvings);

}  // namespace foldproof::oracles
