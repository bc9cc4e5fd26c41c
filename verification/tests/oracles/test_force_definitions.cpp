// The printed formulas in 50 digits and their derivatives: refused input, uncertainties, and a
// second way for each.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>

#include "verification/oracles/definitions.h"
#include "verification/oracles/force_derivatives.h"
#include "verification/oracles/scalars.h"
#include "verification/tests/complaint.h"
#include "verification/tests/hinge_specimens.h"

using namespace foldproof;
using namespace foldproof::oracles;

namespace {

double largest(const Corners& p) {
  double most = 0;
  for (const Vector3& v : p) most = std::max(most, v.cwiseAbs().maxCoeff());
  return most;
}

SpringInput spring() {
  return {{Vector3(.1, .2, -.3), Vector3(.9, -.4, .5)},
          {Vector3(1, .7, .2), Vector3(-.4, 2, .6)},
          {53, .21, .34, .91}};
}

/// |E|^2/(|N1| + |N2|) and |E|.
std::array<double, 2> factors_of(const Corners& x) {
  const double twice_areas =
      (x[0] - x[2]).cross(x[0] - x[3]).norm() + (x[1] - x[2]).cross(x[1] - x[3]).norm();
  return {(x[3] - x[2]).squaredNorm() / twice_areas, (x[3] - x[2]).norm()};
}

/// The hinge with its factors taken as the bits of `variant` say.
HingeInput with_factors(HingeInput hinge, int variant) {
  hinge.elastic_geometry = variant & 1 ? Geometry::current : Geometry::rest;
  hinge.damping_geometry = variant & 2 ? Geometry::current : Geometry::rest;
  hinge.damping_factor = variant & 4 ? DampingFactor::anisotropy : DampingFactor::edge_length;
  return hinge;
}

Corners force_of(const HingeInput& hinge) {
  const Corners elastic = bending_elastic_50(hinge).value,
                damping = bending_damping_50(hinge).value;
  return {elastic[0] + damping[0], elastic[1] + damping[1], elastic[2] + damping[2],
          elastic[3] + damping[3]};
}

}  // namespace

TEST_CASE("theta is the turn of corner 2 about the edge, and sin(theta/2) as printed agrees") {
  for (const double turn : {-3.1, -1.7, -1e-9, 0., 1e-9, .4, 2.2, 3.1}) {
    const Vector3 arm(.83 * std::cos(turn), .83 * std::sin(turn), .29);
    const Corners x{Vector3(-.57, 0, .31), arm, Vector3(0, 0, -.13), Vector3(0, 0, .97)};
    CHECK(std::abs(hinge_angle_50(x).value - turn) < roundings);
    CHECK(std::abs(sin_half_angle_50(x).value - std::sin(turn / 2)) < roundings);
  }
}

TEST_CASE("forces take their factors at rest or now, and the energy begins at the rest angle") {
  for (const HingeInput& hinge : hinges())
    for (int variant = 0; variant < 8; ++variant) {
      HingeInput other = with_factors(hinge, variant);
      const Corners u = bending_mode_50(hinge.x).value;
      const double deflection =
          std::sin(hinge_angle_50(hinge.x).value / 2) - std::sin(hinge.theta0 / 2);
      const double elastic = factors_of(variant & 1 ? hinge.x : hinge.rest)[0],
                   damping = factors_of(variant & 2 ? hinge.x : hinge.rest)[variant & 4 ? 0 : 1];
      const Corners force = bending_elastic_50(other).value;
      CHECK(distance(force, scaled(hinge.ke * elastic * deflection, u)) < roundings * size(force));
      const Corners drag = scaled(-hinge.kd * damping * dot(u, hinge.v), u);
      CHECK(distance(bending_damping_50(other).value, drag) < roundings * size(drag));
      other.theta0 = hinge_angle_50(hinge.x).value;
      CHECK(std::abs(bending_energy_50(other).value) < roundings * hinge.ke);
      CHECK(size(bending_elastic_50(other).value) < roundings * size(force));
    }
  const SpringInput edge = spring();
  const Vector3 d = edge.x[1] - edge.x[0], n = d.normalized();
  const double strain = d.norm() / .91 - 1;
  CHECK(spring_energy_50(edge).value == Approx(53 * .34 / 2 * strain * strain).epsilon(1e-14));
  const auto drag = spring_damping_50(edge);
  CHECK((drag.value[0] - .21 * .34 / (.91 * .91) * n.dot(edge.v[1] - edge.v[0]) * n).norm() <
        roundings);
  CHECK(drag.value[1] == -drag.value[0]);
}

