// Parts of the study monotonicity: overdamped sheets, figures.
#pragma once

#include "convergence/damping/damped_motion.h"
#include "convergence/study.h"

namespace foldproof {

// Coming to rest against stiffness that damping outweighs: does a method overshoot?

/// Adds findings, figures and a table to the study monotonicity.
void add_overdamped(const Subject& subject, Tier tier, StudyResult& result);

// Results of the study of monotonicity.

/// First steps and histories of the triangle, histories of the hinge, overshoot on the sheet.
std::vector<Figure> monotonicity_figures(const Subject& subject, const DampedMotions& motions,
                                         Tier tier);

}  // namespace foldproof
