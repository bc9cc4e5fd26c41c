// Checks of sticking. One function a file, and their sum.
#pragma once

#include <vector>

#include "verification/verdict.h"

namespace foldproof {

std::vector<Check>
sticking_force_checks();  // sticking_force_checks.cpp: forces against the oracle, what they keep
std::vector<Check> sticking_motion_checks();  // sticking_motion_checks.cpp: what is carried, and how it lags
std::vector<Check> sticking_bond_checks();   // sticking_bond_checks.cpp: what forms, breaks and is remembered
std::vector<Check> sticking_scene_checks();  // sticking_scene_checks.cpp: what a case file says of it

/// All of the above, in this order.
std::vector<Check> sticking_checks();

}  // namespace foldproof
