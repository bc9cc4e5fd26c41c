// Does a step last? A short run forgives a step that is slightly too long, because instability has
// no time to grow. A run three times as long tells.
#pragma once

#include <vector>

namespace foldproof {

/// A step lasts if it stays stable in a run of so many times the length [1].
constexpr int longer = 3;

/// Two runs of `longer` times the length. Half the step shows how much energy the scene itself
/// allows, whatever gravity, contact and prescribed motion bring in and damping takes out.
struct LongerRun {
  double step;     // s
  double kinetic;  // largest kinetic energy [J]; NaN: the run came to no end
  double allowed;  // the same with half the step [J]
};

/// Above it the method puts more energy into the motion than the scene does [1].
constexpr double most_energy_gain = 2;

/// Largest kinetic energy over that with half the step [1]; infinite if one of the two runs
/// came to no end.
double energy_gain(const LongerRun& run);

/// It came to its end, and its energy is the scene's.
bool lasts(const LongerRun& run);

/// The shortest of the steps that do not last [s]; infinite if all of them do.
double shortest_unstable_step(const std::vector<LongerRun>& runs);

/// The run with this step, or with one at most a billionth part longer; nullptr: there is none.
const LongerRun* longer_run_of(const std::vector<LongerRun>& runs, double step);

}  // namespace foldproof
