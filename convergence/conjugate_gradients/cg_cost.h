// Cost of one setting of the sheet in iterations of conjugate gradients, and what
// theory allows it to.
#pragma once

#include "verification/subject.h"

namespace foldproof {

/// Parameters that determine the cost of a solve.
struct Setting {
  double tolerance;  // 1
  double ratio;      // damping ratio of the fastest mode [1]
  double step;       // h over the elastic limit [1]
  int cells;         // along each side
  ResidualScale scale;
};

/// Cost of the solves of some steps with A and with B, which have one solve a step each: A at its
/// end, B at its start. C has both.
struct Cost {
  double mean = 0;     // iterations a solve
  double largest = 0;  // iterations of one solve
  double unfinished = 0;
};

/// Runs some steps of a hanging sheet that moves with waves and noise.
Cost cost_of(const Subject& subject, const Setting& setting);

/// The most iterations of a solve whose residual is compared with the initial one. D is at most 2
/// zeta/omega times the elastic stiffness, so that the condition of I - h/2 M^{-1} D is at most
/// kappa = 1 + 2 zeta h/h_limit; then Chebyshev's bound on the energy norm, times the sqrt(kappa)
/// that it costs to speak of residuals:
///   2 sqrt(kappa) ((sqrt(kappa) - 1)/(sqrt(kappa) + 1))^n <= tolerance
double iterations_allowed(const Setting& setting);

/// Number of particles of the sheet.
double particles_of(const Setting& setting);

}  // namespace foldproof
