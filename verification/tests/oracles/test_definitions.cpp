// The printed formulas in 50 digits, each compared with a second way.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <tuple>

#include "verification/tests/hinge_specimens.h"
#include "verification/oracles/definitions.h"
#include "verification/oracles/exact_solutions.h"
#include "verification/oracles/heavy_cantilever.h"
#include "verification/oracles/scalars.h"

using namespace foldproof;
using namespace foldproof::oracles;

TEST_CASE("dual numbers carry first and second derivatives of every function they offer") {
  using First = Dual<Digits50, 2>;
  using Second = Dual<First, 2>;
  const auto f = [](const auto& x, const auto& y) {
    return atan2(y, x) * sqrt(x + y * y) - sin(x * y) / (2 + cos(x)) +
           acos(x / 3 - y / 5) * abs(y - x);
  };
  for (const auto& [px, py] : {std::pair{.7, .4}, std::pair{-.3, 1.9}}) {
    const Digits50 x = px, y = py, step("1e-12");
    const Second value = f(variable<First, 2>(variable<Digits50, 2>(x, 0), 0),
                           variable<First, 2>(variable<Digits50, 2>(y, 1), 1));
    const auto at = [&](int i, int j) { return f(Digits50(x + i * step), Digits50(y + j * step)); };
    const auto close = [](const Digits50& p, const Digits50& q) {
      return abs(p - q) < Digits50("1e-20");
    };
    CHECK(close(value.value.value, at(0, 0)));
    CHECK(close(value.derivative[0].value, (at(1, 0) - at(-1, 0)) / (2 * step)));
    CHECK(close(value.value.derivative[1], (at(0, 1) - at(0, -1)) / (2 * step)));
    CHECK(close(value.derivative[0].derivative[0],
                (at(1, 0) - 2 * at(0, 0) + at(-1, 0)) / (step * step)));
    CHECK(close(value.derivative[1].derivative[0],
                (at(1, 1) - at(1, -1) - at(-1, 1) + at(-1, -1)) / (4 * step * step)));
    CHECK(value.derivative[1].derivative[0] - value.derivative[0].derivative[1] <
          Digits50("1e-45"));
  }
}

TEST_CASE("theta is the turn of corner 2 about the edge, and sin(theta/2) as printed agrees") {
  for (const double turn : {-3.1, -1.7, -1e-9, 0., 1e-9, .4, 2.2, 3.1}) {
    const Vector3 arm(.83 * std::cos(turn), .83 * std::sin(turn), .29);
    const Corners x{Vector3(-.57, 0, .31), arm, Vector3(0, 0, -.13), Vector3(0, 0, .97)};
    CHECK(std::abs(hinge_angle_50(x).value - turn) < roundings);
    CHECK(std::abs(sin_half_angle_50(x).value - std::sin(turn / 2)) < roundings);
  }
  for (const HingeInput& hinge : hinges()) {
    CHECK(std::abs(sin_half_angle_50(hinge.x).value - std::sin(hinge_angle_50(hinge.x).value / 2)) <
          roundings);
  }
  CHECK(hinge_angle_50(first_hinge().x).value * hinge_angle_50(second_hinge().x).value < 0);
}

TEST_CASE("u is orthogonal to the eleven other modes") {
  for (const HingeInput& hinge : hinges()) {
    const auto& [x1, x2, x3, x4] = hinge.x;
    const Corners u = bending_mode_50(hinge.x).value;
    const double bound = roundings * size(u);
    CHECK((u[0] + u[1] + u[2] + u[3]).norm() < bound);
    Vector3 torque = Vector3::Zero();
    for (std::size_t i = 0; i < 4; ++i) torque += hinge.x[i].cross(u[i]);
    CHECK(torque.norm() < bound * size(hinge.x));
    for (const Vector3& in_plane : {Vector3(x1 - x3), Vector3(x1 - x4)})
      CHECK(std::abs(u[0].dot(in_plane)) < bound);
    for (const Vector3& in_plane : {Vector3(x2 - x3), Vector3(x2 - x4)})
      CHECK(std::abs(u[1].dot(in_plane)) < bound);
    CHECK(std::abs((u[3] - u[2]).dot(x4 - x3)) < bound);
  }
}

TEST_CASE("u is minus the gradient of theta, by autodiff and by differences") {
  for (const HingeInput& hinge : hinges()) {
    const Corners minus_u = scaled(-1, bending_mode_50(hinge.x).value);
    const auto by_autodiff = theta_gradient_autodiff(hinge.x),
               by_differences = theta_gradient_differences(hinge.x);
    CHECK(distance(by_autodiff.value, by_differences.value) <= 12 * by_autodiff.uncertainty);
    CHECK(distance(by_autodiff.value, minus_u) <= 12 * by_autodiff.uncertainty);
    const Estimate rate = theta_rate_autodiff(hinge.x, hinge.v);
    CHECK(std::abs(rate.value - dot(minus_u, hinge.v)) < roundings * size(minus_u) * size(hinge.v));
  }
}

