// The list of checks, written out by hand.
#pragma once

#include <vector>

#include "verification/verdict.h"

namespace foldproof {

std::vector<Check> all_checks();

}  // namespace foldproof
