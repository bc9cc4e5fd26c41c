// Checks of how near two features of a cloth are; whether moving ones meet is the study crossing-queries.
#pragma once

#include <vector>

#include "verification/verdict.h"

namespace foldproof {

std::vector<Check> crossing_checks();

}  // namespace foldproof
