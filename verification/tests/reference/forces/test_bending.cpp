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
