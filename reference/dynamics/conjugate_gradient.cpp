#include "reference/dynamics/conjugate_gradient.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "reference/fast/loops.h"

namespace foldproof {

namespace {

// Particles in a block of the sums of an iteration.
constexpr Eigen::Index block_of_products = 512;

/// sum_i |r_i|^2/m_i over free particles, the squared mass-weighted norm of a momentum r.
double squared_norm(const Eigen::Ref<const PerParticle3>& r,
                    const Eigen::Ref<const PerParticle>& inverse_mass) {
  return r.colwise().squaredNorm().dot(inverse_mass.transpose());
}

/// The same in blocks.
double squared_norm(int threads, Eigen::Index block, const PerParticle3& r,
                    const PerParticle& inverse_mass) {
  return sum_of_blocks(threads, r.cols(), block, [&](Eigen::Index first, Eigen::Index count) {
    return squared_norm(r.middleCols(first, count), inverse_mass.segment(first, count));
  });
}

/// s D p at free particles, 0 at prescribed ones.
PerParticle3 damping_product(int threads, const DampingOperator& damping, const PerParticle3& p,
                             const PerParticle& inverse_mass, double s) {
  PerParticle3 q = evaluated(threads, PerParticle3::Zero(3, p.cols()));
  damping.add_product(p, q);
  for_each_range(threads, p.cols(), [&](Eigen::Index first, Eigen::Index count) {
    for (Eigen::Index i = first; i < first + count; ++i)
      if (inverse_mass[i] == 0)
        q.col(i).setZero();
      else
        q.col(i) *= s;
  });
  return q;
}

double squared_momentum(int threads, const PerParticle3& v, const PerParticle& mass,
                        const PerParticle& inverse_mass) {
  const auto of_block = [&](Eigen::Index first, Eigen::Index count) {
    double sum = 0;
    for (Eigen::Index i = first; i < first + count; ++i)
      if (inverse_mass[i] != 0) sum += mass[i] * v.col(i).squaredNorm();
    return sum;
  };
  return sum_of_blocks(threads, mass.size(), block_of_sums, of_block);
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
  const int threads = settings.threads;
  PerParticle3 q(3, r.cols());
  double rr = squared_norm(threads, block_of_sums, r, inverse_mass);
  double residual = std::sqrt(rr) / scale;

  PerParticle3 p = evaluated(threads, r * inverse_mass.asDiagonal());
  int iterations = 0;
  while (residual > settings.tolerance && iterations < settings.max_iterations) {
    const double curvature = A(p, q);
    if (curvature <= 0) return {iterations, residual, false, true};

    const double alpha = rr / curvature, rr_before = rr;
    assign(threads, v, v + alpha * p);
    assign(threads, r, r - alpha * q);
    rr = squared_norm(threads, block_of_products, r, inverse_mass);
    assign(threads, p, r * inverse_mass.asDiagonal() + (rr / rr_before) * p);
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
  const int threads = settings.threads;
  const Product A = [&](const PerParticle3& p, PerParticle3& q) {  // (M - s D) p
    assign(threads, q, PerParticle3::Zero(3, p.cols()));
    damping.add_product(p, q);
    ++work.damping_products;
    assign(threads, q, p * mass.asDiagonal() - s * q);
    for (Eigen::Index i = 0; i < q.cols(); ++i)
      if (inverse_mass[i] == 0) q.col(i).setZero();
    const auto of_block = [&](Eigen::Index first, Eigen::Index count) {
      return p.middleCols(first, count).cwiseProduct(q.middleCols(first, count)).sum();
    };
    return sum_of_blocks(threads, p.cols(), block_of_products, of_block);
  };

  // the residual of the explicit guess: b - (M - s D) w0 = s D w0
  const PerParticle3 r = damping_product(threads, damping, v, inverse_mass, s);
  ++work.damping_products;
  const double scale_squared = settings.scale == ResidualScale::momentum
                                   ? squared_momentum(threads, v, mass, inverse_mass)
                                   : squared_norm(threads, block_of_sums, r, inverse_mass);
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
  const double scale = positive_or_one(
      std::sqrt(squared_norm(settings.threads, block_of_sums, r, matrix.inverse_mass)));
  const SolveResult solve = iterate(A, matrix.inverse_mass, settings, scale, r, dw);
  ++work.solves;
  work.cg_iterations += solve.iterations;
  return solve;
}

}  // namespace foldproof
