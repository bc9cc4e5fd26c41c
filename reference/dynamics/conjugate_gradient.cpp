#include "reference/dynamics/conjugate_gradient.h"

#include <cmath>
#include <functional>

#include "reference/fast/vectors.h"

namespace foldproof {

namespace {

/// q = A p for a symmetric positive definite A on free particles; 0 at prescribed
/// ones. Returns p.q.
using Product = std::function<double(const PerParticle3& p, PerParticle3& q)>;

/// A linear system for the free particles, and when its solution is good enough.
struct Problem {
  Product A;
  const PerParticle& inverse_mass;
  const SolverSettings& settings;
  double scale;  // the residual is relative to this norm [kg^1/2 m/s]
  Team team = {};
};

/// Adds to v the solution of A w = r by conjugate gradients, preconditioned with the masses: the
/// plain iteration in the variable M^{1/2} w.
SolveResult iterate(const Problem& of, PerParticle3 r, PerParticle3& v) {
  const auto inverse_mass = of.inverse_mass.asDiagonal();
  double rr = first_squared_norm(of.team, r, of.inverse_mass);
  double residual = std::sqrt(rr) / of.scale;
  int iterations = 0;

  PerParticle3 p = r * inverse_mass, q(3, r.cols());
  while (residual > of.settings.tolerance && iterations < of.settings.max_iterations) {
    const double curvature = of.A(p, q);
    if (curvature <= 0) return {iterations, residual, false, true};

    const double alpha = rr / curvature, rr_before = rr;
    set(of.team, v, v + alpha * p);
    set(of.team, r, r - alpha * q);
    rr = squared_norm(of.team, r, of.inverse_mass);
    set(of.team, p, r * inverse_mass + (rr / rr_before) * p);
    residual = std::sqrt(rr) / of.scale;
    ++iterations;
  }
  return {iterations, residual, residual <= of.settings.tolerance, false};
}

double positive_or_one(double scale) { return scale > 0 ? scale : 1; }

}  // namespace

SolveResult solve_velocity(const System& system, const DampingOperator& D, double s,
                           PerParticle3& v, Work& work) {
  if (D.empty()) {  // w = w0
    ++work.damping_products, ++work.solves;
    return {0, 0, true, false};
  }
  const auto &mass = system.mass, &inverse_mass = system.inverse_mass;
  const auto damping_product = [&](const PerParticle3& p, PerParticle3& q) {  // q = D p
    set(system.team, q, PerParticle3::Zero(3, p.cols()));
    D.add_product(p, q);
    ++work.damping_products;
  };
  const Product A = [&](const PerParticle3& p, PerParticle3& q) {  // q = (M - s D) p
    damping_product(p, q);
    set(system.team, q, p * mass.asDiagonal() - s * q);
    clear_prescribed(inverse_mass, q);
    return dot(system.team, p, q);
  };

  // the residual of the explicit guess: b - (M - s D) w0 = s D w0
  PerParticle3 r;
  damping_product(v, r);
  set(system.team, r, s * r);
  clear_prescribed(inverse_mass, r);
  const double scale_squared = system.solver.scale == ResidualScale::momentum
                                   ? squared_momentum(system.team, v, mass, inverse_mass)
                                   : first_squared_norm(system.team, r, inverse_mass);
  const Problem problem{A, inverse_mass, system.solver, positive_or_one(std::sqrt(scale_squared)),
                        system.team};
  const SolveResult solve = iterate(problem, r, v);
  ++work.solves;
  work.cg_iterations += solve.iterations;
  if (!solve.converged) ++work.unfinished_solves;
  update_worst(work.worst_residual, solve.residual);
  return solve;
}

SolveResult solve_newton_step(const NewtonMatrix& matrix, const SolverSettings& settings,
                              const PerParticle3& r, PerParticle3& dw, Work& work) {
  const Product A = [&](const PerParticle3& p, PerParticle3& q) {
    multiply(matrix, p, q, work);
    return p.cwiseProduct(q).sum();
  };
  dw.setZero(3, r.cols());
  const double scale = positive_or_one(std::sqrt(first_squared_norm({}, r, matrix.inverse_mass)));
  const SolveResult solve = iterate({A, matrix.inverse_mass, settings, scale}, r, dw);
  ++work.solves;
  work.cg_iterations += solve.iterations;
  return solve;
}

}  // namespace foldproof
