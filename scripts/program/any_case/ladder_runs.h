// The runs of a ladder of refinements, as jobs: the first two levels show what the others cost.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "convergence/any_case/ladder_cost.h"
#include "convergence/any_case/space_ladder.h"
#include "scripts/program/jobs.h"

namespace foldproof {

struct LadderOfLevels {
  int levels;  // >= 3
  // level k; `runs`: of the levels that are over, at least the first if k > 0
  std::function<Level(int k, const std::vector<LevelRun>& runs)> level;
};

struct LadderRuns {
  std::vector<LevelRun> runs;  // of the levels that were run, coarse to fine; 3 or more
  // of all levels that were asked for, as foreseen after the first two
  std::vector<LevelCost> costs;
  std::string refused;  // why the other levels were not run, with the numbers; "" if all were
};

/// hours: the limit on the clock; 0: none. Memory: what the system says is available.
LadderLimits limits_of(double hours);

/// Runs the first level, then the second, each alone; then all others that fit the limits, at a
/// time. Levels that the store has are read from it. One line of progress goes over the whole
/// ladder. Throws InputError if the first level comes to no end, and if fewer than three levels
/// fit; std::runtime_error if a result cannot be written.
LadderRuns run_ladder(const LadderOfLevels& ladder, const LevelSetProvider& level_sets,
                      ResultStore& store, const JobSettings& running, const LadderLimits& limits);

struct SpaceRuns {
  SpaceLadder ladder;  // of the meshes that were run; 3 or more
  LadderRuns levels;
  LevelRun halved;  // of step_check_level
};

/// Runs the two coarsest meshes by their own steps, alone, which shows what the others cost; then
/// the finest mesh that fits the limits; then, with its steps, all coarser ones at a time and the
/// check of the steps. Stores and throws as run_ladder does.
SpaceRuns run_meshes(SpaceLadder ladder, const LevelSetProvider& level_sets, ResultStore& store,
                     const JobSettings& running, const LadderLimits& limits);

}  // namespace foldproof
