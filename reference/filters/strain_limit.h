// Strain limits: springs may not leave [1 - compression, 1 + extension] of their rest length over
// the coming step (BMF03 section 3, after Provot 1995).
#pragma once

#include <span>
#include <vector>

#include "reference/forces/springs.h"
#include "reference/level_set/object.h"
#include "reference/types.h"

namespace foldproof {

/// Order in which springs are corrected.
enum class SweepOrder {
  gauss_seidel,  // one after the other, in the order of their particles
  alternating,   // the same, every other sweep backwards
  // colour by colour, as parallel solvers do: no two springs of a colour share a particle
  coloured,
  // all from the same velocities; each impulse is divided by the number of impulses that
  // meet at its ends
  jacobi
};

/// The range of a spring: lengths from 1 - compression to 1 + extension, over that at rest.
struct StrainRange {
  double extension = 0.10, compression = 0;  // 1

  bool operator==(const StrainRange&) const = default;
};

struct StrainLimits : StrainRange {
  SweepOrder order = SweepOrder::gauss_seidel;
  int sweeps = 20;          // maximum per call
  double tolerance = 1e-3;  // relative violation at which sweeps end [1]
};

/// Data of a spring for the sweeps.
struct LimitedSpring {
  int a, b;
  double rest_length;  // L0 [m]
  int range = 0;       // its place among the limiter's ranges
};

/// The filter: if the predicted length of a spring at the end of a step, |d + h dv|, violates a
/// limit, equal and opposite impulses along the current d bring it back to that limit. Each call
/// conserves linear and angular momentum to rounding. Prescribed particles, and springs within
/// rounding of their limits, are unchanged bit for bit.
struct StrainLimiter {
  StrainLimits limits;
  std::vector<StrainRange> ranges;  // that springs have; without fabrics that of the limits
  // sorted by (colour, a, b); there is one colour if the order is not coloured
  std::vector<LimitedSpring> springs;
  // index in `springs` where each colour begins, then the number of springs
  std::vector<int> colours;
  PerParticle inverse_mass;  // N [1/kg], 0 for prescribed particles

  /// A velocity that only ends a step is limited over the next step, assumed to be as long.
  void correct(const Span& span, const State& s, PerParticle3& v, Work& work) const;
};

/// Sorts and colours the springs. Throws InputError for invalid limits.
///   ranges   of each spring, as in a cloth of several fabrics; none: that of the limits
StrainLimiter make_strain_limiter(const StrainLimits& limits, std::span<const Spring> springs,
                                  const PerParticle& inverse_mass,
                                  std::span<const StrainRange> ranges = {});

/// Result of a call.
struct StrainSweeps {
  int sweeps = 0;  // including the last, which found nothing to do
  /// Largest relative violation of a limit; <= the tolerance unless sweeps ran out or both ends of
  /// the spring are prescribed [1].
  double remaining_violation = 0;
  // springs of the last sweep that no impulse along them can bring within their limits
  long unreachable = 0;
};

/// Corrects v (3 x N [m/s]), which moves x (3 x N [m]) for a step of h [s].
StrainSweeps limit_strain(const StrainLimiter& limiter, double h, const PerParticle3& x,
                          PerParticle3& v);

}  // namespace foldproof
