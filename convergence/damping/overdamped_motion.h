// Motions to rest against stiffness that damping outweighs: a sheet in all its modes, a hinge that closes
// far.
#pragma once

#include "convergence/damping/damped_motion.h"

namespace foldproof {

/// A flat, free sheet with springs and hinges, every mode of which is damped more than four times critically.
/// Each starts displaced by its way and moving towards rest, so that half of the way decays at its fast rate
/// and half at its slow one: positions and velocities both fall without a turn. rate: the fastest mode's c.
DampedMotion overdamped_sheet(int cells);

/// A hinge bent by nearly two radians beyond its rest angle, one triangle of which is held, let go; springs
/// and hinge overdamped. Not linear. Its way is that back to the rest angle, and its speed is over way times
/// rate.
DampedMotion closing_hinge();

}  // namespace foldproof
