// The table of forces: what is added up, what is counted, and the bounds that follow from it.
#include <Eigen/QR>
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/forces/symmetric_modes.h"
#include "verification/tests/reference/forces/force_differences.h"

using namespace foldproof;

namespace {

constexpr int n = 5;

/// Particle 4 sticks to the cloth's triangle of 0, 1, 2, and is off its place there.
State stuck_state() {
  State s{0.37, scattered(n, 0.4), scattered(n, 2.9)};
  s.bonds = {{0, 0, 4, Vector3(0.21, 0.34, 0.13)}};
  return s;
}

PerParticle masses() { return (PerParticle(n) << 0.3, 0.7, 0.4, 0.9, 0.6).finished(); }

std::vector<Force> all_forces() {
  BendingMaterial material;
  material.stiffness = 0.29;
  material.damping = 0.071;
  StickyPatch patch;
  patch.triangles = {{0, 1, 2}};
  patch.particles = {4};
  patch.stiffness = 19;
  patch.forecast_time = 0.023;
  patch.near = 0.9;
  patch.far = 5.1;
  CustomForce custom;
  custom.elastic = [](const State& s, PerParticle3& f) { f -= 2.3 * s.time * s.x; };
  custom.damping = [](const State& s, const PerParticle3& v, PerParticle3& f) {
    f -= 0.7 * s.time * v;
  };
  custom.differential = [](const State& s, const PerParticle3& dx, PerParticle3& df) {
    df -= 2.3 * s.time * dx;
  };
  return {Gravity{{0.3, -9.1, 1.7}, masses()},
          StretchSprings{{{3, 1, 0.7, 13.0, 0.31}, {0, 4, 1.9, 4.1, 0.17}, {1, 4, 1.1, 7.7, 0.53}}},
          Bending{material, {{{2, 0, 4, 1}, 0.83, 0.63, std::sin(0.315)}}}, Sticking{{patch}},
          custom};
}

PerParticle one_hot(int i, double value) {
  PerParticle list = PerParticle::Zero(n);
  list[i] = value;
  return list;
}

/// The matrix of a product that add_product(v, f) adds to f.
template <class Operator>
Eigen::MatrixXd matrix_of(const Operator& of) {
  Eigen::MatrixXd matrix(3 * n, 3 * n);
  for (Eigen::Index k = 0; k < 3 * n; ++k) {
    PerParticle3 unit = PerParticle3::Zero(3, n), product = unit;
    unit.data()[k] = 1;
    of.add_product(unit, product);
    matrix.col(k) = product.reshaped();
  }
  return matrix;
}

}  // namespace

TEST_CASE("forces, damping and derivatives are the sums over the table, and are counted") {
  const State s = stuck_state();
  Work work;
  const auto all_of = [&](const std::vector<Force>& forces) {
    return std::array<Eigen::MatrixXd, 5>{
        elastic_forces(forces, s, work), matrix_of(*damping_at(forces, s, work)),
        matrix_of(force_differential_at(forces, s, work)),
        matrix_of(elastic_differential_at(forces, s, Definiteness::exact, work)),
        matrix_of(elastic_differential_at(forces, s, Definiteness::semidefinite, work))};
  };
  const std::vector<Force> forces = all_forces();
  std::array<Eigen::MatrixXd, 5> sums = all_of({CustomForce{}});
  for (const Eigen::MatrixXd& sum : sums) CHECK(sum.norm() == 0);
  for (const Force& force : forces) {
    const auto one = all_of({force});
    for (size_t k = 0; k < 5; ++k) {
      sums[k] += one[k];
      CHECK((one[k].norm() > 0.01) == (k == 0 || !std::holds_alternative<Gravity>(force)));
    }
  }
  const auto all = all_of(forces), custom = all_of({forces[4]});
  for (size_t k = 0; k < 5; ++k) CHECK(agree(all[k], sums[k], 1e-14));
  CHECK(work.elastic_evaluations == 8);
  CHECK(work.damping_preparations == 8);
  CHECK(work.stiffness_preparations == 24);
  // the largest eigenvalue is 0, where the exact one's is positive
  CHECK(symmetric_modes(all[4]).values[3 * n - 1] < 1e-13);
  CHECK(symmetric_modes(all[3]).values[3 * n - 1] > 0.1);
  // custom forces contribute their elastic part only, as it is
  const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(3 * n, 3 * n);
  CHECK(agree(custom[1], -0.7 * s.time * unit, 1e-15));
  for (size_t k = 2; k < 5; ++k) CHECK(agree(custom[k], -2.3 * s.time * unit, 1e-15));
}

