#pragma once

#include "verification/oracles/estimate.h"

namespace foldproof::oracles {

/// Position of a strip's free tip, in units of the strip's length [1].
struct CantileverTip {
  Estimate drop;   // H/L, how far below the clamp
  Estimate reach;  // W/L, how far out from the clamp
};

/// Equilibrium of an inextensible strip clamped level at one end and bent by its own weight (the
/// heavy elastica): theta'' = -gamma (1 - s) cos(theta), theta(0) = 0, theta'(1) = 0. Here theta is
/// the slope below the horizontal, s the arc length from the clamp, and gamma = rho_A g L^3/B [1]
/// in (0, 1e5], else InputError. The branch without loops. By shooting from the tip with GSL's ODE
/// and root solvers; the uncertainty includes that of both.
CantileverTip heavy_cantilever(double gamma);

}  // namespace foldproof::oracles
