// Coming to rest where the damping changes with the shape: a hinge that unfolds.
#pragma once

#include "convergence/damping/damped_motion.h"

namespace foldproof {

/// Adds findings and a table to the study monotonicity.
void add_nonlinear_hinge(const Subject& subject, const DampedMotion& hinge, StudyResult& result);

}  // namespace foldproof
