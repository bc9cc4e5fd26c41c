// Checks of strain limits (BMF03 section 3, after Provot 1995).
#pragma once

#include <vector>

#include "verification/verdict.h"

namespace foldproof {

std::vector<Check> strain_step_checks();  // strain_step_checks.cpp: steps, sweeps, colours, case files

/// One correction, and all of the above.
std::vector<Check> strain_limit_checks();

}  // namespace foldproof
