// Methods implicit in the elastic forces too, against which BMF03 section 3 compares its schemes.
// Each step of the nonlinear ones solves one stage equation
//   w:  M (w - V) = s (F_elastic(t, X + s w) + D(X + s w) w)
// in which X, V, s and t depend on the method.
#pragma once

#include <span>

#include "reference/dynamics/system.h"

namespace foldproof {

/// Backward Euler, fully implicit: first order, unconditionally stable, damps every motion.
/// Newton's method.
State backward_euler(const System& system, std::span<const State> past, double h, Work& work);

/// Backward Euler with the forces linearised about the start of the step: one linear solve (Baraff
/// and Witkin 1998), the elastic derivative made semidefinite. First order.
State linearised_backward_euler(const System& system, std::span<const State> past, double h,
                                Work& work);

/// BDF2 with the coefficients of variable steps. Second order; zero-stable while no step exceeds
/// 1 + sqrt(2) times the one before. Needs two states; with one it takes the implicit midpoint
/// rule, whose local error O(h^3) keeps the order.
State bdf2(const System& system, std::span<const State> past, double h, Work& work);

/// Implicit midpoint rule: second order, symplectic, no numerical damping; conserves linear and
/// angular momentum.
State implicit_midpoint(const System& system, std::span<const State> past, double h, Work& work);

}  // namespace foldproof
