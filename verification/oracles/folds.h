#pragma once

#include <functional>
#include <span>
#include <vector>

#include "verification/oracles/elastica.h"
#include "verification/oracles/estimate.h"

namespace foldproof::oracles {

/// A strip that lies on a smooth floor from its first end, lifts off, and bends back over itself to
/// its last end, which is held. The thickness is neglected.
struct Fold {
  Estimate lift_off;  // arc length that lies on the floor, over L [1]
  Estimate height;    // of the highest point, over L [1]
};

/// The strip from an arc length on, with its remaining length as the unit.
HeavyStrip lifted_part(const HeavyStrip& strip, double lift_off);

using StripSolver = std::function<StripShape(const HeavyStrip&, std::span<const double>)>;

/// Where the strip lifts off there is no moment: the curvature at the first end of the lifted part,
/// as found by `solver`, vanishes. GSL's root solver starts from two arc lengths at which that
/// curvature has opposite signs (else InputError). The height is the top of the parabola through
/// the highest three of 2001 points. The strip's first slope must be 0.
Fold fold_on_floor(const HeavyStrip& strip, double least, double most, const StripSolver& solver);

/// A long strip on a smooth floor, folded back over itself; it lies on its own lower half, held by
/// nothing. All lengths are in units of (B/(rho_A g))^(1/3).
///
/// The lifted part obeys theta'' = (V - s) cos(theta), with V the floor's push where it lifts off;
/// as the floor is smooth there is no horizontal force. At lift-off and touchdown theta' = 0, with
/// the slopes 0 and pi. It then touches down at floor height, since theta'^2/2 + (s - V) sin(theta)
/// - y is constant along the strip.
struct FreeFold {
  Estimate push;                   // V, over (B^2 rho_A g)^(1/3)
  Estimate lifted;                 // arc length
  Estimate height;                 // of the highest point
  std::vector<StripPoint> points;  // 2001 at equal arc lengths
};

/// By collocation, with V and the length unknown too: 48 nodes and 72, which must agree.
FreeFold free_fold_by_collocation();

/// By shooting from the lift-off with GSL's ODE solver; V and the length by Newton's method.
FreeFold free_fold_by_shooting();

}  // namespace foldproof::oracles
