// The runs of a ladder of refinements, as jobs: the first two levels show what the others cost.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "convergence/any_case/ladder_cost.h"
#include "convergence/any_case/space_ladder.h"
#include "scripts/program/jobs.h"

namespace foldproof {

/// How the runs of one call are made and kept.
struct LevelRunner {
  KeptRuns kept;
  const JobSettings& running;
};

/// Jobs that make the runs, or read what the store has. lengths: how long each takes beside the
/// others. `runs` must stay where they are.
std::vector<Job> level_jobs(const std::vector<Level>& levels, const std::vector<double>& lengths,
                            const KeptRuns& by, std::vector<LevelRun>& runs);

/// Makes the runs side by side. span: a label, or a part of a longer work. Throws
/// std::runtime_error if a result cannot be written.
template <class Span>
std::vector<LevelRun> run_levels(const std::vector<Level>& levels,
                                 const std::vector<double>& lengths, const Span& span,
                                 const LevelRunner& by) {
  std::vector<LevelRun> runs(levels.size());
  RunRecord failed;
  run_jobs(level_jobs(levels, lengths, by.kept, runs), span, by.running, failed);
  if (!failed.records.empty()) throw std::runtime_error(failed.records.front().finding.note);
  return runs;
}

struct LadderOfLevels {
  int levels;  // >= 3
  // level k; `runs`: of the levels that are over, at least the first if k > 0
  std::function<Level(int k, const std::vector<LevelRun>& runs)> level;
};

struct LadderRuns {
  std::vector<LevelRun> runs;  // of the levels that were run, coarse to fine; 3 or more
  std::string refused;  // why the other levels were not run, with the numbers; "" if all were
};

/// hours: the limit on the clock; 0: none. Memory: what the system says is available.
LadderLimits limits_of(double hours);

/// Runs the first level, then the second, each alone; then all others that fit the limits, at a
/// time. Levels that the store has are read from it. One line of progress goes over the whole
/// ladder. Throws InputError if the first level comes to no end, and if fewer than three levels
/// fit; std::runtime_error if a result cannot be written.
LadderRuns run_ladder(const LadderOfLevels& ladder, const LevelRunner& by,
                      const LadderLimits& limits);

struct SpaceRuns {
  SpaceLadder ladder;  // of the meshes that were run; 3 or more
  LadderRuns levels;
  LevelRun halved;  // of step_check_level
};

/// Runs the two coarsest meshes by their own steps, alone, which shows what the others cost; then
/// the finest mesh that fits the limits; then, with its steps, all coarser ones at a time and the
/// check of the steps. Stores and throws as run_ladder does.
SpaceRuns run_meshes(SpaceLadder ladder, const LevelRunner& by, const LadderLimits& limits);

}  // namespace foldproof
