#pragma once

#include <functional>
#include <span>

#include "verification/oracles/elastica.h"
#include "verification/oracles/estimate.h"

namespace foldproof::oracles {

/// A strip that lies on a smooth floor from its first end, lifts off, and bends back over itself to
/// its last end, which is held (its thickness counts for nothing).
struct Fold {
  Estimate lift_off;  // arc length that lies on the floor, over L [1]
  Estimate height;    // of the highest point, over L [1]
};

/// The strip from an arc length on, with the rest of it as its own unit of length.
HeavyStrip lifted_part(const HeavyStrip& strip, double lift_off);

using StripSolver = std::function<StripShape(const HeavyStrip&, std::span<const double>)>;

/// Where the strip lifts off there is no moment: the curvature at its first end, as found by the
/// solver (strip_by_collocation or strip_by_shooting), vanishes. By GSL's root solver between two
/// arc lengths at which that curvature has opposite signs (else InputError); the height is that of
/// the parabola through the highest three of 2001 points. The strip's first slope must be 0.
Fold fold_on_floor(const HeavyStrip& strip, double least, double most, const StripSolver& solver);

}  // namespace foldproof::oracles
