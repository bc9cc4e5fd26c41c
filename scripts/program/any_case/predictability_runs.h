// The twin runs of `foldproof converge`: made, and said.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "convergence/any_case/motion_statistics.h"
#include "convergence/any_case/predictability.h"
#include "scripts/program/options.h"

namespace foldproof {

struct PredictabilityAnswer {
  Predictability of;
  int ensemble = 0;                           // runs
  std::vector<StatisticOverRuns> statistics;  // beyond the horizon; empty if there is none
};

/// Runs the twins of the ladder's first level, and beyond a horizon the ensemble, as jobs; takes
/// what the store has.
PredictabilityAnswer run_twins(const LadderPlan& plan, const std::vector<LevelRun>& runs,
                               const LevelSetProvider& level_sets, ResultStore& store,
                               const Options& options);

/// The ladder's answer, with positions asked before the horizon only.
LadderAnswer answer_before_horizon(const LadderPlan& plan, const std::vector<LevelRun>& runs,
                                   const PredictabilityAnswer& twins);

void print(const PredictabilityAnswer& answer);
nlohmann::json to_json(const PredictabilityAnswer& answer);

}  // namespace foldproof
