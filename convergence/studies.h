// The list of all studies.
#pragma once

#include "convergence/study.h"

namespace foldproof {

/// In the order in which they are reported. Written by list_studies.cmake from the definitions.
std::vector<Study> all_studies();

}  // namespace foldproof
