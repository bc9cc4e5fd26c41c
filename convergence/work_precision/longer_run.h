// Does a step last? A short run forgives a step that is slightly too long, because instability has
// no time to grow. A run three times as long tells.
#pragma once

#include <vector>

namespace foldproof {

/// A step lasts if it stays stable in a run of so many times the length [1].
constexpr int longer = 3;

/// Kinetic energy of a run `longer` times as long [J]; NaN: it came to no end.
struct LongerEnergy {
  double largest;  // at any time
  double added;    // the largest in the added time, after the end of the shorter run
};

/// Two such runs. Half the step shows how much energy the scene itself allows, whatever gravity,
/// contact and prescribed motion bring in and damping takes out.
struct LongerRun {
  double step;  // s
  LongerEnergy with_step, with_half;
};

/// Of the largest energy: that of a velocity that is a hundredth of the largest one [1].
constexpr double small_energy = 1e-4;

/// Above it the method puts more energy into the motion than the scene does [1].
constexpr double most_energy_gain = 2;

/// Energy of the added time over that with half the step, to which a small one is added: motions
/// that have come to rest are not asked [1]. Infinite if one of the two runs came to no end.
double energy_gain(const LongerRun& run);

/// It came to its end, and its energy is the scene's.
bool lasts(const LongerRun& run);

/// The shortest of the steps that do not last [s]; infinite if all of them do.
double shortest_unstable_step(const std::vector<LongerRun>& runs);

/// The run with this step, or with one at most a billionth part longer; nullptr: there is none.
const LongerRun* longer_run_of(const std::vector<LongerRun>& runs, double step);

}  // namespace foldproof
