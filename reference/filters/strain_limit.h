// Strain limits: springs may not leave [1 - compression, 1 + extension] of their rest length over the coming step
// (BMF03 section 3, after Provot 1995).
#pragma once

#include <vector>

#include "reference/forces/springs.h"
#include "reference/level_set/object.h"
#include "reference/types.h"

namespace foldproof {

/// The order in which springs are corrected: one after the other in a fixed order; colour by colour, no two springs
/// of a colour sharing a particle, so that threads may share a colour; or all from the same velocities.
enum class SweepOrder { gauss_seidel, coloured, jacobi };

struct StrainLimits {
  double extension = 0.10, compression = 0;  // share of the rest length [1]
  SweepOrder order = SweepOrder::gauss_seidel;
  int sweeps = 20;          // the most of one call
  double tolerance = 1e-3;  // violation over the rest length at which sweeps end [1]
  int threads = 1;          // of coloured sweeps; the result does not depend on it
};

/// The filter.
struct StrainLimiter {
  StrainLimits limits;
  std::vector<Spring> springs;
  PerParticle inverse_mass;  // N [1/kg], 0 for prescribed particles

  void correct(const Span& span, const State& s, PerParticle3& v, Work& work) const;
};

}  // namespace foldproof
