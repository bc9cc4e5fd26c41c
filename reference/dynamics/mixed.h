// Schemes A, B and C of BMF03 section 3: positions explicit, velocities implicit in
// the damping only.
#pragma once

#include <span>

#include "reference/dynamics/system.h"

namespace foldproof {

/// Scheme A (first list). Second order; on linear problems stable for h < 2/omega with any damping.
/// One solve a step.
State mixed_explicit_implicit(const System& system, std::span<const State> past, double h,
                              Work& work);

/// Scheme B (second list), central Newmark. Second order as a one-step map; one solve a step.
State central_newmark(const System& system, std::span<const State> past, double h, Work& work);

/// Scheme C (last list), the one the paper recommends. Second order for any step
/// sequence; two solves a step.
State variable_step_newmark(const System& system, std::span<const State> past, double h,
                            Work& work);

}  // namespace foldproof
