// How fast the steps of BDF2 may grow: a part of variable-step-stability.
#pragma once

#include "verification/subject.h"
#include "convergence/study.h"

namespace foldproof {

std::vector<NamedFinding> bdf2_growing_steps(const Subject& subject);

}  // namespace foldproof
