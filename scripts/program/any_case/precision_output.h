// The answers of `foldproof precision` as tables for a reader and as JSON for a program.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <utility>
#include <vector>

#include "convergence/any_case/precision.h"
#include "convergence/any_case/solver_precision.h"
#include "scripts/program/command_line/options_of_commands.h"

namespace foldproof {

void print(const PrecisionAnswer& answer, const Trials& trials, const Options& options);
nlohmann::json to_json(const PrecisionAnswer& answer, const Options& options);

/// Another solver's answer, and how it understood the case.
struct SolverAnswer {
  SolverPrecision precision;
  std::vector<std::pair<std::string, std::string>> mapping;
};

/// case_end: of the case, until which the reference's steps may not have been tried [s].
void print(const SolverAnswer& solver, const PrecisionAnswer& reference, double case_end);
nlohmann::json to_json(const SolverAnswer& solver, const PrecisionAnswer& reference);

}  // namespace foldproof
