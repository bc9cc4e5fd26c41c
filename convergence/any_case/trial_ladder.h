// The runs of one method over steps that are halved, as the search for the cheapest
// method reads them.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "convergence/any_case/precision.h"

namespace foldproof {

/// The first step is at most so many times the elastic limit at the start [1].
constexpr double beyond_limit = 4;

constexpr int most_parts = 1 << 20;  // steps a frame

/// Runs of one method, by steps a frame.
using TrialLevels = std::map<int, TrialRun>;

/// It came to its end.
bool is_whole(const TrialRun& run);

/// The length of a frame, or of a shorter run [s].
double frame_of(const PrecisionPlan& plan);

/// The largest over frames, each 3 x N [m]; NaN where they are not the same frames.
double frame_distance(const std::vector<PerParticle3>& a, const std::vector<PerParticle3>& b,
                      const PerParticle& mass);

/// The whole runs at the fine end of the ladder of halved steps, each with twice as many steps as
/// the one before, coarse to fine.
std::vector<std::pair<int, const TrialRun*>> fine_end(const TrialLevels& levels);

/// The finest of the halved steps, whole or not; parts 0: there is none.
std::pair<int, const TrialRun*> finest(const TrialLevels& levels);

/// Of the positions of the finest whole run; with two runs three times their difference, as a
/// spread; with fewer none.
ErrorBar ladder_bar(const PrecisionPlan& plan, const std::string& method,
                    const TrialLevels& levels);

/// Throws InputError for an unknown method.
Family family_of(const std::string& method);

/// Those asked for, then those that the truth needs.
std::vector<std::string> all_methods(const PrecisionPlan& plan);

}  // namespace foldproof
