// Coming to rest against stiffness that damping outweighs: does a method overshoot?
#pragma once

#include "verification/subject.h"

namespace foldproof {

/// Adds findings, figures and a table to the study monotonicity.
void add_overdamped(const Subject& subject, Tier tier, StudyResult& result);

}  // namespace foldproof
