// Explicit Runge-Kutta methods, against which BMF03 section 3 compares its schemes. Positions and
// velocities are both explicit, so damping limits the step as well as elasticity does.
#pragma once

#include <span>

#include "reference/dynamics/system.h"

namespace foldproof {

/// Forward Euler: first order; unstable for undamped motion at any step.
State forward_euler(const System& system, std::span<const State> past, double h, Work& work);

/// Explicit midpoint rule (RK2): second order; undamped motion grows slowly, by (omega
/// h)^4/8 per step.
State explicit_midpoint(const System& system, std::span<const State> past, double h, Work& work);

/// Strong-stability-preserving RK3 of Shu and Osher (1988): third order; undamped stable for
/// omega h <= sqrt(3).
State ssp_runge_kutta_3(const System& system, std::span<const State> past, double h, Work& work);

/// The classical RK4: fourth order; undamped stable for omega h <= 2 sqrt(2), pure damping
/// for c h <= 2.785.
State runge_kutta_4(const System& system, std::span<const State> past, double h, Work& work);

}  // namespace foldproof
