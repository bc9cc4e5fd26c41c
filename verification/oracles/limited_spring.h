#pragma once

#include "reference/types.h"

namespace foldproof::oracles {

/// A spring, the motion of its ends, and the limits of its predicted length.
struct LimitedSpringInput {
  Vector3 x_a, x_b, v_a, v_b;             // m, m/s
  double inverse_mass_a, inverse_mass_b;  // 1/kg, 0 for prescribed ends
  double step;                            // h [s]
  double shortest, longest;               // m
};

struct LimitedSpringAnswer {
  Vector3 v_a, v_b;         // m/s
  double length;            // predicted from v_a and v_b [m]
  bool is_violated = true;  // false: within the limits, nothing changes
  bool is_reachable = true;
  // change of the answer along d per change of the given motion across it, at least 1 [1]
  double sensitivity = 1;
};

/// Equal and opposite impulses along d = x_b - x_a that bring |d + h (v_b - v_a)| back to the
/// violated limit (BMF03 section 3, after Provot 1995), or as near to it as possible, with (d + h
/// dv).d >= 0 afterwards. By Pythagoras in 50 digits: the part across d stays, the part along d
/// becomes the other leg.
LimitedSpringAnswer limited_spring(const LimitedSpringInput& input);

}  // namespace foldproof::oracles
