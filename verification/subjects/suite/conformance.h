// The protocol itself, tried on an adapter: what its author runs first.
#pragma once

#include <string>
#include <vector>

#include "verification/subjects/pipe/piped_solver.h"

namespace foldproof {

enum class Conformity { kept, declined, broken };

/// One demand of the protocol, and what the solver did.
struct ConformanceRow {
  std::string demand;
  Conformity conformity;
  std::string note;  // reason of a refusal, or cause of a failure; may be empty
};

/// Tries each operation of the declared level on a small sheet. Stops at the first broken one.
/// Throws InputError if there is no such program.
std::vector<ConformanceRow> check_conformance(const SolverCommand& command);

}  // namespace foldproof