TEST_CASE("the elastic force is minus the gradient of the energy, if its factor is taken at rest") {
  for (HingeInput hinge : hinges()) {
    const Corners force = bending_elastic_50(hinge).value;
    CHECK(distance(force, scaled(-1, energy_gradient_autodiff(hinge).value)) <
          roundings * size(force));
    const auto factor = [](const Corners& x) {
      const double twice_areas =
          (x[0] - x[2]).cross(x[0] - x[3]).norm() + (x[1] - x[2]).cross(x[1] - x[3]).norm();
      return (x[3] - x[2]).squaredNorm() / twice_areas;
    };
    const double deflection =
        std::sin(hinge_angle_50(hinge.x).value / 2) - std::sin(hinge.theta0 / 2);
    const Corners u = bending_mode_50(hinge.x).value;
    CHECK(distance(force, scaled(hinge.ke * factor(hinge.rest) * deflection, u)) <
          roundings * size(force));
    hinge.elastic_geometry = Geometry::current;
    const Corners now = bending_elastic_50(hinge).value;
    CHECK(distance(now, scaled(hinge.ke * factor(hinge.x) * deflection, u)) <
          roundings * size(now));
    CHECK(distance(now, force) > 1e-3 * size(force));
    hinge.theta0 = hinge_angle_50(hinge.x).value;
    CHECK(std::abs(bending_energy_50(hinge).value) < roundings * hinge.ke);
    CHECK(size(bending_elastic_50(hinge).value) < roundings * size(force));
  }
}

TEST_CASE("the damping force takes kd factor (d theta/dt)^2 of power, whichever factor") {
  for (HingeInput hinge : hinges()) {
    const double rate = theta_rate_autodiff(hinge.x, hinge.v).value;
    for (const Geometry geometry : {Geometry::rest, Geometry::current}) {
      const Corners& shape = geometry == Geometry::rest ? hinge.rest : hinge.x;
      const double edge = (shape[3] - shape[2]).norm();
      const double N1 = (shape[0] - shape[2]).cross(shape[0] - shape[3]).norm();
      const double N2 = (shape[1] - shape[2]).cross(shape[1] - shape[3]).norm();
      for (const auto& [kind, factor] :
           {std::pair{DampingFactor::edge_length, edge},
            std::pair{DampingFactor::anisotropy, edge * edge / (N1 + N2)}}) {
        hinge.damping_geometry = geometry;
        hinge.damping_factor = kind;
        const Corners force = bending_damping_50(hinge).value;
        const double power = dot(force, hinge.v), expected = -hinge.kd * factor * rate * rate;
        CHECK(std::abs(power - expected) < roundings * size(force) * size(hinge.v));
        CHECK(power < 0);
      }
    }
  }
}

TEST_CASE(
    "a spring's force is minus the gradient of its energy, and its damping takes power along it "
    "only") {
  const SpringInput first{{Vector3(.1, .2, -.3), Vector3(.9, -.4, .5)},
                          {Vector3(1, .7, .2), Vector3(-.4, 2, .6)},
                          {53, .21, .34, .91}};
  const SpringInput second{{Vector3(-2, .6, 1.3), Vector3(.3, 1.4, .8)},
                           {Vector3(.3, -.9, 3), Vector3(.8, .5, -.2)},
                           {710, 1.9, .067, 3.3}};
  for (const SpringInput& spring : {first, second}) {
    const auto force = spring_elastic_50(spring),
               gradient = spring_energy_gradient_autodiff(spring);
    const Vector3 d = spring.x[1] - spring.x[0], direction = d.normalized();
    const SpringLaw<double>& law = spring.law;
    const double strain = d.norm() / law.rest_length - 1;
    for (std::size_t i : {0, 1})
      CHECK((force.value[i] + gradient.value[i]).norm() <= 4 * force.uncertainty);
    const double tension = law.young * law.area / law.rest_length * strain;
    CHECK((force.value[0] - tension * direction).norm() <
          roundings * law.young * law.area / law.rest_length);
    const double energy = law.young * law.area / 2 * strain * strain;
    CHECK(std::abs(spring_energy_50(spring).value - energy) < roundings * law.young * law.area);
    const auto damping = spring_damping_50(spring);
    const double closing = (spring.v[1] - spring.v[0]).dot(direction);
    const double coefficient = law.damping * law.area / (law.rest_length * law.rest_length);
    CHECK((damping.value[0] - coefficient * closing * direction).norm() <
          roundings * coefficient * 10);
    CHECK((damping.value[0] + damping.value[1]).norm() == 0);
  }
}

TEST_CASE("degenerate input is refused") {
  HingeInput hinge = first_hinge();
  hinge.rest[0] = hinge.rest[2];
  CHECK_THROWS_AS(bending_elastic_50(hinge), InputError);
  hinge.x[1].x() = std::nan("");
  CHECK_THROWS_AS(bending_mode_50(hinge.x), InputError);
  CHECK_THROWS_AS(oscillator_at({-1., .2, 1, 0}, 1), InputError);
  CHECK_THROWS_AS(verlet_oscillator({4., 0, 1, 0}, 1.01, 5), InputError);
  CHECK_THROWS_AS(heavy_cantilever(std::nan("")), InputError);
}
