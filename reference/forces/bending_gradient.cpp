// Derivatives of the bending mode (second derivatives of the angle) and of the forces' factors with
// respect to the corners, for the fully implicit methods.
#include <Eigen/Geometry>

#include "reference/forces/bending.h"

namespace foldproof {

namespace {

/// The matrix of the cross product with w: w x.
Eigen::Matrix3d cross_matrix(const Vector3& w) {
  Eigen::Matrix3d matrix;
  matrix << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  return matrix;
}

using Rows3 = Eigen::Matrix<double, 3, 12>;
using Row = Eigen::Matrix<double, 1, 12>;

/// Derivatives of u_k and b_k of one triangle with respect to x1, x2, x3, x4; k: its opposite
/// vertex, 0 or 1.
struct SideGradient {
  Rows3 u;  // [1/m^2]
  Row b;    // [1/m]
};

//   N = (x_k - x_l) x (x_k - x_r), (l, r) = (3, 4) for k = 1 and (4, 3) for k = 2,
//     so that N2 = (x2 - x4) x (x2 - x3)
//   dN = (x_r - x_l) x dx_k + (x_k - x_r) x dx_l - (x_k - x_l) x dx_r
//   u = |E| N/|N|^2:   du = N/|N|^2 d|E| + |E|/|N|^2 (I - 2 n n^T) dN,       d|E| = e^.(dx4 - dx3)
//   b = (x4 - x_k).E/|E|^2:   |E|^2 db = (dx4 - dx_k).E + (x4 - x_k).dE - 2 b E.dE
SideGradient side_gradient(const std::array<Vector3, 4>& x, int k) {
  const int l = k == 0 ? 2 : 3, r = k == 0 ? 3 : 2;
  const auto at = [&](int i) -> const Vector3& { return x[size_t(i)]; };
  const Vector3 E = at(3) - at(2), N = (at(k) - at(l)).cross(at(k) - at(r));
  const double edge = E.norm(), N_squared = N.squaredNorm();

  Rows3 dN = Rows3::Zero();
  dN.middleCols<3>(3 * k) = cross_matrix(at(r) - at(l));
  dN.middleCols<3>(3 * l) = cross_matrix(at(k) - at(r));
  dN.middleCols<3>(3 * r) = -cross_matrix(at(k) - at(l));
  Rows3 dE = Rows3::Zero();
  dE.middleCols<3>(6) = -Eigen::Matrix3d::Identity();
  dE.middleCols<3>(9) = Eigen::Matrix3d::Identity();
  Rows3 from_k = Rows3::Zero();  // d(x4 - x_k)
  from_k.middleCols<3>(9) = Eigen::Matrix3d::Identity();
  from_k.middleCols<3>(3 * k) = -Eigen::Matrix3d::Identity();

  const Eigen::Matrix3d turn = Eigen::Matrix3d::Identity() - 2 / N_squared * (N * N.transpose());
  const Vector3 to_k = at(3) - at(k);
  const double b = to_k.dot(E) / (edge * edge);
  SideGradient gradient;
  gradient.u = (N / (N_squared * edge)) * (E.transpose() * dE) + (edge / N_squared) * (turn * dN);
  gradient.b = (E.transpose() * from_k + (to_k - 2 * b * E).transpose() * dE) / (edge * edge);
  return gradient;
}

/// Adds the derivative of |(q - p) x (r - p)| with respect to p, q, r: n x the side opposite each.
void add_area_gradient(const std::array<Vector3, 4>& x, const std::array<int, 3>& pqr,
                       Vector12& gradient) {
  const auto at = [&](int k) -> const Vector3& { return x[size_t(pqr[size_t(k)])]; };
  const Vector3 n = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
  for (int k = 0; k < 3; ++k) {
    const Vector3 opposite = at((k + 2) % 3) - at((k + 1) % 3);
    gradient.segment<3>(3 * pqr[size_t(k)]) += n.cross(opposite);
  }
}

}  // namespace

Vector12 edge_gradient(const Vector3& x3, const Vector3& x4) {
  const Vector3 along = (x4 - x3).normalized();
  Vector12 gradient = Vector12::Zero();
  gradient.segment<3>(6) = -along;
  gradient.segment<3>(9) = along;
  return gradient;
}

Vector12 weight_gradient(const Vector3& x1, const Vector3& x2, const Vector3& x3,
                         const Vector3& x4) {
  const HingeShape shape = hinge_shape(x1, x2, x3, x4);
  const std::array<Vector3, 4> corners = {x1, x2, x3, x4};
  Vector12 areas = Vector12::Zero();
  add_area_gradient(corners, {0, 2, 3}, areas);
  add_area_gradient(corners, {1, 3, 2}, areas);
  const double ratio = shape.edge / shape.area_sum;
  return 2 * ratio * edge_gradient(x3, x4) - ratio * ratio * areas;
}

Matrix12 bending_mode_gradient(const Vector3& x1, const Vector3& x2, const Vector3& x3,
                               const Vector3& x4) {
  const HingeShape shape = hinge_shape(x1, x2, x3, x4);
  const std::array<Vector3, 4> corners = {x1, x2, x3, x4};
  const SideGradient side1 = side_gradient(corners, 0), side2 = side_gradient(corners, 1);

  // u3 = -(b1 u1 + b2 u2), u4 = -(u1 + u2 + u3)
  Matrix12 gradient;
  gradient.middleRows<3>(0) = side1.u;
  gradient.middleRows<3>(3) = side2.u;
  gradient.middleRows<3>(6) =
      -(shape.u1 * side1.b + shape.b1 * side1.u + shape.u2 * side2.b + shape.b2 * side2.u);
  gradient.middleRows<3>(9) =
      -(gradient.middleRows<3>(0) + gradient.middleRows<3>(3) + gradient.middleRows<3>(6));
  return gradient;
}

}  // namespace foldproof
