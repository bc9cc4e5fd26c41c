#pragma once

#include <vector>

#include "verification/check.h"

namespace foldproof {

/// Checks of the conjugate gradients for the implicit velocity (BMF03 section 3).
std::vector<Check> solver_checks();

}  // namespace foldproof
