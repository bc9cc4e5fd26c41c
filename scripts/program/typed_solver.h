// Another solver, as --solver and its options say how to start it.
#pragma once

#include "scripts/program/options.h"
#include "verification/subjects/pipe/piped_solver.h"

namespace foldproof {

/// Throws InputError for a setting that is not KEY=VALUE.
SolverCommand solver_command(const Options& options);

}  // namespace foldproof
