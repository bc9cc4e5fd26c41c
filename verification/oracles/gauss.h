// Gauss's quadrature: sums that integrate polynomials exactly.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "verification/oracles/dense_algebra.h"

namespace foldproof::oracles {

/// n places in (0, 1) and their weights, exact for polynomials of degree 2 n - 1: the eigenvalues
/// of Legendre's recurrence (Golub and Welsch 1969).
struct Gauss {
  Eigen::VectorXd s, weight;

  explicit Gauss(int n) {
    Eigen::MatrixXd recurrence = Eigen::MatrixXd::Zero(n, n);
    for (int k = 1; k < n; ++k)
      recurrence(k, k - 1) = recurrence(k - 1, k) = k / std::sqrt(4.0 * k * k - 1);
    const SymmetricModes modes = symmetric_modes(recurrence);
    s = (1 + modes.values.array()) / 2;
    weight = modes.vectors.row(0).transpose().array().square();
  }
};

}  // namespace foldproof::oracles
