// Parts of the study monotonicity: hinges without stiffness, overdamped sheets, figures.
#pragma once

#include "convergence/damping/damped_motion.h"
#include "convergence/study.h"
#include "verification/subject.h"

namespace foldproof {

// Coming to rest where the damping changes with the shape: a hinge that unfolds.

/// Adds findings and a table to the study monotonicity.
void add_nonlinear_hinge(const Subject& subject, const DampedMotion& hinge, StudyResult& result);

// Coming to rest against stiffness that damping outweighs: does a method overshoot?

/// Adds findings, figures and a table to the study monotonicity.
void add_overdamped(const Subject& subject, Tier tier, StudyResult& result);

// Motions to rest against stiffness that damping outweighs: a sheet in all its modes, a hinge
// that closes far.

/// A flat, free sheet with springs and hinges, whose modes are all damped more than four times
/// critically. Each starts displaced by its way and moving towards rest, so that half of the way
/// decays at its fast rate and half at its slow one: positions and velocities both fall without a
/// turn. rate: the fastest mode's c.
DampedMotion overdamped_sheet(int cells);

/// A hinge bent by nearly two radians beyond its rest angle, with one triangle held, released;
/// springs and hinge overdamped. Not linear. Its way is that back to the rest angle, and its speed
/// is over way times rate.
DampedMotion closing_hinge();

// Results of the study of monotonicity.

/// First steps and histories of the triangle, histories of the hinge, overshoot on the sheet.
std::vector<Figure> monotonicity_figures(const Subject& subject, const DampedMotions& motions,
                                         Tier tier);

}  // namespace foldproof
