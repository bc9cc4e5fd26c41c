// The printed formulas and their derivatives: what they refuse, how sure they are, and a second way
// for each entry of a matrix.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "verification/oracles/definitions.h"
#include "verification/oracles/force_derivatives.h"
#include "verification/oracles/scalars.h"
#include "verification/tests/complaint.h"
#include "verification/tests/hinge_specimens.h"

using namespace foldproof;
using namespace foldproof::oracles;

namespace {

constexpr double half_ulp = 0.5 * std::numeric_limits<double>::epsilon();

template <int N>
double largest(const std::array<Vector3, std::size_t(N)>& p) {
  double most = 0;
  for (const Vector3& v : p) most = std::max(most, v.cwiseAbs().maxCoeff());
  return most;
}

std::string must(const std::string& what) { return "oracle definitions: " + what; }

SpringInput spring() {
  return {{Vector3(.1, .2, -.3), Vector3(.9, -.4, .5)},
          {Vector3(1, .7, .2), Vector3(-.4, 2, .6)},
          {53, .21, .34, .91}};
}

}  // namespace

TEST_CASE("a number's rounding is half its last place, and never nothing") {
  CHECK(one_rounding(3) == 3 * half_ulp + std::numeric_limits<double>::min());
  CHECK(one_rounding(-3) == one_rounding(3));
  CHECK(one_rounding(0) == std::numeric_limits<double>::min());
  const Estimate third = rounded(Digits50(1) / 3);
  CHECK(third.value == 1. / 3);
  CHECK(third.uncertainty == one_rounding(1. / 3));
  CHECK_THROWS_AS((variable<double, 3>(.7, 3)), std::out_of_range);
  CHECK_THROWS_AS((variable<double, 3>(.7, -1)), std::out_of_range);
}

TEST_CASE("dual numbers are compared by their values") {
  using Number = Dual<double, 2>;
  const Number p = variable<double, 2>(.7, 0), q = variable<double, 2>(.9, 1),
               same = variable<double, 2>(.7, 1);
  CHECK((p < q && p <= q && q > p && q >= p && p == same && p <= same && p >= same));
  CHECK_FALSE((q < p || q <= p || p > q || p >= q || p == q || p < same || p > same));
  const Number minus = -p;
  CHECK(minus.value == -.7);
  CHECK(minus.derivative[0] == -1);
  const Number size = abs(minus * Number(3));
  CHECK(size.value == Approx(2.1));
  CHECK(size.derivative[0] == Approx(3));
}

TEST_CASE("vectors by the formulas are as sure as one rounding of their largest component") {
  for (const HingeInput& hinge : hinges()) {
    const auto mode = bending_mode_50(hinge.x);
    CHECK(mode.uncertainty == one_rounding(largest<4>(mode.value)));
    const auto gradient = theta_gradient_autodiff(hinge.x);
    CHECK(gradient.uncertainty == one_rounding(largest<4>(gradient.value)));
    const auto damping = bending_damping_50(hinge);
    CHECK(damping.uncertainty == one_rounding(largest<4>(damping.value)));
    // sin(theta/2) as printed loses half of the digits
    const auto force = bending_elastic_50(hinge);
    CHECK(force.uncertainty >= one_rounding(largest<4>(force.value)));
    CHECK(force.uncertainty < one_rounding(largest<4>(force.value)) * (1 + 1e-6));
    CHECK(bending_energy_50(hinge).uncertainty == one_rounding(bending_energy_50(hinge).value));
    CHECK(hinge_angle_50(hinge.x).uncertainty == one_rounding(hinge_angle_50(hinge.x).value));
  }
  const auto force = spring_elastic_50(spring());
  CHECK(force.uncertainty == one_rounding(largest<2>(force.value)));
  CHECK(force.value[1] == -force.value[0]);
}

TEST_CASE("near flat the printed sine and the force on it are as sure as half the digits") {
  HingeInput hinge = first_hinge();
  hinge.x = {Vector3(-.6, 0, .2), Vector3(.7, 0, .4), Vector3(0, 0, 0), Vector3(0, 0, .9)};
  hinge.theta0 = 0;
  CHECK(sin_half_angle_50(hinge.x).uncertainty >= 1e-24);
  CHECK(sin_half_angle_50(hinge.x).uncertainty < 1.1e-24);
  // the factor at rest, times u: |E|/|N1| of corner 1, |E|/|N2| of corner 2, and their sums
  double most = 0;
  for (const Vector3& u : bending_mode_50(hinge.x).value) most = std::max(most, u.norm());
  const Corners& r = hinge.rest;
  const double factor = (r[3] - r[2]).squaredNorm() / ((r[0] - r[2]).cross(r[0] - r[3]).norm() +
                                                       (r[1] - r[2]).cross(r[1] - r[3]).norm());
  for (const double ke : {3.7e-3, -3.7e-3}) {
    hinge.ke = ke;
    CHECK(bending_elastic_50(hinge).uncertainty ==
          Approx(1e-24 * 3.7e-3 * factor * most).epsilon(1e-6));
  }
}

