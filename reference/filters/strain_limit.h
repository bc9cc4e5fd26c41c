// Strain limits: springs may not leave [1 - compression, 1 + extension] of their rest length over
// the coming step (BMF03 section 3, after Provot 1995).
#pragma once

#include <vector>

#include "reference/forces/springs.h"
#include "reference/level_set/object.h"
#include "reference/types.h"

namespace foldproof {

/// In which order springs are corrected.
enum class SweepOrder {
  gauss_seidel,  // one after the other, by the particles that they join
  alternating,   // the same, every other sweep backwards
  // colour by colour, as parallel solvers do: no two springs of a colour share a particle
  coloured,
  // all from the same velocities, each impulse divided by the number of those that meet at its ends
  jacobi
};

struct StrainLimits {
  double extension = 0.10, compression = 0;  // share of the rest length [1]
  SweepOrder order = SweepOrder::gauss_seidel;
  int sweeps = 20;          // the most of one call
  double tolerance = 1e-3;  // violation over the rest length at which sweeps end [1]
};

/// What sweeps need to know of a spring: 16 bytes.
struct LimitedSpring {
  int a, b;
  double rest_length;  // L0 [m]
};

/// The filter: for each spring the length that velocities predict for the end of a step, |d + h
/// dv|, is brought back to the limit that it is beyond, by equal and opposite impulses along the
/// current d. So one call keeps linear and angular momentum, to rounding; prescribed particles, and
/// springs within rounding of their limits, it leaves bit for bit as they are.
struct StrainLimiter {
  StrainLimits limits;
  // sorted by (colour, a, b); there is one colour if the order is not coloured
  std::vector<LimitedSpring> springs;
  std::vector<int> colours;  // where in `springs` each colour begins, and their number at the end
  PerParticle inverse_mass;  // N [1/kg], 0 for prescribed particles

  /// A velocity that only ends a step is limited over the coming one, taken to be as long.
  void correct(const Span& span, const State& s, PerParticle3& v, Work& work) const;
};

/// Sorts and colours the springs. Throws InputError for limits that make no sense.
StrainLimiter make_strain_limiter(const StrainLimits& limits, const std::vector<Spring>& springs,
                                  const PerParticle& inverse_mass);

/// What a call did.
struct StrainSweeps {
  int sweeps = 0;  // the one that found nothing to do included
  /// Largest violation of a limit, over the rest length; <= the tolerance unless sweeps ran out, or
  /// what is left is held at both ends [1].
  double remaining_violation = 0;
  // springs of the last sweep that no impulse along them brings within their limits
  long unreachable = 0;
};

/// Corrects v (3 x N [m/s]), which moves x (3 x N [m]) for a step of h [s].
StrainSweeps limit_strain(const StrainLimiter& limiter, double h, const PerParticle3& x,
                          PerParticle3& v);

}  // namespace foldproof
