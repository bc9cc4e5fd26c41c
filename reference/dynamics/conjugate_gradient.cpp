#include "reference/dynamics/conjugate_gradient.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace foldproof {

namespace {

/// sum_i |r_i|^2/m_i over free particles, the squared mass-weighted norm of a momentum r.
double squared_norm(const Eigen::Ref<const PerParticle3>& r,
                    const Eigen::Ref<const PerParticle>& inverse_mass) {
  return r.colwise().squaredNorm().dot(inverse_mass.transpose());
}

/// The sum of part(first, count) over blocks of particles, block by block: a long sum
/// rounds less so.
template <class Part>
double sum_of_blocks(Eigen::Index particles, const Part& part) {
  constexpr Eigen::Index block = 512;
  double sum = 0;
  for (Eigen::Index first = 0; first < particles; first += block)
    sum += part(first, std::min(block, particles - first));
  return sum;
}

/// D p at free particles, 0 at prescribed ones.
void damping_product(const DampingOperator& damping, const PerParticle3& p,
                     const PerParticle& inverse_mass, PerParticle3& Dp, Work& work) {
  Dp.setZero();
  damping.add_product(p, Dp);
  for (Eigen::Index i = 0; i < inverse_mass.size(); ++i)
    if (inverse_mass[i] == 0) Dp.col(i).setZero();
  ++work.damping_products;
}

double squared_momentum(const PerParticle3& v, const PerParticle& mass,
                        const PerParticle& inverse_mass) {
  double sum = 0;
  for (Eigen::Index i = 0; i < mass.size(); ++i)
    if (inverse_mass[i] != 0) sum += mass[i] * v.col(i).squaredNorm();
  return sum;
}

SolveResult record(SolveResult solve, Work& work) {
  ++work.solves;
  work.cg_iterations += solve.iterations;
  if (!solve.converged) ++work.unfinished_solves;
  update_worst(work.worst_residual, solve.residual);
  return solve;
}

/// q = A p for a symmetric positive definite A on free particles; 0 at prescribed
/// ones. Returns p.q.
using Product = std::function<double(const PerParticle3& p, PerParticle3& q)>;

/// Adds to v the solution of A w = r by conjugate gradients, preconditioned with the
/// masses: the plain iteration in the variable M^{1/2} w. scale: what the residual's norm
/// is compared with [kg^1/2 m/s].
SolveResult iterate(const Product& A, const PerParticle& inverse_mass,
                    const SolverSettings& settings, double scale, PerParticle3 r, PerParticle3& v) {
  PerParticle3 q(3, r.cols());
  double rr = squared_norm(r, inverse_mass);
  double residual = std::sqrt(rr) / scale;

  PerParticle3 p = r * inverse_mass.asDiagonal();
  int iterations = 0;
  while (residual > settings.tolerance && iterations < settings.max_iterations) {
    const double curvature = A(p, q);
    if (curvature <= 0) return {iterations, residual, false, true};

    const double alpha = rr / curvature, rr_before = rr;
    v += alpha * p;
    r -= alpha * q;
    rr = sum_of_blocks(r.cols(), [&](Eigen::Index first, Eigen::Index count) {
      return squared_norm(r.middleCols(first, count), inverse_mass.segment(first, count));
    });
    p = r * inverse_mass.asDiagonal() + (rr / rr_before) * p;
    residual = std::sqrt(rr) / scale;
    ++iterations;
  }
  return {iterations, residual, residual <= settings.tolerance, false};
}

double positive_or_one(double scale) { return scale > 0 ? scale : 1; }

}  // namespace

SolveResult solve_velocity(const DampingOperator& damping, double s, const PerParticle& mass,
                           const PerParticle& inverse_mass, const SolverSettings& settings,
                           PerParticle3& v, Work& work) {
  const Product A = [&](const PerParticle3& p, PerParticle3& q) {  // (M - s D) p
    q.setZero();
    damping.add_product(p, q);
    ++work.damping_products;
    q = p * mass.asDiagonal() - s * q;
    for (Eigen::Index i = 0; i < q.cols(); ++i)
      if (inverse_mass[i] == 0) q.col(i).setZero();
    return sum_of_blocks(p.cols(), [&](Eigen::Index first, Eigen::Index count) {
      return p.middleCols(first, count).cwiseProduct(q.middleCols(first, count)).sum();
    });
  };

  // the residual of the explicit guess: b - (M - s D) w0 = s D w0
  PerParticle3 q(3, v.cols());
  damping_product(damping, v, inverse_mass, q, work);
  const PerParticle3 r = s * q;
  const double scale_squared = settings.scale == ResidualScale::momentum
                                   ? squared_momentum(v, mass, inverse_mass)
                                   : squared_norm(r, inverse_mass);
  const double scale = positive_or_one(std::sqrt(scale_squared));
  return record(iterate(A, inverse_mass, settings, scale, r, v), work);
}

SolveResult solve_newton_step(const NewtonMatrix& matrix, const SolverSettings& settings,
                              const PerParticle3& r, PerParticle3& dw, Work& work) {
  const Product A = [&](const PerParticle3& p, PerParticle3& q) {
    multiply(matrix, p, q, work);
    return p.cwiseProduct(q).sum();
  };
  dw.setZero(3, r.cols());
  const double scale = positive_or_one(std::sqrt(squared_norm(r, matrix.inverse_mass)));
  const SolveResult solve = iterate(A, matrix.inverse_mass, settings, scale, r, dw);
  ++work.solves;
  work.cg_iterations += solve.iterations;
  return solve;
}

}  // namespace foldproof
