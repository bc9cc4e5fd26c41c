// The runs of another solver for `foldproof converge --solver`.
#pragma once

#include <vector>

#include "convergence/any_case/solver_ladder.h"

namespace foldproof {

/// The runs of so many levels, coarse to fine, one after the other. None is kept in a store: the
/// program behind the command may change. Throws InputError if the first comes to no end.
std::vector<LevelRun> run_solver(SolverLadder& ladder, int levels);

}  // namespace foldproof
