// Derivatives of the forces of sticking against differences.
#include <catch2/catch.hpp>

#include "verification/tests/reference/forces/sticking_specimen.h"

using namespace foldproof;
using namespace foldproof::stuck;

TEST_CASE("the elastic derivative of sticking is that of its springs") {
  const State s = state();
  for (const Sticking& all : {sticking(), out_of_reach()}) {
    Sticking springs = all;
    for (StickyPatch& patch : springs.patches) patch.forecast_time = 0;
    const Eigen::MatrixXd expected = differences(s.x, 1e-4, [&](const PerParticle3& x) {
      return forces_of(springs, {s.time, x, s.v, s.bonds});
    });
    ForceDifferential K;
    all.add_elastic_differential(s, Definiteness::exact, K);
    CHECK(K.symmetric);
    CHECK(agree(matrix_of(K), expected, 1e-9));
    ForceDifferential whole;
    springs.add_force_differential(s, whole);
    CHECK(whole.symmetric);
    CHECK(agree(matrix_of(whole), expected, 1e-9));
  }
}

TEST_CASE("the whole derivative of sticking is that of springs, dampers and what surfaces drag") {
  const State s = state();
  for (const Sticking& all : {sticking(), out_of_reach()}) {
    const Eigen::MatrixXd expected = differences(s.x, 1e-4, [&](const PerParticle3& x) {
      return forces_of(all, {s.time, x, s.v, s.bonds});
    });
    ForceDifferential K;
    all.add_force_differential(s, K);
    CHECK_FALSE(K.symmetric);
    CHECK(agree(matrix_of(K), expected, 1e-9));
    // adds to what is there
    const PerParticle3 start = scattered(n, 5.1), dx = scattered(n, 4.7);
    PerParticle3 df = start;
    K.add_product(dx, df);
    CHECK(agree(df, start + as_forces(expected * dx.reshaped()), 1e-9));
  }
}

TEST_CASE("the semidefinite derivative of sticking never pushes along its springs") {
  for (const double scale : {1.0, 0.01}) {  // of the distances to the targets
    State s = state();
    Sticking all = sticking();
    for (StickyPatch& patch : all.patches) patch.far *= scale;
    for (const Group& group : groups) {
      const Vector3 target = target_at(all, group, s.time, s.x);
      s.x.col(group.particle) = target + scale * (Vector3(s.x.col(group.particle)) - target);
    }
    Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(3 * n, 3 * n);
    int limited = 0;
    for (const Group& group : groups) {
      const StickyPatch& patch = all.patches[size_t(group.patch)];
      const Vector3 u = target_at(all, group, s.time, s.x) - s.x.col(group.particle);
      const double d = u.norm(), k = stiffness_of(patch, d), along = k + slope_of(patch, d) * d * d;
      limited += along < 0;
      const Eigen::Matrix3d projector = u * u.transpose() / (d * d);
      const Eigen::Matrix3d H =
          k * (Eigen::Matrix3d::Identity() - projector) + std::max(0.0, along) * projector;
      const Eigen::MatrixXd G = arm_gradient(all, group, s);
      expected -= G.transpose() * H * G;
    }
    CHECK(limited > 0);
    CHECK(limited < int(groups.size()));
    ForceDifferential K;
    all.add_elastic_differential(s, Definiteness::semidefinite, K);
    CHECK(agree(matrix_of(K), expected, 1e-8));
  }
  // at its target a spring has one stiffness in all directions
  State s = state();
  Sticking one{{patch({{0, 1, 2}}, 8, 0, 0.7)}};
  s.bonds = {{0, 0, 4, Vector3(0.25, 0.5, 0)}};
  s.x.col(4) = one.targets_at(s)[0].x;
  ForceDifferential K;
  one.add_elastic_differential(s, Definiteness::semidefinite, K);
  CHECK((matrix_of(K).block<3, 3>(12, 12) + 8 * Eigen::Matrix3d::Identity()).norm() < 1e-14);
}
