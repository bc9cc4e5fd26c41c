// Checks of cloth against itself.
#pragma once

#include <vector>

#include "verification/verdict.h"

namespace foldproof {

std::vector<Check> repulsion_checks();  // repulsion_checks.cpp: layers within the thickness
std::vector<Check> impact_checks();     // impact_checks.cpp: motion without crossings, rigid zones

/// All of the above, in this order.
std::vector<Check> self_collision_checks();

}  // namespace foldproof
