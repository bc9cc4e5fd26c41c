// Eigenvalues, solutions and turns by Eigen's decompositions. Each takes seconds to compile
// wherever it stands: here they are compiled once.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace foldproof::oracles {

/// Of any square matrix, in no order.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& matrix);

/// Of a symmetric matrix, of which the lower half is read, ascending.
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

/// The least turn that takes the direction `from` to `to`; neither needs to be of length one.
Eigen::Quaterniond rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace foldproof::oracles
