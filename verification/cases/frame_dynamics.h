// Laws of dynamics that frames of any program must meet: do they fall, start and slow down as cloth
// does that nothing but the case moves?
#pragma once

#include "verification/cases/frame_motion.h"

namespace foldproof {

// Each throws NotOffered where the frames, or the case, lack what it needs.

/// Until the cloth comes near an object, its centre of mass is on the parabola of the case's start
/// velocity and gravity.
Finding centre_falls_freely(const FrameMotion& motion);

/// Kinetic and potential energy never exceed the start's total.
Finding motion_stays_in_budget(const FrameMotion& motion);

/// Where the centre does not fall freely: it moves as far, and there, in the first frames as that
/// of the reference, which runs for them.
Finding starts_as_the_reference(const FrameMotion& motion);

}  // namespace foldproof
