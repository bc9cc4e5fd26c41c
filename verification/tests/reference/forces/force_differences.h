// For tests of forces: numbers without a pattern, and derivatives and products as dense matrices.
#pragma once

#include <cmath>

#include "reference/types.h"

namespace foldproof {

/// 3 x n numbers between -1 and 1, others for each seed.
inline PerParticle3 scattered(int n, double seed) {
  PerParticle3 numbers(3, n);
  for (Eigen::Index k = 0; k < numbers.size(); ++k)
    numbers.data()[k] = std::sin(seed + 7.3 * double(k) + 0.9 * double(k * k));
  return numbers;
}

/// The derivative of function(x), column k with respect to entry k of x, by differences whose error
/// is of fourth order in step.
template <class Function>
Eigen::MatrixXd differences(const PerParticle3& x, double step, const Function& function) {
  Eigen::MatrixXd derivative;
  const auto moved = [&](Eigen::Index k, double shift) {
    PerParticle3 there = x;
    there.data()[k] += shift;
    const Eigen::MatrixXd value = function(there);
    return Eigen::VectorXd(value.reshaped());
  };
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    const Eigen::VectorXd column =
        (8 * (moved(k, step) - moved(k, -step)) - (moved(k, 2 * step) - moved(k, -2 * step))) /
        (12 * step);
    derivative.conservativeResize(column.size(), k + 1);
    derivative.col(k) = column;
  }
  return derivative;
}

/// The matrix of a product that add_product(v, f) adds to f, for n particles.
template <class Product>
Eigen::MatrixXd matrix_of(int n, const Product& add_product) {
  Eigen::MatrixXd matrix(3 * n, 3 * n);
  for (Eigen::Index k = 0; k < 3 * n; ++k) {
    PerParticle3 unit = PerParticle3::Zero(3, n), product = PerParticle3::Zero(3, n);
    unit.data()[k] = 1;
    add_product(unit, product);
    matrix.col(k) = product.reshaped();
  }
  return matrix;
}

/// Whether two matrices differ by at most this share of the second.
template <class One, class Other>
bool agree(const One& one, const Other& other, double share) {
  return (one - other).norm() <= share * other.norm();
}

}  // namespace foldproof