TEST_CASE("the negative part of a matrix keeps its modes of negative eigenvalue, as they are") {
  const Eigen::MatrixXd basis =
      Eigen::MatrixXd(scattered(48, 1.1).reshaped(12, 12)).householderQr().householderQ();
  const auto matrix_with = [&](const Vector12& values) {
    return Matrix12(basis * values.asDiagonal() * basis.transpose());
  };
  Vector12 mixed;
  mixed << -3.1, 2.2, -0.4, 0.3, 0.7, -1.6, 5.1, -0.05, 0.02, 1.3, -2.7, 0.9;
  CHECK(agree(negative_part(matrix_with(mixed)), matrix_with(mixed.cwiseMin(0.0)), 1e-14));
  const Vector12 negative = -mixed.cwiseAbs();
  CHECK(agree(negative_part(matrix_with(negative)), matrix_with(negative), 1e-14));
  CHECK(negative_part(matrix_with(mixed.cwiseAbs())).norm() == 0);
}

TEST_CASE("the bound of damping rates is the largest row sum over its mass") {
  DampingOperator damping;
  damping.pairs = {{3, 1, Vector3(0, 3, 4)}, {1, 4, Vector3(2, 0, 0)}};
  // w1 and w2 of length 5 and 12, and with weights of 1 and 0 w3 = -w1, w4 = -w2
  damping.hinges = {{{2, 0, 4, 1}, 1, 0, Vector3(0, 3, 4), Vector3(12, 0, 0)}};
  const double sum = 5 + 12 + 5 + 12;
  const std::vector<double> rows{12 * sum, 50 + 8 + 12 * sum, 5 * sum, 50, 8 + 5 * sum};
  for (int i = 0; i < n; ++i)
    CHECK(damping_rate_bound(damping, one_hot(i, 7.1)) == Approx(7.1 * rows[size_t(i)]));

  // a particle at rest holds another with a rate of its own coefficient
  DampingOperator targets;
  targets.targets = {{2, 0.41, {}}, {0, 0.29, {}}};
  CHECK(damping_rate_bound(targets, masses().cwiseInverse()) == Approx(0.41 / 0.4));
  CHECK(damping_rate_bound(targets, one_hot(0, 0.7)) == Approx(0.29 * 0.7));
  CHECK(damping_rate_bound({}, masses()) == 0);
  targets.targets[1].coefficient = std::nan("");
  CHECK(std::isnan(damping_rate_bound(targets, masses())));
}

TEST_CASE("the bound of frequencies is the root of the largest row sum over its mass") {
  const State s = stuck_state();
  const std::vector<Force> forces = all_forces();
  PerParticle all = PerParticle::Zero(n), without = all;
  add_stiffness_bound(std::get<StretchSprings>(forces[1]), s, all);
  add_stiffness_bound(std::get<Bending>(forces[2]), s, all);
  without = all;
  std::get<Sticking>(forces[3]).add_stiffness_bound(s, all);
  std::get<Sticking>(forces[3]).add_bound_without_springs(s, without);
  CHECK(all[4] > 1.1 * without[4]);
  for (int i = 0; i < n; ++i) {
    CHECK(frequency_bound(forces, s, one_hot(i, 3.9)) == Approx(std::sqrt(3.9 * all[i])));
    CHECK(frequency_without_sticking_springs(forces, s, one_hot(i, 3.9)) ==
          Approx(std::sqrt(3.9 * without[i])));
  }
  CHECK(frequency_bound({forces[0]}, s, masses()) == 0);
}
