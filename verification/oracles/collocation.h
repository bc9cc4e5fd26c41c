// Polynomials by their values at Chebyshev's nodes: the trial space for strips.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "reference/types.h"

namespace foldproof::oracles {

/// The integral of Chebyshev's T_k(2 s - 1) over s from 0.
inline double integral_of_chebyshev(int k, double s) {
  const double x = 2 * s - 1;
  if (k == 0) return s;
  if (k == 1) return (x * x - 1) / 4;
  const double angle = std::acos(std::clamp(x, -1.0, 1.0));
  const auto primitive = [k](double at) {
    return std::cos((k + 1) * at) / (2 * (k + 1)) - std::cos((k - 1) * at) / (2 * (k - 1));
  };
  return (primitive(angle) - primitive(pi)) / 2;
}

/// Polynomials of degree n on [0, 1] by their values at s_j = (1 - cos(j pi/n))/2, j = 0..n.
struct Collocation {
  Eigen::VectorXd s;
  Eigen::MatrixXd derivative;    // of values: values of the derivative
  Eigen::MatrixXd coefficients;  // of values: factors of T_k(2 s - 1)

  explicit Collocation(int n) : s(n + 1), derivative(n + 1, n + 1), coefficients(n + 1, n + 1) {
    const auto half_at_ends = [n](int j) { return j == 0 || j == n ? 0.5 : 1.0; };
    const auto sign = [](int j) { return j % 2 == 0 ? 1.0 : -1.0; };
    for (int j = 0; j <= n; ++j) s[j] = std::pow(std::sin(j * pi / (2 * n)), 2);
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n; ++j) {
        coefficients(i, j) = 2.0 / n * half_at_ends(i) * half_at_ends(j) * sign(i) *
                             std::cos(double(i) * j * pi / n);
        derivative(i, j) =
            i == j ? 0
                   : half_at_ends(j) / half_at_ends(i) * sign(i + j) /
                         (std::sin((i + j) * pi / (2 * n)) * std::sin((i - j) * pi / (2 * n)));
      }
    for (int i = 0; i <= n; ++i) derivative(i, i) = -derivative.row(i).sum();  // of constants: 0
  }

  /// Of values: the integral from 0 to `end`.
  Eigen::RowVectorXd integral(double end) const {
    Eigen::RowVectorXd integrals(s.size());
    for (int k = 0; k < s.size(); ++k) integrals[k] = integral_of_chebyshev(k, end);
    return integrals * coefficients;
  }
};

}  // namespace foldproof::oracles
