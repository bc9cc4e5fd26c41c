// The list of all studies; each is declared in the studies.h of its room.
#pragma once

#include <vector>

#include "convergence/study.h"

namespace foldproof {

/// In the order in which they are reported.
std::vector<Study> all_studies();

}  // namespace foldproof
