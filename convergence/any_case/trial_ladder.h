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

/// A price lies between two steps: no run is made between two that are closer than this [1].
constexpr double narrow = 1.3;

/// Steps a frame to begin with: a power of two whose step is at most beyond_limit times `limit`
/// [s], and at most a frame [s].
int first_parts(double frame, double limit);

/// Whether so many steps a frame belong to the ladder of halved steps: a power of two.
bool is_halving(int parts);

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

/// Error bar of the positions of the last of these runs, coarse to fine, each with half the
/// step of the one before. With two runs it is three times their difference, a spread; with
/// fewer there is none.
///   runs          kept frames of each, 3 x N [m]
///   formal_order  of the method
///   floor         of rounding, in differences of positions [m]
ErrorBar halved_steps_bar(const std::vector<const std::vector<PerParticle3>*>& runs,
                          const PerParticle& mass, double formal_order, double floor);

/// halved_steps_bar of the method's finest whole run.
ErrorBar ladder_bar(const PrecisionPlan& plan, const std::string& method,
                    const TrialLevels& levels);

/// Throws InputError for an unknown method.
Family family_of(const std::string& method);

/// Those asked for, then those that the truth needs.
std::vector<std::string> all_methods(const PrecisionPlan& plan);

}  // namespace foldproof