TEST_CASE("the formulas name the input that they refuse") {
  const HingeInput good = first_hinge();
  const auto with = [&](const auto& edit) {
    HingeInput hinge = good;
    edit(hinge);
    return hinge;
  };
  const std::string flat = " must be corners of two triangles with an area";
  const auto of_x = [&](const HingeInput& hinge) {
    return std::array{complaint([&] { hinge_angle_50(hinge.x); }),
                      complaint([&] { sin_half_angle_50(hinge.x); }),
                      complaint([&] { bending_mode_50(hinge.x); }),
                      complaint([&] { theta_gradient_autodiff(hinge.x); }),
                      complaint([&] { theta_gradient_differences(hinge.x); }),
                      complaint([&] { theta_rate_autodiff(hinge.x, hinge.v); })};
  };
  const auto of_hinge = [&](const HingeInput& hinge) {
    return std::array{complaint([&] { bending_elastic_50(hinge); }),
                      complaint([&] { bending_energy_50(hinge); }),
                      complaint([&] { energy_gradient_autodiff(hinge); }),
                      complaint([&] { bending_elastic_derivative_autodiff(hinge); }),
                      complaint([&] { bending_elastic_derivative_differences(hinge); })};
  };
  for (const std::string& said : of_x(good)) CHECK(said.empty());
  for (const std::string& said : of_hinge(good)) CHECK(said.empty());
  for (const int corner : {0, 1}) {  // on the edge's line
    const HingeInput in_line = with([&](HingeInput& h) { h.x[std::size_t(corner)] = h.x[3]; });
    for (const std::string& said : of_x(in_line)) CHECK(said == must("x" + flat));
    for (const std::string& said : of_hinge(in_line)) CHECK(said == must("HingeInput x" + flat));
    CHECK(complaint([&] { bending_damping_50(in_line); }) == must("HingeInput x" + flat));
    const HingeInput rest_in_line =
        with([&](HingeInput& h) { h.rest[std::size_t(corner)] = h.rest[3]; });
    for (const std::string& said : of_hinge(rest_in_line))
      CHECK(said == must("HingeInput rest" + flat));
  }
  const HingeInput infinite = with([](HingeInput& h) { h.x[3].z() = INFINITY; });
  for (const std::string& said : of_x(infinite)) CHECK(said == must("x must be finite"));
  for (const std::string& said : of_hinge(infinite))
    CHECK(said == must("HingeInput x must be finite"));
  const HingeInput fast = with([](HingeInput& h) { h.v[2].y() = NAN; });
  CHECK(complaint([&] { theta_rate_autodiff(fast.x, fast.v); }) == must("v must be finite"));
  CHECK(complaint([&] { bending_damping_50(fast); }) == must("HingeInput v must be finite"));
  for (const HingeInput& hinge :
       {with([](HingeInput& h) { h.ke = NAN; }), with([](HingeInput& h) { h.kd = INFINITY; })}) {
    for (const std::string& said : of_hinge(hinge))
      CHECK(said == must("HingeInput ke and kd must be finite"));
    CHECK(complaint([&] { bending_damping_50(hinge); }) ==
          must("HingeInput ke and kd must be finite"));
  }
  for (const double theta0 : {std::nextafter(pi, 4), std::nextafter(-pi, -4), double(NAN)})
    for (const std::string& said : of_hinge(with([&](HingeInput& h) { h.theta0 = theta0; })))
      CHECK(said == must("HingeInput theta0 must be between -pi and pi"));
  for (const double theta0 : {pi, -pi})
    CHECK(complaint([&] {
            bending_energy_50(with([&](HingeInput& h) { h.theta0 = theta0; }));
          }).empty());
  // rest corners matter where a factor is taken at rest only
  const HingeInput no_rest = with([](HingeInput& h) {
    h.rest[0] = h.rest[2];
    h.elastic_geometry = Geometry::current;
    h.damping_geometry = Geometry::current;
  });
  CHECK(complaint([&] { bending_elastic_50(no_rest); }).empty());
  CHECK(complaint([&] { bending_damping_50(no_rest); }).empty());
}

TEST_CASE("the formulas of springs name the input that they refuse") {
  const auto of = [](const auto& edit) {
    SpringInput input = spring();
    edit(input);
    const std::string first = complaint([&] { spring_elastic_50(input); });
    CHECK(first == complaint([&] { spring_damping_50(input); }));
    CHECK(first == complaint([&] { spring_energy_50(input); }));
    CHECK(first == complaint([&] { spring_energy_gradient_autodiff(input); }));
    return first;
  };
  CHECK(of([](SpringInput&) {}).empty());
  CHECK(of([](SpringInput& s) { s.x[1].y() = NAN; }) == must("SpringInput x must be finite"));
  CHECK(of([](SpringInput& s) { s.v[0].z() = INFINITY; }) == must("SpringInput v must be finite"));
  CHECK(of([](SpringInput& s) { s.x[1] = s.x[0]; }) ==
        must("SpringInput x must be two different points"));
  for (const double length : {0., -1., double(NAN)})
    CHECK(of([&](SpringInput& s) { s.law.rest_length = length; }) ==
          must("SpringInput rest_length must be positive"));
  for (double SpringLaw<double>::*part :
       {&SpringLaw<double>::young, &SpringLaw<double>::damping, &SpringLaw<double>::area})
    CHECK(of([&](SpringInput& s) { s.law.*part = INFINITY; }) ==
          must("SpringInput law must be finite"));
}

