#pragma once

#include <Eigen/Core>

namespace foldproof {

/// Eigenvalues (n, ascending) and eigenvectors (n x n, columns of length one) of a symmetric
/// matrix; only the lower half is read.
struct SymmetricModes {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
SymmetricModes symmetric_modes(const Eigen::Ref<const Eigen::MatrixXd>& matrix);

}  // namespace foldproof
