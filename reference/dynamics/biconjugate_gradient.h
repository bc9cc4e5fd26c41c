// BiCGSTAB (van der Vorst 1992), for Newton steps with an unsymmetric matrix.
#pragma once

#include "reference/dynamics/newton_matrix.h"
#include "reference/dynamics/solver_settings.h"

namespace foldproof {

/// Solves A dw = r for the free particles from dw = 0; prescribed ones get 0. r: 3 x N momenta [kg
/// m/s]; on exit dw: 3 x N [m/s]. The residual is relative to |r|, in the mass-weighted norm. Two
/// products per iteration. If the iteration breaks down or stalls, dw is its latest iterate, with
/// that iterate's residual.
SolveResult solve_unsymmetric_step(const NewtonMatrix& A, const SolverSettings& settings,
                                   const PerParticle3& r, PerParticle3& dw, Work& work);

}  // namespace foldproof
