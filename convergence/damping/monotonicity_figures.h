// What the study of monotonicity shows.
#pragma once

#include "convergence/damping/damped_motion.h"

namespace foldproof {

/// First steps and histories of the triangle, histories of the hinge, overshoot on the sheet.
std::vector<Figure> monotonicity_figures(const Subject& subject, const DampedMotions& motions, Tier tier);

}  // namespace foldproof
