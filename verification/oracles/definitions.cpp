#include "verification/oracles/definitions.h"

#include <string>

#include "verification/oracles/scalars.h"

namespace foldproof::oracles {

namespace {

using Corners = std::array<Vector3, 4>;
template <int N>
using Gradient = Dual<Digits50, N>;

/// Error of sin(theta/2) as printed, in 50 digits: 1 - n1.n2 carries a few 1e-50, its root at most
/// 1e-24.
constexpr double printed_half_angle_error = 1e-24;

template <class Scalar>
Triple<Scalar> lift(const Vector3& p) {
  return {Scalar(p.x()), Scalar(p.y()), Scalar(p.z())};
}

template <class Scalar>
Quad<Scalar> lift(const Corners& p) {
  return {lift<Scalar>(p[0]), lift<Scalar>(p[1]), lift<Scalar>(p[2]), lift<Scalar>(p[3])};
}

/// p with its coordinates as variables first, first + 1, first + 2 of differentiation.
template <int N>
Triple<Gradient<N>> lift_as_variables(const Vector3& p, int first) {
  return {variable<Digits50, N>(p.x(), first), variable<Digits50, N>(p.y(), first + 1),
          variable<Digits50, N>(p.z(), first + 2)};
}

Quad<Gradient<12>> lift_as_variables(const Corners& x) {
  return {lift_as_variables<12>(x[0], 0), lift_as_variables<12>(x[1], 3),
          lift_as_variables<12>(x[2], 6), lift_as_variables<12>(x[3], 9)};
}

Vector3 rounded(const Triple<Digits50>& p) {
  return Vector3(p.x.convert_to<double>(), p.y.convert_to<double>(), p.z.convert_to<double>());
}

template <std::size_t N>
VectorsEstimate<static_cast<int>(N)> rounded(const std::array<Triple<Digits50>, N>& p) {
  VectorsEstimate<static_cast<int>(N)> result;
  double largest = 0;
  for (std::size_t i = 0; i < N; ++i) {
    result.value[i] = rounded(p[i]);
    for (const double component : result.value[i])
      largest = std::abs(component) > largest ? std::abs(component) : largest;
  }
  result.uncertainty = one_rounding(largest);
  return result;
}

/// The derivatives of f; variable 3 i + k is coordinate k of vector i.
template <std::size_t Count, int N>
VectorsEstimate<static_cast<int>(Count)> rounded_gradient(const Gradient<N>& f) {
  static_assert(N == 3 * Count);
  std::array<Triple<Digits50>, Count> gradient;
  for (std::size_t i = 0; i < Count; ++i) {
    gradient[i] = {f.derivative[3 * i], f.derivative[3 * i + 1], f.derivative[3 * i + 2]};
  }
  return rounded(gradient);
}

void require(bool holds, const std::string& quantity, const std::string& must) {
  if (!holds) throw InputError("oracle definitions: " + quantity + " must be " + must);
}

template <std::size_t N>
void require_finite(const std::array<Vector3, N>& p, const std::string& quantity) {
  for (const Vector3& vector : p) require(vector.allFinite(), quantity, "finite");
}

/// The corners in 50 digits; refuses triangles without area and edges without length.
Quad<Digits50> check_finite(const Corners& x, const std::string& quantity) {
  require_finite(x, quantity);
  const Quad<Digits50> corners = lift<Digits50>(x);
  const HingeShape<Digits50> shape = hinge_shape(corners);
  require(length(shape.N1) > 0 && length(shape.N2) > 0, quantity,
          "corners of two triangles with an area");
  return corners;
}

void require_material(const HingeInput& hinge) {
  require(std::isfinite(hinge.ke) && std::isfinite(hinge.kd), "HingeInput ke and kd", "finite");
  require(std::abs(hinge.theta0) <= pi, "HingeInput theta0", "between -pi and pi");
}

/// The spring's constants in any scalar; refuses a spring without rest length.
template <class Scalar>
SpringLaw<Scalar> check_finite(const SpringInput& spring) {
  const SpringLaw<double>& law = spring.law;
  require_finite(spring.x, "SpringInput x");
  require_finite(spring.v, "SpringInput v");
  require(spring.x[0] != spring.x[1], "SpringInput x", "two different points");
  require(law.rest_length > 0, "SpringInput rest_length", "positive");
  require(std::isfinite(law.young) && std::isfinite(law.damping) && std::isfinite(law.area),
          "SpringInput law", "finite");
  return {Scalar(law.young), Scalar(law.damping), Scalar(law.area), Scalar(law.rest_length)};
}

/// The largest force [N] on a corner for a deflection of 1.
double force_at_unit_deflection(const Quad<Digits50>& x, double ke, const Digits50& factor) {
  Digits50 largest = 0;
  for (const Triple<Digits50>& u : bending_mode(x))
    largest = length(u) > largest ? length(u) : largest;
  return std::abs(ke) * Digits50(factor * largest).convert_to<double>();
}

}  // namespace

Estimate hinge_angle_50(const Corners& x) { return rounded(hinge_angle(check_finite(x, "x"))); }

Estimate sin_half_angle_50(const Corners& x) {
  Estimate result = rounded(sin_half_angle(check_finite(x, "x")));
  result.uncertainty += printed_half_angle_error;
  return result;
}

VectorsEstimate<4> bending_mode_50(const Corners& x) {
  return rounded(bending_mode(check_finite(x, "x")));
}

VectorsEstimate<4> bending_elastic_50(const HingeInput& hinge) {
  require_material(hinge);
  const Quad<Digits50> x = check_finite(hinge.x, "HingeInput x");
  const bool at_rest = hinge.elastic_geometry == Geometry::rest;
  const Digits50 factor =
      anisotropy_factor(at_rest ? check_finite(hinge.rest, "HingeInput rest") : x);
  const Digits50 deflection = sin_half_angle(x) - sin(Digits50(hinge.theta0) / 2);
  VectorsEstimate<4> force =
      rounded(bending_elastic_force(x, Digits50(hinge.ke), factor, deflection));
  force.uncertainty += printed_half_angle_error * force_at_unit_deflection(x, hinge.ke, factor);
  return force;
}

VectorsEstimate<4> bending_damping_50(const HingeInput& hinge) {
  require_material(hinge);
  require_finite(hinge.v, "HingeInput v");
  const Quad<Digits50> x = check_finite(hinge.x, "HingeInput x");
  const bool at_rest = hinge.damping_geometry == Geometry::rest;
  const Quad<Digits50> shape = at_rest ? check_finite(hinge.rest, "HingeInput rest") : x;
  const bool as_printed = hinge.damping_factor == DampingFactor::edge_length;
  const Digits50 factor = as_printed ? edge_length(shape) : anisotropy_factor(shape);
  return rounded(bending_damping_force(x, lift<Digits50>(hinge.v), Digits50(hinge.kd), factor));
}

Estimate bending_energy_50(const HingeInput& hinge) {
  require_material(hinge);
  const Digits50 factor = anisotropy_factor(check_finite(hinge.rest, "HingeInput rest"));
  const Quad<Digits50> x = check_finite(hinge.x, "HingeInput x");
  return rounded(bending_energy(x, Digits50(hinge.ke), factor, Digits50(hinge.theta0)));
}

VectorsEstimate<4> theta_gradient_autodiff(const Corners& x) {
  check_finite(x, "x");
  return rounded_gradient<4>(hinge_angle(lift_as_variables(x)));
}

// The error of a central difference is step^2/6 theta''' + rounding/step: at 1e-16 of the hinge's
// size both are below 1e-30 of the gradient, far under the rounding of the result.
VectorsEstimate<4> theta_gradient_differences(const Corners& x) {
  const Quad<Digits50> corners = check_finite(x, "x");
  const Digits50 step = Digits50("1e-16") * edge_length(corners);
  Quad<Digits50> gradient;
  for (std::size_t corner = 0; corner < 4; ++corner) {
    for (Digits50 Triple<Digits50>::*coordinate :
         {&Triple<Digits50>::x, &Triple<Digits50>::y, &Triple<Digits50>::z}) {
      Quad<Digits50> ahead = corners, behind = corners;
      ahead[corner].*coordinate += step;
      behind[corner].*coordinate -= step;
      gradient[corner].*coordinate = (hinge_angle(ahead) - hinge_angle(behind)) / (2 * step);
    }
  }
  return rounded(gradient);
}

Estimate theta_rate_autodiff(const Corners& x, const Corners& v) {
  check_finite(x, "x");
  require_finite(v, "v");
  const Gradient<1> t = variable<Digits50, 1>(Digits50(0), 0);
  Quad<Gradient<1>> moving;
  for (std::size_t i = 0; i < 4; ++i)
    moving[i] = lift<Gradient<1>>(x[i]) + t * lift<Gradient<1>>(v[i]);
  return rounded(hinge_angle(moving).derivative[0]);
}

VectorsEstimate<4> energy_gradient_autodiff(const HingeInput& hinge) {
  require_material(hinge);
  check_finite(hinge.x, "HingeInput x");
  const Gradient<12> factor = anisotropy_factor(check_finite(hinge.rest, "HingeInput rest"));
  const Gradient<12> ke = Digits50(hinge.ke), theta0 = Digits50(hinge.theta0);
  return rounded_gradient<4>(bending_energy(lift_as_variables(hinge.x), ke, factor, theta0));
}

namespace {

/// The elastic force with its factor at rest, smooth through flat.
template <class Scalar>
Quad<Scalar> smooth_elastic_force(const HingeInput& hinge, const Quad<Scalar>& x) {
  using std::sin;
  const Digits50 factor = anisotropy_factor(check_finite(hinge.rest, "HingeInput rest"));
  const Scalar deflection =
      sin(hinge_angle(x) / Scalar(2)) - Scalar(sin(Digits50(hinge.theta0) / 2));
  return bending_elastic_force(x, Scalar(Digits50(hinge.ke)), Scalar(factor), deflection);
}

/// Component a of a vector.
template <class Scalar>
Scalar& component(Triple<Scalar>& triple, int a) {
  return a == 0 ? triple.x : a == 1 ? triple.y : triple.z;
}

}  // namespace

MatrixEstimate bending_elastic_derivative_autodiff(const HingeInput& hinge) {
  require_material(hinge);
  check_finite(hinge.x, "HingeInput x");
  Quad<Gradient<12>> force = smooth_elastic_force(hinge, lift_as_variables(hinge.x));
  MatrixEstimate result;
  for (int row = 0; row < 12; ++row)
    for (int column = 0; column < 12; ++column) {
      const Digits50 entry = component(force[size_t(row / 3)], row % 3).derivative[size_t(column)];
      result.value(row, column) = rounded(entry).value;
      result.uncertainty = std::max(result.uncertainty, rounded(entry).uncertainty);
    }
  return result;
}

MatrixEstimate bending_elastic_derivative_differences(const HingeInput& hinge) {
  require_material(hinge);
  const Quad<Digits50> x = check_finite(hinge.x, "HingeInput x");
  const Digits50 step = Digits50("1e-16") * edge_length(x);
  MatrixEstimate result;
  for (int column = 0; column < 12; ++column) {
    Quad<Digits50> ahead = x, behind = x;
    component(ahead[size_t(column / 3)], column % 3) += step;
    component(behind[size_t(column / 3)], column % 3) -= step;
    Quad<Digits50> up = smooth_elastic_force(hinge, ahead),
                   down = smooth_elastic_force(hinge, behind);
    for (int row = 0; row < 12; ++row) {
      const Digits50 entry =
          (component(up[size_t(row / 3)], row % 3) - component(down[size_t(row / 3)], row % 3)) /
          (2 * step);
      result.value(row, column) = rounded(entry).value;
      result.uncertainty = std::max(result.uncertainty, rounded(entry).uncertainty);
    }
  }
  return result;
}

VectorsEstimate<2> spring_elastic_50(const SpringInput& spring) {
  const SpringLaw<Digits50> law = check_finite<Digits50>(spring);
  const Triple<Digits50> on_a =
      spring_elastic_force(lift<Digits50>(spring.x[0]), lift<Digits50>(spring.x[1]), law);
  return rounded(std::array{on_a, -on_a});
}

VectorsEstimate<2> spring_damping_50(const SpringInput& spring) {
  const SpringLaw<Digits50> law = check_finite<Digits50>(spring);
  const Triple<Digits50> difference = lift<Digits50>(spring.v[1]) - lift<Digits50>(spring.v[0]);
  const Triple<Digits50> on_a = spring_damping_force(lift<Digits50>(spring.x[0]),
                                                     lift<Digits50>(spring.x[1]), difference, law);
  return rounded(std::array{on_a, -on_a});
}

Estimate spring_energy_50(const SpringInput& spring) {
  const SpringLaw<Digits50> law = check_finite<Digits50>(spring);
  return rounded(spring_energy(lift<Digits50>(spring.x[0]), lift<Digits50>(spring.x[1]), law));
}

VectorsEstimate<2> spring_energy_gradient_autodiff(const SpringInput& spring) {
  const SpringLaw<Gradient<6>> law = check_finite<Gradient<6>>(spring);
  return rounded_gradient<2>(spring_energy(lift_as_variables<6>(spring.x[0], 0),
                                           lift_as_variables<6>(spring.x[1], 3), law));
}

}  // namespace foldproof::oracles
