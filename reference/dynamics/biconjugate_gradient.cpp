#include "reference/dynamics/biconjugate_gradient.h"

#include <cmath>

namespace foldproof {

namespace {

/// sum_i a_i.b_i/m_i over free particles: the product of the variable M^{-1/2} a, in
/// which masses are 1.
double product(const PerParticle3& a, const PerParticle3& b, const PerParticle& inverse_mass) {
  return a.cwiseProduct(b).colwise().sum().dot(inverse_mass.transpose());
}

}  // namespace

// In the variable M^{1/2} dw this is the plain iteration of van der Vorst's paper, with its
// letters. Here it is written with masses: r, s, p, v, t are momenta [kg m/s], and M^{-1} p and
// M^{-1} s are the directions in dw [m/s].
SolveResult solve_unsymmetric_step(const NewtonMatrix& A, const SolverSettings& settings,
                                   const PerParticle3& r0, PerParticle3& dw, Work& work) {
  const PerParticle& inverse_mass = A.inverse_mass;
  const auto norm = [&](const PerParticle3& a) { return std::sqrt(product(a, a, inverse_mass)); };
  dw.setZero(3, r0.cols());
  PerParticle3 r = r0, p = r0, v(3, r0.cols()), t(3, r0.cols());
  const double scale = norm(r0) > 0 ? norm(r0) : 1;
  double rho = product(r0, r, inverse_mass), residual = norm(r) / scale;
  int iterations = 0;
  while (residual > settings.tolerance && iterations < settings.max_iterations) {
    const PerParticle3 along_p = p * inverse_mass.asDiagonal();
    multiply(A, along_p, v, work);
    const double alpha = rho / product(r0, v, inverse_mass);
    const PerParticle3 s = r - alpha * v, along_s = s * inverse_mass.asDiagonal();
    multiply(A, along_s, t, work);
    const double tt = product(t, t, inverse_mass),
                 omega = tt > 0 ? product(t, s, inverse_mass) / tt : 0;
    ++iterations;

    const PerParticle3 step = alpha * along_p + omega * along_s;
    if (!step.allFinite()) break;  // a division by zero: r0.v vanished
    dw += step;
    r = s - omega * t;
    residual = norm(r) / scale;
    if (omega == 0) break;

    const double rho_before = rho;
    rho = product(r0, r, inverse_mass);
    p = r + (rho / rho_before) * (alpha / omega) * (p - omega * v);
  }
  ++work.solves;
  work.cg_iterations += 2 * iterations;
  return {iterations, residual, residual <= settings.tolerance, false};
}

}  // namespace foldproof
