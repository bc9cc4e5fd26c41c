// How far two runs of the same cloth are apart: root mean squares over the particles, by mass.
#pragma once

#include <vector>

#include "reference/types.h"

namespace foldproof {

/// The longest side of the box around x, 3 x N [m].
double longest_side(const PerParticle3& x);

/// The root mean square over the particles of |u_i|, by mass (N [kg], some > 0), in the unit of u.
double mean_square_root(const PerParticle3& u, const PerParticle& mass);

/// The largest distance over the frames that both runs have, each 3 x N [m]; 0 without a frame, NaN
/// where a position is none.
double largest_difference(const std::vector<PerParticle3>& a, const std::vector<PerParticle3>& b,
                          const PerParticle& mass);

/// The largest distance of a run from its first frame [m].
double largest_motion(const std::vector<PerParticle3>& x, const PerParticle& mass);

}  // namespace foldproof
