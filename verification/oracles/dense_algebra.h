// Eigenvalues, linear solves and rotations by Eigen's decompositions. They are slow to compile, so
// they are compiled once, here.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace foldproof::oracles {

/// Eigenvalues of any square matrix, in no particular order.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& matrix);

/// Eigenvalues of a symmetric matrix, ascending; only the lower half is read.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix);

/// Values ascending; column i of the vectors belongs to value i.
struct SymmetricModes {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// K x = value x, |x| = 1; the lower half of K is read.
SymmetricModes symmetric_modes(const Eigen::MatrixXd& K);

/// K x = value M x, x.M x = 1, M = diag(masses) with positive masses; the lower half of K is read.
SymmetricModes symmetric_modes(const Eigen::MatrixXd& K, const Eigen::VectorXd& masses);

/// x of A x = b, by LU with partial pivoting.
Eigen::VectorXd solve_linear(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

/// X of A X = B for symmetric A, by LDLT.
Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// matrix = U diag(values) V^T, values descending; U and V square.
struct SingularParts {
  Eigen::MatrixXd U;
  Eigen::VectorXd values;
  Eigen::MatrixXd V;
};
SingularParts singular_parts(const Eigen::MatrixXd& matrix);

/// The smallest rotation that takes the direction `from` to `to`; neither needs unit length.
Eigen::Quaterniond rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace foldproof::oracles
