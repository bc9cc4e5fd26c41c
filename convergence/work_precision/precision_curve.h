// Error against cost of one method on one motion, what a wanted error costs on it, and whether the
// steps last.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "reference/types.h"
#include "verification/processor_time.h"
#include "verification/verdict.h"

namespace foldproof {

/// The result of run(), and the least processor time of up to four calls [s]; it is not called
/// again once 0.03 s are spent. All calls must do the same.
template <class Run>
auto timed_run(const Run& run) {
  constexpr int most_calls = 4;
  constexpr double enough_seconds = 0.03;
  const double start = processor_seconds();
  auto result = run();
  double spent = processor_seconds() - start, least = spent;
  for (int call = 1; call < most_calls && spent < enough_seconds; ++call) {
    const double before = processor_seconds();
    run();
    const double one = processor_seconds() - before;
    least = std::min(least, one);
    spent += one;
  }
  return std::pair(std::move(result), least);
}

// Does a step last? A short run forgives a step that is slightly too long, because instability has
// no time to grow. A run three times as long tells.

/// A step lasts if it stays stable in a run of so many times the length [1].
constexpr int longer = 3;

/// Kinetic energy of a run `longer` times as long [J]; NaN: it came to no end.
struct LongerEnergy {
  double largest;  // at any time
  double added;    // the largest in the added time, after the end of the shorter run
};

/// The energies of two such runs. The run with half the step shows how much energy the scene itself
/// allows: gravity, contact and prescribed motion bring some in, damping takes some out.
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

// The runs of a method, and their price.

struct PrecisionRun {
  int steps;
  double error;         // of positions, over the motion [1]; NaN: diverged
  double applications;  // of force operators [1]
  double seconds;       // of the processor
  double part;          // of its steps that it took: 1 unless it diverged on the way [1]
  Work work;
  // of runs of a case
  int parts = 0;             // steps a frame
  std::string stopped = "";  // why it came to no end
  double clock = nan;        // of another solver, through the pipe [s]
};

/// How a run is marked in figures; diverged: no error.
Mark mark_of(const PrecisionRun& run);

struct PrecisionCurve {
  std::string method;
  std::vector<PrecisionRun> runs;      // coarse to fine
  std::vector<LongerRun> longer = {};  // of steps that were asked whether they last
};

/// A run whose error exceeds the motion itself counts as diverged.
constexpr double diverged_error = 1;

/// The first run from which on all errors are at most `wanted`; their number if there is none.
size_t first_exact(const PrecisionCurve& curve, double wanted);

/// Why a step cannot be longer at a wanted error. longer_run: longer steps reach it, but are
/// unstable in a longer run.
enum class LimitedBy { accuracy, stability, longer_run, not_tried, not_reached };

std::string_view name_of(LimitedBy limit);

/// Cost of reaching a given error. All NaN when it was not reached.
struct Price {
  LimitedBy limit = LimitedBy::not_reached;
  double step = nan;          // s
  double applications = nan;  // 1
  double seconds = nan;
  double unfinished = nan;  // solves in the run that reaches it [1]
  double clock = nan;       // s
};

/// From the coarsest run from which on all errors are at most `wanted` [1]; between it and the next
/// coarser one the price is interpolated, linearly in the logarithms, unless that one diverged.
/// Steps that a longer run showed to be unstable have no price: the next shorter run has it.
Price price_at(const PrecisionCurve& curve, double end, double wanted);

// Figures of error against cost.

/// Horizontal axis for a run. A run that diverged on the way stands where all of its steps would
/// have cost as much as those that it took.
struct CostAxis {
  std::string name, words;
  Axis axis;
  double (*of)(const PrecisionRun& run, double end);
  double unit = 1;  // of the axis
};

/// Work, time, step.
std::vector<CostAxis> cost_axes();

/// The errors [%] of a method against one of its costs. floor: of the errors [1].
Curve error_curve(const PrecisionCurve& curve, const CostAxis& cost, double end, double floor);

}  // namespace foldproof
