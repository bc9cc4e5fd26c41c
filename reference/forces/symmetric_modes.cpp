#include "reference/forces/symmetric_modes.h"

#include <Eigen/Eigenvalues>

namespace foldproof {

SymmetricModes symmetric_modes(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(matrix);
  return {modes.eigenvalues(), modes.eigenvectors()};
}

}  // namespace foldproof
