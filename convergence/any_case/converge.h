// How far is a case's run from its limit? The error that it owes to its step, by
// halving every step.
#pragma once

#include <string>
#include <vector>

#include "convergence/any_case/error_bar.h"
#include "convergence/any_case/level_run.h"

namespace foldproof {

/// The ladder: `levels` runs, each with half the steps of the one before.
struct LadderPlan {
  Case input_case;  // with the method and the end that are asked for
  int levels = 4;   // >= 3
  std::vector<Measurement> measurements;
};

/// The case's own: its [[quantity]] tables, or the usual ones.
std::vector<Measurement> measurements_of(const Case& input_case);

/// The plan's level k, every step of the first divided by 2^k. step_ends: of level 0; not
/// asked for k = 0.
Level time_level(const LadderPlan& plan, int k, const std::vector<double>& step_ends);

/// `ends`, with each step divided evenly into `parts`; ends themselves stay to the bit. start: of
/// the first step [s].
std::vector<double> divide_steps(const std::vector<double>& ends, double start, int parts);

/// One quantity over the ladder, read.
struct QuantityOverLevels {
  std::string name, unit;
  std::vector<double> values;       // one a level; empty for positions
  std::vector<double> differences;  // of neighbouring levels
  ErrorBar bar;                     // of the finest level
  // of level 0, the case as it stands: its distance to the finest level and that level's bar
  double first_error;
};

struct LadderAnswer {
  std::string scene, method;
  std::string in;                              // "time" or "space"
  std::vector<double> sizes;                   // mean step of each level [s]
  std::vector<double> work, seconds;           // of each level
  std::vector<std::string> stopped;            // why a level came to no end, or ""
  std::vector<QuantityOverLevels> quantities;  // positions first
};

/// Reads all levels, coarse to fine.
LadderAnswer time_answer(const LadderPlan& plan, const std::vector<LevelRun>& runs);

}  // namespace foldproof
