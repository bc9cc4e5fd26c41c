#pragma once

#include <vector>

#include "verification/verdict.h"

namespace foldproof {

/// Checks of the conjugate gradients for the implicit velocity (BMF03 section 3).
std::vector<Check> solver_checks();

/// Checks of the solver for Newton steps whose matrix is not symmetric.
std::vector<Check> unsymmetric_solver_checks();

/// What caching the position-dependent terms saves, in time and memory.
std::vector<Check> cached_terms_checks();

}  // namespace foldproof
