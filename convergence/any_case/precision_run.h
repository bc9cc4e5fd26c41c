// One run of a case with one method and a constant step, as the search for the cheapest method
// needs it: where the cloth was, and what it cost.
#pragma once

#include <string>
#include <vector>

#include "convergence/any_case/framed_run.h"
#include "convergence/work_precision/longer_run.h"
#include "reference/bodies/level_set_provider.h"
#include "reference/dynamics/simulate.h"
#include "verification/cases/expectations.h"
#include "verification/files/result_store.h"

namespace foldproof {

/// A run to make: a method, with `parts` equal steps from frame to frame. No step is longer than a
/// frame's interval; events within a frame divide it further.
struct PrecisionTrial {
  std::string method;
  int parts = 1;      // >= 1
  double budget = 0;  // of the run [visits]
  int times = 1;      // the run's length over the case's [1]
};

/// Of long runs only some frames are kept; of runs longer than the case only the
/// first and the last.
struct TrialRun : FramedRun {
  long steps = 0;
  Work work;
  double part = 0;         // of the time that it was to reach [1]
  LongerEnergy energy{};   // of the free particles, in frames
  double over_budget = 0;  // the budget at which it was ended [visits]; 0: it was not
};

/// Visits of a spring, a hinge, or a point or pair that is asked about contact: what a run costs,
/// about alike for each [1].
double visits(const Scene& scene, const Work& work);

/// The scene with the trial's method, step and length.
Scene scene_of(const Scene& scene, const PrecisionTrial& trial);

/// Runs the trial. It ends at the first frame at which it has taken more visits than its budget. Of
/// long runs of large cloth only every second, third, ... frame is kept, so that a run keeps at
/// most a million numbers. An error in building or running goes into `stopped`.
TrialRun run_trial(const Case& input_case, const PrecisionTrial& trial,
                   const LevelSetProvider& level_sets);

/// The trial's run from the store, or made now and kept there. A run that a smaller budget
/// ended is made again.
TrialRun stored_trial(const Case& input_case, const PrecisionTrial& trial,
                      const LevelSetProvider& level_sets, ResultStore& store,
                      const std::string& program);

}  // namespace foldproof