TEST_CASE("numbers and vectors are as sure as one rounding of their largest component") {
  CHECK(one_rounding(-3) ==
        1.5 * std::numeric_limits<double>::epsilon() + std::numeric_limits<double>::min());
  CHECK(one_rounding(0) == std::numeric_limits<double>::min());
  CHECK(rounded(Digits50(1) / 3).uncertainty == one_rounding(1. / 3));
  for (const HingeInput& hinge : hinges()) {
    for (const auto& vectors :
         {bending_mode_50(hinge.x), theta_gradient_autodiff(hinge.x), bending_damping_50(hinge)})
      CHECK(vectors.uncertainty == one_rounding(largest(vectors.value)));
    // sin(theta/2) as printed loses half of the digits
    const auto force = bending_elastic_50(hinge);
    CHECK(force.uncertainty >= one_rounding(largest(force.value)));
    CHECK(force.uncertainty < one_rounding(largest(force.value)) * (1 + 1e-6));
  }
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
  const double factor = factors_of(hinge.rest)[0];
  for (const double ke : {3.7e-3, -3.7e-3}) {
    hinge.ke = ke;
    CHECK(bending_elastic_50(hinge).uncertainty ==
          Approx(1e-24 * 3.7e-3 * factor * most).epsilon(1e-6));
  }
}

TEST_CASE("the formulas name the input that they refuse") {
  using Edit = std::function<void(HingeInput&)>;
  const std::string flat = "x must be corners of two triangles with an area";
  for (const auto& [edit, why] : std::vector<std::pair<Edit, std::string>>{
           {[](HingeInput&) {}, ""},
           {[](HingeInput& h) { h.x[0] = h.x[3]; }, flat},
           {[](HingeInput& h) { h.x[1] = h.x[3]; }, flat},
           {[](HingeInput& h) { h.x[3].z() = INFINITY; }, "x must be finite"},
           {[](HingeInput& h) { h.rest[0] = h.rest[3]; }, "rest must be corners"},
           {[](HingeInput& h) { h.v[2].y() = NAN; }, "v must be finite"},
           {[](HingeInput& h) { h.ke = NAN; }, "ke and kd must be finite"},
           {[](HingeInput& h) { h.kd = INFINITY; }, "ke and kd must be finite"},
           {[](HingeInput& h) { h.theta0 = pi; }, ""},
           {[](HingeInput& h) { h.theta0 = std::nextafter(pi, 4); }, "theta0 must be between"},
           {[](HingeInput& h) { h.theta0 = std::nextafter(-pi, -4); }, "theta0 must be between"}}) {
    HingeInput h = first_hinge();
    edit(h);
    const std::string said =
        complaint([&] { bending_energy_50(h); }) + complaint([&] { bending_damping_50(h); });
    CHECK_THAT(said, Catch::Contains(why));
    CHECK(said.empty() == why.empty());
  }
  HingeInput restless = with_factors(first_hinge(), 3);  // no factor is taken at rest
  restless.rest[0] = restless.rest[2];
  CHECK(complaint([&] { force_of(restless); }).empty());
}

TEST_CASE("the formulas of springs name the input that they refuse") {
  using Edit = std::function<void(SpringInput&)>;
  for (const auto& [edit, why] : std::vector<std::pair<Edit, std::string>>{
           {[](SpringInput&) {}, ""},
           {[](SpringInput& s) { s.x[1].y() = NAN; }, "x must be finite"},
           {[](SpringInput& s) { s.v[0].z() = INFINITY; }, "v must be finite"},
           {[](SpringInput& s) { s.x[1] = s.x[0]; }, "x must be two different points"},
           {[](SpringInput& s) { s.law.rest_length = 0; }, "rest_length must be positive"},
           {[](SpringInput& s) { s.law.rest_length = NAN; }, "rest_length must be positive"},
           {[](SpringInput& s) { s.law.young = INFINITY; }, "law must be finite"},
           {[](SpringInput& s) { s.law.area = INFINITY; }, "law must be finite"}}) {
    SpringInput input = spring();
    edit(input);
    const std::string said = complaint([&] { spring_elastic_50(input); });
    CHECK_THAT(said, Catch::Contains(why));
    CHECK(said.empty() == why.empty());
    CHECK(said == complaint([&] { spring_damping_50(input); }));
    CHECK(said == complaint([&] { spring_energy_gradient_autodiff(input); }));
  }
}

TEST_CASE("derivatives of the whole force are those of differences, wherever factors are taken") {
  for (const HingeInput& start : hinges())
    for (const int variant : {0, 3, 5, 6}) {
      const HingeInput hinge = with_factors(start, variant);
      const MatrixEstimate one = bending_force_derivative_autodiff(hinge),
                           other = bending_force_derivative_differences(hinge);
      const double most = one.value.cwiseAbs().maxCoeff();
      CHECK((one.value - other.value).cwiseAbs().maxCoeff() <= 2 * one_rounding(most));
      CHECK(one.uncertainty == one_rounding(most));
      // against a difference of the forces as printed, in double
      const double step = 1e-6 * (hinge.x[3] - hinge.x[2]).norm();
      HingeInput ahead = hinge, behind = hinge;
      ahead.x[3].z() += step;
      behind.x[3].z() -= step;
      for (std::size_t i = 0; i < 4; ++i)
        CHECK(((force_of(ahead)[i] - force_of(behind)[i]) / (2 * step) -
               one.value.block<3, 1>(3 * Eigen::Index(i), 11))
                  .norm() < 1e-7 * most);
    }
}
