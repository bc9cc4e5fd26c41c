// The list of all checks: those of each file checks/<room>/<name>_checks.cpp, which defines
// std::vector<Check> <name>_checks(). CMakeLists.txt makes it.
#pragma once

#include <vector>

#include "verification/verdict.h"

namespace foldproof {

std::vector<Check> all_checks();

}  // namespace foldproof
