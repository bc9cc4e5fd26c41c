// A ring of thin plate, clamped level along its inner edge, that sags slightly under its weight.
#pragma once

#include "verification/oracles/estimate.h"

namespace foldproof::oracles {

struct RingPlate {
  double inner;    // radius of the clamped edge over that of the free one, in (0, 1)
  double poisson;  // of bending, in (-1, 1]
};

/// Sag of the free edge, times rigidity/(weight per area times its radius^4) [1]: Kirchhoff's small
/// deflections. By formula: w = r^4/64 + a + b ln(r) + c r^2 + d r^2 ln(r) with w = w' = 0 at the
/// inner edge, and neither moment nor shear at the outer one. By energy: the minimum over
/// polynomials (r - inner)^2 p(r).
Estimate sag_of_ring_by_formula(const RingPlate& plate);
Estimate sag_of_ring_by_energy(const RingPlate& plate);

}  // namespace foldproof::oracles
