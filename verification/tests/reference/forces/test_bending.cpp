// Bending where numbers are nearly lost, in flat and folded hinges; and refusals.
#include <catch2/catch.hpp>

#include "reference/mesh/shapes.h"
#include "verification/tests/reference/forces/force_differences.h"

using namespace foldproof;

namespace {

BendingMaterial material_of(double stiffness, double damping) {
  BendingMaterial material;
  material.stiffness = stiffness;
  material.damping = damping;
  return material;
}

}  // namespace

TEST_CASE("the half angle's sine is good to roundings however flat or folded the hinge is") {
  const Vector3 x1(-0.57, 0, 0.31), x3(0, 0, -0.13), x4(0, 0, 0.97);
  for (const double turn : {0.0, 1e-12, -1e-9, 3e-5, -1.5, 1.6, -3.1, pi - 1e-6, 1e-9 - pi}) {
    const Vector3 x2(0.83 * std::cos(turn), 0.83 * std::sin(turn), 0.29);
    CHECK(hinge_shape(x1, x2, x3, x4).sin_half == Approx(std::sin(turn / 2)).epsilon(1e-14));
    CHECK(hinge_angle(x1, x2, x3, x4) == Approx(turn).epsilon(1e-14));
  }
  CHECK(hinge_shape(x1, {0.83, 0, 0.29}, x3, x4).sin_half == 0);
  CHECK(hinge_shape(x1, {-0.83, 0, 0.29}, x3, x4).sin_half == 1);
  CHECK(hinge_angle(x1, {-0.83, 0, 0.29}, x3, x4) == pi);
  // nor does the potential lose a digit near a rest angle of 0
  CHECK(bending_law("sine").potential(1e-9, 0) == Approx(0.25e-18).epsilon(1e-14));
}

TEST_CASE("a hinge folded flat onto itself has a bound, though its sine may round above 1") {
  const Bending bending{material_of(0.37, 0), {{{0, 1, 2, 3}, 0.83, 0.4, std::sin(0.2)}}};
  for (int k = 0; k < 50; ++k) {
    State s;
    s.x = scattered(4, 0.17 * k);
    const Vector3 x3 = s.x.col(2), E = Vector3(s.x.col(3)) - x3;
    s.x.col(1) = Vector3(x3 + 0.3 * E + 0.7 * (Vector3(s.x.col(0)) - x3));
    PerParticle rows = PerParticle::Zero(4);
    add_stiffness_bound(bending, s, rows);
    CHECK(rows.minCoeff() > 0);
  }
}

TEST_CASE("bending refuses constants, angles and laws that mean nothing") {
  const TriangleMesh mesh = make_sheet({SheetPattern::one_diagonal, 1.3, 0.7, 2, 1});
  const auto refused = [&](const BendingMaterial& material, const std::vector<double>& angles,
                           const char* why) {
    CHECK_THROWS_WITH(make_bending(mesh, material, angles), Catch::Contains(why));
  };
  for (const double good : {0.0, 1e-300, 0.4})
    CHECK(make_bending(mesh, material_of(good, good), {pi, -pi, 0.1}).hinges.size() == 3);
  for (const double bad : {-1e-300, -2.0, std::nan("")}) {
    refused(material_of(bad, 0.3), {0.3, 0.1, 0.2}, "stiffness");
    refused(material_of(0.3, bad), {0.3, 0.1, 0.2}, "damping");
  }
  for (const double bad : {std::nextafter(pi, 4), std::nextafter(-pi, -4), std::nan("")})
    refused(material_of(0.3, 0.3), {0.3, 0.1, bad}, "[-pi, pi]");
  refused(material_of(0.3, 0.3), {0.3, 0.1}, "2 rest angles given for 3");
  refused(material_of(0.3, 0.3), {0.3, 0.1, 0.2, 0.4}, "4 rest angles given for 3");
  BendingMaterial unknown;
  unknown.law = "linear";
  refused(unknown, {0.3, 0.1, 0.2}, "'linear'");
}