TEST_CASE(
    "both methods give the same symmetric derivative of the elastic force, equally accurate") {
  for (const HingeInput& hinge : hinges()) {
    const MatrixEstimate one = bending_elastic_derivative_autodiff(hinge),
                         other = bending_elastic_derivative_differences(hinge);
    const double most = one.value.cwiseAbs().maxCoeff();
    CHECK((one.value - other.value).cwiseAbs().maxCoeff() <= 2 * one_rounding(most));
    CHECK((one.value - one.value.transpose()).cwiseAbs().maxCoeff() <= 2 * one_rounding(most));
    CHECK(one.uncertainty == one_rounding(most));
    CHECK(other.uncertainty == Approx(one_rounding(most)).epsilon(1e-12));
    CHECK(most > 0);
    // columns of translations add up to nothing
    for (int k = 0; k < 3; ++k) {
      Eigen::Matrix<double, 12, 1> sum = Eigen::Matrix<double, 12, 1>::Zero();
      for (int corner = 0; corner < 4; ++corner) sum += one.value.col(3 * corner + k);
      CHECK(sum.norm() < 12 * one_rounding(most));
    }
    // without damping it is the whole force's
    HingeInput undamped = hinge;
    undamped.kd = 0;
    undamped.elastic_geometry = Geometry::rest;
    CHECK((bending_force_derivative_autodiff(undamped).value - one.value).norm() <=
          12 * one_rounding(most));
  }
}

TEST_CASE("derivatives of the whole force of a hinge are those of differences, entry by entry") {
  for (HingeInput hinge : hinges())
    for (const int variant : {0, 3, 5, 6}) {
      hinge.elastic_geometry = variant & 1 ? Geometry::current : Geometry::rest;
      hinge.damping_geometry = variant & 2 ? Geometry::current : Geometry::rest;
      hinge.damping_factor = variant & 4 ? DampingFactor::anisotropy : DampingFactor::edge_length;
      const MatrixEstimate one = bending_force_derivative_autodiff(hinge),
                           other = bending_force_derivative_differences(hinge);
      const double most = one.value.cwiseAbs().maxCoeff();
      CHECK((one.value - other.value).cwiseAbs().maxCoeff() <= 2 * one_rounding(most));
      CHECK(one.uncertainty == one_rounding(most));
      CHECK(other.uncertainty == Approx(one_rounding(most)).epsilon(1e-12));
      // against differences of the forces as printed, in double
      const double step = 1e-6 * (hinge.x[3] - hinge.x[2]).norm();
      for (int column = 0; column < 12; ++column) {
        HingeInput ahead = hinge, behind = hinge;
        ahead.x[std::size_t(column / 3)][column % 3] += step;
        behind.x[std::size_t(column / 3)][column % 3] -= step;
        const auto total = [](const HingeInput& h) {
          Corners force = bending_elastic_50(h).value;
          const Corners damping = bending_damping_50(h).value;
          for (std::size_t i = 0; i < 4; ++i) force[i] += damping[i];
          return force;
        };
        const Corners up = total(ahead), down = total(behind);
        for (int row = 0; row < 12; ++row)
          CHECK(std::abs((up[std::size_t(row / 3)][row % 3] - down[std::size_t(row / 3)][row % 3]) /
                             (2 * step) -
                         one.value(row, column)) < 1e-7 * most);
      }
    }
}

TEST_CASE("derivatives of a spring's force are those of differences, entry by entry") {
  const SpringInput input = spring();
  const SpringMatrixEstimate matrix = spring_force_derivative_autodiff(input);
  const double most = matrix.value.cwiseAbs().maxCoeff(), step = 1e-6;
  CHECK(matrix.uncertainty == one_rounding(most));
  for (int column = 0; column < 6; ++column) {
    SpringInput ahead = input, behind = input;
    ahead.x[std::size_t(column / 3)][column % 3] += step;
    behind.x[std::size_t(column / 3)][column % 3] -= step;
    for (int row = 0; row < 6; ++row) {
      const auto force = [&](const SpringInput& s) {
        return spring_elastic_50(s).value[std::size_t(row / 3)][row % 3] +
               spring_damping_50(s).value[std::size_t(row / 3)][row % 3];
      };
      CHECK(std::abs((force(ahead) - force(behind)) / (2 * step) - matrix.value(row, column)) <
            1e-8 * most);
    }
  }
}
