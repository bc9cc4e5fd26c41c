// Another solver in `foldproof precision --solver`.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "convergence/any_case/solver_ladder.h"
#include "convergence/any_case/solver_precision.h"
#include "scripts/program/options.h"

namespace foldproof {

/// The solver of one call, on its case. No run of it is kept: the program behind the
/// command may change.
class PrecisionOfSolver {
 public:
  /// Starts it. Throws InputError for a case that the protocol cannot say, or that the solver
  /// does not offer.
  PrecisionOfSolver(const Options& options, const PrecisionPlan& plan,
                    const LevelSetProvider& level_sets);

  /// Runs it with steps that are halved. times: of the frames of the reference's truth. Throws
  /// InputError if it declines the case.
  SolverPrecision answer(const PrecisionAnswer& reference, const std::vector<double>& times);

  const std::vector<std::pair<std::string, std::string>>& mapping() const {
    return solver_.mapping();
  }

 private:
  SolverPlan plan_of(const PrecisionAnswer& reference);

  double most_seconds_;
  Trial solver_;
  SolverLadder ladder_;
};

nlohmann::json to_json(const SolverPrecision& solver, const PrecisionAnswer& reference);

void print(const SolverPrecision& solver, const PrecisionAnswer& reference);

}  // namespace foldproof
