#include "reference/dynamics/conjugate_gradient.h"

#include <cmath>

namespace foldproof {

namespace {

/// sum_i |r_i|^2/m_i over free particles, the squared mass-weighted norm of a momentum r.
double squared_norm(const PerParticle3& r, const PerParticle& inverse_mass) {
  return r.colwise().squaredNorm().dot(inverse_mass.transpose());
}

/// D p at free particles, 0 at prescribed ones.
void damping_product(const DampingOperator& damping, const PerParticle3& p, const PerParticle& inverse_mass,
                     PerParticle3& Dp, Work& work) {
  Dp.setZero();
  damping.add_product(p, Dp);
  for (Eigen::Index i = 0; i < inverse_mass.size(); ++i)
    if (inverse_mass[i] == 0) Dp.col(i).setZero();
  ++work.damping_products;
}

double squared_momentum(const PerParticle3& v, const PerParticle& mass, const PerParticle& inverse_mass) {
  double sum = 0;
  for (Eigen::Index i = 0; i < mass.size(); ++i)
    if (inverse_mass[i] != 0) sum += mass[i] * v.col(i).squaredNorm();
  return sum;
}

Solve record(Solve solve, Work& work) {
  ++work.solves;
  work.cg_iterations += solve.iterations;
  if (!solve.converged) ++work.unfinished_solves;
  keep_worst(work.worst_residual, solve.residual);
  return solve;
}

}  // namespace

Solve solve_velocity(const DampingOperator& damping, double s, const PerParticle& mass,
                     const PerParticle& inverse_mass, const SolverSettings& settings, PerParticle3& v,
                     Work& work) {
  PerParticle3 q(3, v.cols());

  // the residual of the explicit guess: b - (M - s D) w0 = s D w0
  damping_product(damping, v, inverse_mass, q, work);
  PerParticle3 r = s * q;
  double rr = squared_norm(r, inverse_mass);
  const double scale_squared =
      settings.scale == ResidualScale::momentum ? squared_momentum(v, mass, inverse_mass) : rr;
  const double scale = scale_squared > 0 ? std::sqrt(scale_squared) : 1;
  double residual = std::sqrt(rr) / scale;

  PerParticle3 p = r * inverse_mass.asDiagonal();
  int iterations = 0;
  while (residual > settings.tolerance && iterations < settings.max_iterations) {
    // q = (M - s D) p
    damping_product(damping, p, inverse_mass, q, work);
    q = p * mass.asDiagonal() - s * q;

    const double alpha = rr / p.cwiseProduct(q).sum();
    v += alpha * p;
    r -= alpha * q;

    const double rr_before = rr;
    rr = squared_norm(r, inverse_mass);
    p = r * inverse_mass.asDiagonal() + (rr / rr_before) * p;
    residual = std::sqrt(rr) / scale;
    ++iterations;
  }
  return record({iterations, residual, residual <= settings.tolerance}, work);
}

}  // namespace foldproof
