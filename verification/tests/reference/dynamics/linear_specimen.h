// A linear system with full matrices, and textbooks' iterations to solve it.
#pragma once

#include "reference/dynamics/newton_matrix.h"
#include "verification/specimens/solver_problems.h"
#include "verification/tests/reference/dynamics/dynamics_specimen.h"

namespace foldproof {

/// Four particles, of which the third is prescribed, with full matrices of damping and stiffness.
struct LinearSystem {
  PerParticle mass = (PerParticle(4) << 0.31, 0.47, 0.23, 0.59).finished();
  PerParticle inverse_mass = (PerParticle(4) << 1 / 0.31, 1 / 0.47, 0, 1 / 0.59).finished();
  Eigen::MatrixXd D = -uneven_definite_matrix(12, 21, 2.6),
                  K = -uneven_definite_matrix(12, 160, 0.4);
  PerParticle3 v = columns(uneven_matrix(12, 1.3, 3.9).col(8));

  DampingOperator damping() const {
    DampingOperator damping;
    damping.custom.push_back(
        [D = D](const PerParticle3& p, PerParticle3& f) { f += columns(D * flat(p)); });
    return damping;
  }
  ForceDifferential stiffness() const {
    ForceDifferential differential;
    differential.custom.push_back(
        [K = K](const PerParticle3& p, PerParticle3& f) { f += columns(K * flat(p)); });
    return differential;
  }
  /// The entries of free particles.
  Eigen::VectorXd free(const Eigen::VectorXd& a) const {
    return (Eigen::VectorXd(9) << a.head(6), a.tail(3)).finished();
  }
  Eigen::VectorXd roots() const {
    return free(mass.replicate(1, 3).transpose().reshaped()).cwiseSqrt();
  }
  /// M^{-1/2} A M^{-1/2} of free particles.
  Eigen::MatrixXd scaled(const Eigen::MatrixXd& A) const {
    const std::vector<int> kept{0, 1, 2, 3, 4, 5, 9, 10, 11};
    const Eigen::VectorXd inverse = roots().cwiseInverse();
    return inverse.asDiagonal() * A(kept, kept) * inverse.asDiagonal();
  }
  Eigen::MatrixXd newton(double s) const {
    const Eigen::VectorXd m = mass.replicate(1, 3).transpose().reshaped();
    return Eigen::MatrixXd(m.asDiagonal()) - s * D - s * s * K;
  }
  /// M^{-1/2} y at free particles, `at_prescribed` at the other.
  PerParticle3 spread(const Eigen::VectorXd& y, const Vector3& at_prescribed) const {
    const Eigen::VectorXd w = y.cwiseQuotient(roots());
    Eigen::VectorXd all(12);
    all << w.head(6), at_prescribed, w.tail(3);
    return columns(all);
  }
};

struct Iterate {
  Eigen::VectorXd y;
  double residual;
};

/// Conjugate gradients for B y = b from 0 (Hestenes and Stiefel 1952).
inline Iterate conjugate_gradients(const Eigen::MatrixXd& B, const Eigen::VectorXd& b,
                                   int iterations) {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(b.size()), r = b, p = b;
  for (int k = 0; k < iterations; ++k) {
    const double alpha = r.dot(r) / p.dot(B * p);
    y += alpha * p;
    const Eigen::VectorXd next = r - alpha * (B * p);
    p = next + next.dot(next) / r.dot(r) * p;
    r = next;
  }
  return {y, (b - B * y).norm()};
}

/// BiCGSTAB for B y = b from 0 (van der Vorst 1992).
inline Iterate stabilised_gradients(const Eigen::MatrixXd& B, const Eigen::VectorXd& b,
                                    int iterations) {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(b.size()), r = b, p = Eigen::VectorXd::Zero(b.size()),
                  v = p;
  double rho = 1, alpha = 1, omega = 1;
  for (int k = 0; k < iterations; ++k) {
    const double rho_next = b.dot(r), beta = rho_next / rho * (alpha / omega);
    rho = rho_next;
    p = r + beta * (p - omega * v);
    v = B * p;
    alpha = rho / b.dot(v);
    const Eigen::VectorXd left = r - alpha * v, t = B * left;
    omega = t.dot(left) / t.dot(t);
    y += alpha * p + omega * left;
    r = left - omega * t;
  }
  return {y, (b - B * y).norm()};
}

inline SolverSettings settings_of(double tolerance, int iterations) {
  SolverSettings settings;
  settings.tolerance = tolerance;
  settings.max_iterations = iterations;
  return settings;
}

inline double difference(const PerParticle3& a, const PerParticle3& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

}  // namespace foldproof
