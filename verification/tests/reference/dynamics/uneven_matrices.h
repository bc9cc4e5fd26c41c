// Full matrices without a pattern, and lists of vectors as one vector.
#pragma once

#include <Eigen/Dense>

#include "reference/types.h"

namespace foldproof {

inline Eigen::VectorXd flat(const PerParticle3& a) { return a.reshaped(); }

inline PerParticle3 columns(const Eigen::VectorXd& a) { return a.reshaped(3, a.size() / 3); }

/// A full matrix without symmetry, entries of order `size`.
inline Eigen::MatrixXd uneven_matrix(int n, double size, double phase) {
  Eigen::MatrixXd a(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) a(i, j) = size * std::sin(1.7 * i * i + 0.9 * j + phase);
  return a;
}

/// Positive definite, full.
inline Eigen::MatrixXd uneven_definite_matrix(int n, double size, double phase) {
  const Eigen::MatrixXd a = uneven_matrix(n, 1, phase);
  return size * (a * a.transpose() / n + 0.3 * Eigen::MatrixXd::Identity(n, n));
}

}  // namespace foldproof
