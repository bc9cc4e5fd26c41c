#pragma once

#include "verification/oracles/estimate.h"

namespace foldproof::oracles {

/// Position of the free end of a strip, in units of the strip's length [1].
struct LoadedTip {
  Estimate drop;   // below the clamp
  Estimate reach;  // out from the clamp
};

/// Equilibrium of a weightless inextensible strip clamped level at one end, with a dead load P on
/// the other that keeps its direction, down (Bisshopp and Drucker 1945): theta'' = -alpha
/// cos(theta), theta(0) = 0, theta'(1) = 0, with theta the slope below the horizontal, s the arc
/// length over L, alpha = P L^2/(B width) [1] in (0, 100], else InputError. By elliptic integrals:
///   sqrt(alpha) = K(k) - F(phi, k),   2 k^2 = 1 + sin(theta(1)),   sin(phi) = 1/(k sqrt 2)
///   drop = 1 - 2 (E(k) - E(phi, k))/sqrt(alpha),   reach = sqrt(2 sin(theta(1))/alpha)
LoadedTip tip_load(double alpha);

/// The same by GSL's ODE solver, shooting with the curvature at the clamp: shares no formula
/// with the above.
LoadedTip tip_load_by_shooting(double alpha);

}  // namespace foldproof::oracles
