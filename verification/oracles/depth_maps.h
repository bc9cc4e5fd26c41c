// The depth maps of the fold-preserving projection, from their defining conditions, in 50 digits.
#pragma once

#include "verification/oracles/estimate.h"

namespace foldproof::oracles {

/// The band of a map [m]: eps, tau and t^.
struct Band {
  double nearest, reach, deepest;
};

/// f(phi) = eps + (tau - eps) u^p with the exponent found from f'(tau) = 1. Valid for -t^ <= phi <=
/// tau [m].
Estimate power_map(const Band& band, double phi);

/// The map whose slope is m from -t^ on and rises from m to 1 over the last w = (tau - eps)/2,
/// where m makes f climb from eps to tau; found by integrating the slope from -t^. Valid for -t^ <=
/// phi <= tau [m].
Estimate blend_map(const Band& band, double phi);

}  // namespace foldproof::oracles
