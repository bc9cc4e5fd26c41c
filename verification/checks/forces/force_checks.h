// Checks of springs and gravity, and of what all forces together promise. One function a file, and their sum.
#pragma once

#include <vector>

#include "verification/verdict.h"

namespace foldproof {

std::vector<Check> spring_checks();  // spring_checks.cpp

/// Springs, gravity, and the bound on frequencies.
std::vector<Check> force_checks();

}  // namespace foldproof
