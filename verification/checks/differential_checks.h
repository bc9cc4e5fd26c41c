// Checks of the elastic forces' derivative, which the fully implicit methods use.
#pragma once

#include <vector>

#include "verification/check.h"

namespace foldproof {

std::vector<Check> differential_checks();

/// Of the derivative of all forces, damping included, at given velocities.
std::vector<Check> force_differential_checks();

}  // namespace foldproof
