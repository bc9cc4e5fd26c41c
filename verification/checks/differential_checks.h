// Checks of the elastic forces' derivative, which the fully implicit methods use.
#pragma once

#include <vector>

#include "verification/check.h"

namespace foldproof {

std::vector<Check> differential_checks();

}  // namespace foldproof
