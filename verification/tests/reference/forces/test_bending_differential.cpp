// The derivatives of the bending mode, of the factors and of the forces, against differences.
#include <catch2/catch.hpp>
#include <cmath>

#include "verification/tests/hinge_specimens.h"
#include "verification/tests/reference/forces/bending_specimen.h"
#include "verification/tests/reference/forces/at_state.h"

using namespace foldproof;

namespace {

PerParticle3 as_columns(const std::array<Vector3, 4>& corners) {
  PerParticle3 x(3, 4);
  x << corners[0], corners[1], corners[2], corners[3];
  return x;
}

std::array<Vector3, 4> as_corners(const PerParticle3& x) {
  return {x.col(0), x.col(1), x.col(2), x.col(3)};
}

/// Two hinges, on either side of a right angle, and a mirror image.
std::vector<PerParticle3> specimens() {
  std::vector<PerParticle3> all;
  for (const auto& hinge : oracles::hinges()) all.push_back(as_columns(hinge.x));
  all.push_back(all[0]);
  all.back().row(1) *= -1;
  return all;
}

double step_of(const PerParticle3& x) { return 1e-3 * (x.col(3) - x.col(2)).norm(); }

}  // namespace

TEST_CASE("the gradient of the bending mode is that of the 50-digit mode, and symmetric") {
  for (const PerParticle3& x : specimens()) {
    const Eigen::MatrixXd expected = differences(x, step_of(x), [](const PerParticle3& moved) {
      return as_columns(oracles::bending_mode_50(as_corners(moved)).value);
    });
    const Matrix12 gradient = bending_mode_gradient(x.col(0), x.col(1), x.col(2), x.col(3));
    CHECK(agree(gradient, expected, 1e-8));
    CHECK(agree(gradient, gradient.transpose(), 1e-13));
  }
}

TEST_CASE("the gradients of a hinge's factors are those of |E| and |E|^2/(|N1| + |N2|)") {
  for (const PerParticle3& x : specimens()) {
    const auto gradient_of = [&](const auto& factor) {
      return Vector12(differences(x, step_of(x), [&](const PerParticle3& moved) {
                        return Eigen::MatrixXd::Constant(1, 1, factor(as_corners(moved)));
                      }).transpose());
    };
    const Vector12 edge = gradient_of([](const auto&at) { return numbers_of(at).edge; }),
                   weight = gradient_of([](const auto&at) { return numbers_of(at).weight(); });
    CHECK(agree(edge_gradient(x.col(2), x.col(3)), edge, 1e-9));
    CHECK(agree(weight_gradient(x.col(0), x.col(1), x.col(2), x.col(3)), weight, 1e-9));
  }
}

TEST_CASE("the elastic derivative of bending is that of its forces with the factor as it is") {
  const State s = hinge_state();
  for (const BendingMaterial& material : bending_materials()) {
    const Bending bending = five_hinges(material);
    // with current weighting the change of the factor is omitted
    Bending frozen = bending;
    frozen.material.weighting = Weighting::rest;
    if (material.weighting == Weighting::current)
      for (BendingHinge& hinge : frozen.hinges)
        hinge.rest_weight = numbers_of(corners_of(hinge, s.x)).weight();
    const Eigen::MatrixXd expected = differences(s.x, 1e-4, [&](const PerParticle3& x) {
      PerParticle3 f = PerParticle3::Zero(3, hinge_particles);
      add_elastic(frozen, {0, x, {}}, f);
      return f;
    });
    ForceDifferential K;
    K.hinges = {{{3, 1, 0, 6}, Matrix12::Zero()}};
    bending.add_elastic_differential({0, s.x, {}}, Definiteness::exact, K);
    REQUIRE(K.hinges.size() == 6);
    CHECK(K.symmetric);
    for (size_t h = 0; h < 5; ++h) CHECK(K.hinges[h + 1].particles == bending.hinges[h].particles);
    const Eigen::MatrixXd matrix =
        matrix_of(hinge_particles, [&](const auto& dx, auto& df) { K.add_product(dx, df); });
    CHECK(agree(matrix, expected, 1e-8));
    CHECK(agree(matrix, matrix.transpose(), 1e-12));
  }
}

TEST_CASE("the semidefinite derivative of a hinge has its block without positive eigenvalues") {
  const State s = hinge_state();
  for (const BendingMaterial& material : bending_materials()) {
    ForceDifferential exact, semidefinite;
    five_hinges(material).add_elastic_differential(s, Definiteness::exact, exact);
    five_hinges(material).add_elastic_differential(s, Definiteness::semidefinite, semidefinite);
    int changed = 0;
    for (size_t h = 0; h < 5; ++h) {
      const Matrix12& kept = semidefinite.hinges[h].block;
      CHECK(semidefinite.hinges[h].particles == exact.hinges[h].particles);
      CHECK(kept == negative_part(exact.hinges[h].block));
      changed += !agree(kept, exact.hinges[h].block, 1e-3);
    }
    CHECK(changed > 0);
  }
}

TEST_CASE("the whole derivative of bending is that of elastic and damping forces together") {
  const State s = hinge_state();
  for (const BendingMaterial& material : bending_materials())
    for (const DampingFactor factor : {DampingFactor::edge, DampingFactor::edge_squared_over_area})
      for (const double kd : {0.0, 0.19}) {
        Bending bending = five_hinges(material);
        bending.material.damping_factor = factor;
        bending.material.damping = kd;
        const Eigen::MatrixXd expected = differences(s.x, 1e-4, [&](const PerParticle3& x) {
          PerParticle3 f = bending_damping_forces(bending, {0, x, s.v});
          add_elastic(bending, {0, x, s.v}, f);
          return f;
        });
        ForceDifferential K;
        bending.add_force_differential(s, K);
        REQUIRE(K.hinges.size() == 5);
        CHECK(K.hinges[2].particles == bending.hinges[2].particles);
        CHECK(K.symmetric == (kd == 0 && material.weighting == Weighting::rest));
        const Eigen::MatrixXd matrix =
            matrix_of(hinge_particles, [&](const auto& dx, auto& df) { K.add_product(dx, df); });
        CHECK(agree(matrix, expected, 1e-8));
      }
}

TEST_CASE("bending without stiffness and damping has a symmetric derivative of zero") {
  BendingMaterial nothing;
  nothing.weighting = Weighting::current;
  ForceDifferential K;
  five_hinges(nothing).add_force_differential(hinge_state(), K);
  CHECK(K.symmetric);
  REQUIRE(K.hinges.size() == 5);
  for (const HingeStiffness& hinge : K.hinges) CHECK(hinge.block.norm() == 0);
}
