// Matrix-free conjugate gradients for the implicit velocity, preconditioned by the masses only
// (BMF03 section 3).
#pragma once

#include "reference/dynamics/newton_matrix.h"
#include "reference/dynamics/system.h"
#include "reference/types.h"

namespace foldproof {

/// Solves (M - s D) w = M w0 for the velocity w of the free particles; prescribed particles
/// (inverse mass 0) keep theirs.
///   v   on entry w0 = v + s M^{-1} F with the known velocities written in; on exit w. 3 x N [m/s]
///   s   half the step [s]
/// In the variable M^{1/2} w the operator I - s M^{-1/2} D M^{-1/2} is symmetric positive definite;
/// the iteration is CG on that operator, written in terms of the masses. It starts from the
/// explicit guess w0, so every iterate differs from it by internal forces only and conserves linear
/// and angular momentum to rounding, however early it stops.
SolveResult solve_velocity(const System& system, const DampingOperator& D, double s,
                           PerParticle3& v, Work& work);

/// Solves A dw = r, A symmetric, for the free particles from dw = 0; prescribed ones get 0. r: 3
/// x N momenta [kg m/s]; on exit dw: 3 x N [m/s]. The residual is relative to |r|. Stops at
/// once, with `indefinite` set, when it meets a direction p with p.A p <= 0: dw is then the
/// latest iterate.
SolveResult solve_newton_step(const NewtonMatrix& A, const SolverSettings& settings,
                              const PerParticle3& r, PerParticle3& dw, Work& work);

}  // namespace foldproof
