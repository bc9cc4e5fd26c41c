// Checks that run for each of the paper's schemes.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "verification/verdict.h"

namespace foldproof {

/// One check for each of the paper's schemes A, B and C, its name ended by a dot and the scheme's.
void add_for_each_scheme(
    std::vector<Check>& list, const Check& pattern,
    const std::function<Finding(const Subject&, const std::string& integrator)>& run);

}  // namespace foldproof
