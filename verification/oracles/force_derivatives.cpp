#include "verification/oracles/force_derivatives.h"

#include <algorithm>

#include "verification/oracles/scalars.h"

namespace foldproof::oracles {

namespace {

template <int N>
using Gradient = Dual<Digits50, N>;

template <class Scalar>
Triple<Scalar> constant(const Vector3& p) {
  return {Scalar(Digits50(p.x())), Scalar(Digits50(p.y())), Scalar(Digits50(p.z()))};
}

template <class Scalar>
Quad<Scalar> constant(const std::array<Vector3, 4>& p) {
  return {constant<Scalar>(p[0]), constant<Scalar>(p[1]), constant<Scalar>(p[2]),
          constant<Scalar>(p[3])};
}

/// p with its coordinates as variables first, first + 1, first + 2 of differentiation.
template <int N>
Triple<Gradient<N>> variables(const Vector3& p, int first) {
  return {variable<Digits50, N>(p.x(), first), variable<Digits50, N>(p.y(), first + 1),
          variable<Digits50, N>(p.z(), first + 2)};
}

/// Component a of a vector.
template <class Scalar>
Scalar& component(Triple<Scalar>& triple, int a) {
  return a == 0 ? triple.x : a == 1 ? triple.y : triple.z;
}

/// Writes an entry of an estimate's matrix.
template <class MatrixOf>
void record(MatrixOf& estimate, int row, int column, const Digits50& entry) {
  estimate.value(row, column) = rounded(entry).value;
  estimate.uncertainty = std::max(estimate.uncertainty, rounded(entry).uncertainty);
}

/// Elastic and damping force on the corners at x.
template <class Scalar>
Quad<Scalar> force_on_hinge(const HingeInput& hinge, const Quad<Scalar>& x) {
  using std::sin;
  const Quad<Scalar> rest = constant<Scalar>(hinge.rest);
  const Scalar elastic_factor =
      anisotropy_factor(hinge.elastic_geometry == Geometry::rest ? rest : x);
  const Quad<Scalar>& damped = hinge.damping_geometry == Geometry::rest ? rest : x;
  const Scalar damping_factor = hinge.damping_factor == DampingFactor::edge_length
                                    ? edge_length(damped)
                                    : anisotropy_factor(damped);
  const Scalar deflection =
      sin(hinge_angle(x) / Scalar(Digits50(2))) - Scalar(sin(Digits50(hinge.theta0) / 2));
  Quad<Scalar> force =
      bending_elastic_force(x, Scalar(Digits50(hinge.ke)), elastic_factor, deflection);
  const Quad<Scalar> damping = bending_damping_force(x, constant<Scalar>(hinge.v),
                                                     Scalar(Digits50(hinge.kd)), damping_factor);
  for (size_t corner = 0; corner < 4; ++corner) force[corner] = force[corner] + damping[corner];
  return force;
}

}  // namespace

MatrixEstimate bending_force_derivative_autodiff(const HingeInput& hinge) {
  const Quad<Gradient<12>> x = {variables<12>(hinge.x[0], 0), variables<12>(hinge.x[1], 3),
                                variables<12>(hinge.x[2], 6), variables<12>(hinge.x[3], 9)};
  Quad<Gradient<12>> force = force_on_hinge(hinge, x);
  MatrixEstimate result;
  for (int row = 0; row < 12; ++row)
    for (int column = 0; column < 12; ++column)
      record(result, row, column,
             component(force[size_t(row / 3)], row % 3).derivative[size_t(column)]);
  return result;
}

// The error of a central difference is step^2/6 F''' + rounding/step: at 1e-16 of the hinge's size
// both are below 1e-30 of the derivative, far under the rounding of the result.
MatrixEstimate bending_force_derivative_differences(const HingeInput& hinge) {
  const Quad<Digits50> x = constant<Digits50>(hinge.x);
  const Digits50 step = Digits50("1e-16") * edge_length(x);
  MatrixEstimate result;
  for (int column = 0; column < 12; ++column) {
    Quad<Digits50> ahead = x, behind = x;
    component(ahead[size_t(column / 3)], column % 3) += step;
    component(behind[size_t(column / 3)], column % 3) -= step;
    Quad<Digits50> up = force_on_hinge(hinge, ahead), down = force_on_hinge(hinge, behind);
    for (int row = 0; row < 12; ++row)
      record(result, row, column,
             (component(up[size_t(row / 3)], row % 3) - component(down[size_t(row / 3)], row % 3)) /
                 (2 * step));
  }
  return result;
}

SpringMatrixEstimate spring_force_derivative_autodiff(const SpringInput& spring) {
  using Scalar = Gradient<6>;
  const SpringLaw<Scalar> law = {
      Scalar(Digits50(spring.law.young)), Scalar(Digits50(spring.law.damping)),
      Scalar(Digits50(spring.law.area)), Scalar(Digits50(spring.law.rest_length))};
  const Triple<Scalar> xa = variables<6>(spring.x[0], 0), xb = variables<6>(spring.x[1], 3);
  const Triple<Scalar> dv = constant<Scalar>(spring.v[1]) - constant<Scalar>(spring.v[0]);
  Triple<Scalar> on_a = spring_elastic_force(xa, xb, law) + spring_damping_force(xa, xb, dv, law);
  SpringMatrixEstimate result;
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 6; ++column) {
      const Digits50 entry = component(on_a, row % 3).derivative[size_t(column)];
      record(result, row, column, row < 3 ? entry : Digits50(-entry));
    }
  return result;
}

}  // namespace foldproof::oracles
