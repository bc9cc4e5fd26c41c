#include "verification/oracles/dense_algebra.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

namespace foldproof::oracles {

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& matrix) {
  return Eigen::EigenSolver<Eigen::MatrixXd>(matrix, false).eigenvalues();
}

Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

SymmetricModes symmetric_modes(const Eigen::MatrixXd& K) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(K);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

SymmetricModes symmetric_modes(const Eigen::MatrixXd& K, const Eigen::VectorXd& masses) {
  const Eigen::VectorXd scale = masses.cwiseSqrt().cwiseInverse();
  SymmetricModes modes = symmetric_modes(scale.asDiagonal() * K * scale.asDiagonal());
  modes.vectors = scale.asDiagonal() * modes.vectors;
  return modes;
}

Eigen::VectorXd solve_linear(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  return A.partialPivLu().solve(b);
}

Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  return A.ldlt().solve(B);
}

SingularParts singular_parts(const Eigen::MatrixXd& matrix) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {svd.matrixU(), svd.singularValues(), svd.matrixV()};
}

Eigen::Quaterniond rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d a = from.normalized(), b = to.normalized();
  const double half = std::sqrt((1 + a.dot(b)) / 2);  // cosine of half the angle
  if (!(half > 1e-8)) {                               // opposite: any perpendicular axis
    const Eigen::Vector3d axis = a.unitOrthogonal();
    return {0, axis.x(), axis.y(), axis.z()};
  }
  const Eigen::Vector3d v = a.cross(b) / (2 * half);
  // a small cosine is known to few digits
  return Eigen::Quaterniond(half, v.x(), v.y(), v.z()).normalized();
}

}  // namespace foldproof::oracles
