#pragma once

#include <array>
#include <cmath>

#include "reference/types.h"
#include "verification/oracles/estimate.h"
#include "verification/oracles/triple.h"

// The forces of the paper, coded as defined, without regard to speed or rounding. The templates
// run in any scalar (double, 50 digits, automatically differentiated numbers); the functions at
// the end of the file run them in 50 digits and hand back doubles. They share nothing with the
// code they judge.
//
//      x1
//     /  \      N1 = (x1 - x3) x (x1 - x4)      |N1| = twice the area [m^2]
//   x3 -- x4    N2 = (x2 - x4) x (x2 - x3)
//     \  /      E  = x4 - x3
//      x2       theta = angle from n1 to n2 about E [rad]; 0 when flat

namespace foldproof::oracles {

/// Area-weighted normals of the two triangles of a hinge [m^2] and its edge [m].
template <class Scalar>
struct HingeShape {
  Triple<Scalar> N1, N2, E;
};

/// The letters of BMF03 Figure 1 for corners x [m].
template <class Scalar>
HingeShape<Scalar> hinge_shape(const Quad<Scalar>& x) {
  const auto& [x1, x2, x3, x4] = x;
  return {cross(x1 - x3, x1 - x4), cross(x2 - x4, x2 - x3), x4 - x3};
}

/// theta in (-pi, pi] [rad], from both its sine (n1 x n2).e and its cosine n1.n2. NaN without area.
template <class Scalar>
Scalar hinge_angle(const Quad<Scalar>& x) {
  using std::atan2;
  const HingeShape<Scalar> shape = hinge_shape(x);
  const Triple<Scalar> n1 = unit(shape.N1), n2 = unit(shape.N2);
  return atan2(dot(cross(n1, n2), unit(shape.E)), dot(n1, n2));
}

/// sin(theta/2) [1] as printed: +- sqrt((1 - n1.n2)/2) with the sign of (n1 x n2).e (BMF03 section
/// 4). Half of the scalar's digits are lost near theta = 0, where rounding may put n1.n2 above 1:
/// that counts as flat. A zero sine counts as positive.
template <class Scalar>
Scalar sin_half_angle(const Quad<Scalar>& x) {
  using std::sqrt;
  const HingeShape<Scalar> shape = hinge_shape(x);
  const Triple<Scalar> n1 = unit(shape.N1), n2 = unit(shape.N2);
  const Scalar difference = Scalar(1) - dot(n1, n2);
  const Scalar size = difference < Scalar(0) ? Scalar(0) : Scalar(sqrt(difference / Scalar(2)));
  return dot(cross(n1, n2), unit(shape.E)) < Scalar(0) ? Scalar(-size) : size;
}

/// The bending mode u1..u4 [1/m] as printed (BMF03 section 4). With these signs u = -grad(theta).
template <class Scalar>
Quad<Scalar> bending_mode(const Quad<Scalar>& x) {
  const auto& [x1, x2, x3, x4] = x;
  const auto [N1, N2, E] = hinge_shape(x);
  const Triple<Scalar> e = unit(E);
  const Triple<Scalar> over1 = N1 / dot(N1, N1), over2 = N2 / dot(N2, N2);
  return {length(E) * over1, length(E) * over2, dot(x1 - x4, e) * over1 + dot(x2 - x4, e) * over2,
          -(dot(x1 - x3, e) * over1) - dot(x2 - x3, e) * over2};
}

/// |E| [m], the factor of the damping force as printed.
template <class Scalar>
Scalar edge_length(const Quad<Scalar>& x) {
  return length(hinge_shape(x).E);
}

/// |E|^2 / (|N1| + |N2|) [1], the factor of the elastic force. Pass the rest corners or
/// the current ones.
template <class Scalar>
Scalar anisotropy_factor(const Quad<Scalar>& x) {
  const HingeShape<Scalar> shape = hinge_shape(x);
  return dot(shape.E, shape.E) / (length(shape.N1) + length(shape.N2));
}

/// F_i = ke factor deflection u_i [N] with deflection = sin(theta/2) - sin(theta0/2) [1], ke [J]
/// (BMF03 section 4).
template <class Scalar>
Quad<Scalar> bending_elastic_force(const Quad<Scalar>& x, const Scalar& ke, const Scalar& factor,
                                   const Scalar& deflection) {
  const Quad<Scalar> u = bending_mode(x);
  const Scalar magnitude = ke * factor * deflection;
  return {magnitude * u[0], magnitude * u[1], magnitude * u[2], magnitude * u[3]};
}

/// F_i = -kd factor (u.v) u_i [N] with v [m/s] (BMF03 section 4); kd in N s with the factor |E|, in
/// J s with |E|^2/(|N1| + |N2|).
template <class Scalar>
Quad<Scalar> bending_damping_force(const Quad<Scalar>& x, const Quad<Scalar>& v, const Scalar& kd,
                                   const Scalar& factor) {
  const Quad<Scalar> u = bending_mode(x);
  const Scalar rate = dot(u[0], v[0]) + dot(u[1], v[1]) + dot(u[2], v[2]) + dot(u[3], v[3]);
  const Scalar magnitude = -(kd * factor * rate);
  return {magnitude * u[0], magnitude * u[1], magnitude * u[2], magnitude * u[3]};
}

/// Energy W [J]; the elastic force is -grad W if its factor is evaluated at rest:
/// dW/dtheta = ke factor (sin(theta/2) - sin(theta0/2)), W(theta0) = 0.
template <class Scalar>
Scalar bending_energy(const Quad<Scalar>& x, const Scalar& ke, const Scalar& rest_factor,
                      const Scalar& theta0) {
  using std::cos, std::sin;
  const Scalar theta = hinge_angle(x), half = theta / Scalar(2), half0 = theta0 / Scalar(2);
  return ke * rest_factor * (Scalar(2) * (cos(half0) - cos(half)) - sin(half0) * (theta - theta0));
}

/// One spring: an edge of the mesh and its material.
template <class Scalar>
struct SpringLaw {
  Scalar young;        // Y, two-dimensional modulus [N/m]
  Scalar damping;      // kd_s [N s/m]
  Scalar area;         // A_e, rest areas of the one or two triangles at the edge [m^2]
  Scalar rest_length;  // L0 [m]
};

/// W = Y A_e/2 (|d|/L0 - 1)^2 [J], d = x_b - x_a.
template <class Scalar>
Scalar spring_energy(const Triple<Scalar>& xa, const Triple<Scalar>& xb,
                     const SpringLaw<Scalar>& law) {
  const Scalar strain = length(xb - xa) / law.rest_length - Scalar(1);
  return law.young * law.area * strain * strain / Scalar(2);
}

/// Elastic force on end a [N]; end b feels the opposite. Y (A_e/L0) (|d|/L0 - 1) d^.
template <class Scalar>
Triple<Scalar> spring_elastic_force(const Triple<Scalar>& xa, const Triple<Scalar>& xb,
                                    const SpringLaw<Scalar>& law) {
  const Triple<Scalar> d = xb - xa;
  const Scalar tension =
      law.young * law.area / law.rest_length * (length(d) / law.rest_length - Scalar(1));
  return tension * unit(d);
}

/// Damping force on end a [N] for the velocity difference v_b - v_a [m/s]; end b feels the
/// opposite. kd_s (A_e/L0^2) ((v_b - v_a).d^) d^.
template <class Scalar>
Triple<Scalar> spring_damping_force(const Triple<Scalar>& xa, const Triple<Scalar>& xb,
                                    const Triple<Scalar>& velocity_difference,
                                    const SpringLaw<Scalar>& law) {
  const Triple<Scalar> direction = unit(xb - xa);
  const Scalar coefficient = law.damping * law.area / (law.rest_length * law.rest_length);
  return (coefficient * dot(velocity_difference, direction)) * direction;
}

/// Weight of a mass [kg] in the field g [m/s^2]: m g [N].
template <class Scalar>
Triple<Scalar> gravity_force(const Scalar& mass, const Triple<Scalar>& g) {
  return mass * g;
}

/// -m g.x [J], zero at the origin.
template <class Scalar>
Scalar gravity_energy(const Scalar& mass, const Triple<Scalar>& g, const Triple<Scalar>& x) {
  return -(mass * dot(g, x));
}

/// Where a geometric factor of the bending forces is evaluated. The paper does not say.
enum class Geometry { rest, current };

/// The factor of the damping force: |E| as printed, or |E|^2/(|N1| + |N2|), under which kd is
/// mesh-independent.
enum class DampingFactor { edge_length, anisotropy };

/// One hinge and everything that its forces depend on.
struct HingeInput {
  std::array<Vector3, 4> x, v, rest;              // corners x1..x4 [m], [m/s], rest corners [m]
  double ke = 0;                                  // bending stiffness [J]
  double kd = 0;                                  // bending damping [N s] or [J s], by its factor
  double theta0 = 0;                              // rest angle [rad]
  Geometry elastic_geometry = Geometry::rest;     // of |E|^2/(|N1| + |N2|) in the elastic force
  Geometry damping_geometry = Geometry::current;  // of the factor of the damping force
  DampingFactor damping_factor = DampingFactor::edge_length;
};

/// One spring and everything that its forces depend on; ends a, b.
struct SpringInput {
  std::array<Vector3, 2> x, v;  // [m], [m/s]
  SpringLaw<double> law;
};

/// N vectors and the uncertainty of any component, in the vectors' unit.
template <int N>
struct VectorsEstimate {
  std::array<Vector3, static_cast<std::size_t>(N)> value;
  double uncertainty = 0;
};

// 50 digits inside, doubles outside. The inputs count as exact; the uncertainty is one rounding to
// double, plus 1e-24 where sin(theta/2) as printed loses half of the digits. InputError, naming the
// quantity: a hinge with a zero-area triangle, a zero-length spring, an input that is not finite.

/// theta [rad] by atan2.
Estimate hinge_angle_50(const std::array<Vector3, 4>& x);

/// sin(theta/2) [1] as printed.
Estimate sin_half_angle_50(const std::array<Vector3, 4>& x);

/// u [1/m] as printed.
VectorsEstimate<4> bending_mode_50(const std::array<Vector3, 4>& x);

/// Elastic and damping forces on the four corners [N], and the energy [J]. The energy uses the
/// factor at rest for either elastic_geometry: at the current geometry no energy exists.
VectorsEstimate<4> bending_elastic_50(const HingeInput& hinge);
VectorsEstimate<4> bending_damping_50(const HingeInput& hinge);
Estimate bending_energy_50(const HingeInput& hinge);

/// Gradient of theta with respect to the four corners [rad/m], by autodiff of the atan2 form.
VectorsEstimate<4> theta_gradient_autodiff(const std::array<Vector3, 4>& x);

/// The same by central differences in 50 digits: shares no derivative rule with the former.
VectorsEstimate<4> theta_gradient_differences(const std::array<Vector3, 4>& x);

/// d(theta)/dt [rad/s] for corners moving with v [m/s], by automatic differentiation
/// along the motion.
Estimate theta_rate_autodiff(const std::array<Vector3, 4>& x, const std::array<Vector3, 4>& v);

/// Gradient of the bending energy with respect to the corners [N], by automatic differentiation;
/// the elastic force with its factor at rest is minus this.
VectorsEstimate<4> energy_gradient_autodiff(const HingeInput& hinge);

/// A 12 x 12 matrix, three rows and columns per corner, and the uncertainty of any entry.
struct MatrixEstimate {
  Eigen::Matrix<double, 12, 12> value;
  double uncertainty = 0;
};

/// The derivative of the elastic force (factor at rest) with respect to the corners [N/m], by
/// automatic differentiation of the force as printed, with sin(theta/2) from the atan2 form.
MatrixEstimate bending_elastic_derivative_autodiff(const HingeInput& hinge);

/// The same by central differences of the force in 50 digits: shares no derivative rule
/// with the former.
MatrixEstimate bending_elastic_derivative_differences(const HingeInput& hinge);

/// Forces on the two ends of a spring [N], its energy [J], and the gradient of that energy
/// by autodiff [N].
VectorsEstimate<2> spring_elastic_50(const SpringInput& spring);
VectorsEstimate<2> spring_damping_50(const SpringInput& spring);
Estimate spring_energy_50(const SpringInput& spring);
VectorsEstimate<2> spring_energy_gradient_autodiff(const SpringInput& spring);

}  // namespace foldproof::oracles
