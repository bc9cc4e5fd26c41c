#pragma once

#include <vector>

#include "verification/check.h"

namespace foldproof {

std::vector<Check> scene_refusal_checks();  // scene_refusal_checks.cpp: what a case file may not say
std::vector<Check> scene_meaning_checks();  // scene_checks.cpp: what is built of what it says

/// Both.
std::vector<Check> scene_checks();

}  // namespace foldproof
