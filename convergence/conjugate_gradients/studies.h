// The studies of this room: what does a solve cost, and how loose may it be?
#pragma once

#include "convergence/study.h"

namespace foldproof {

Study cg_iterations_study();  // cg-iterations: cost of the implicit solves
// solve-tolerance: how loose a solve may be before the order suffers
Study solve_tolerance_study();

}  // namespace foldproof
