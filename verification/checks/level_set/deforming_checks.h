// Checks of bodies that deform: their level sets at frames and between them.
#pragma once

#include <vector>

#include "verification/verdict.h"

namespace foldproof {

std::vector<Check> deforming_checks();

}  // namespace foldproof
