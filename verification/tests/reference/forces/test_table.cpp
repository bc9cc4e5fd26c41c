// The table of forces: what is added up, what is counted, and the bounds that follow from it.
#include <Eigen/QR>
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/forces/degenerate.h"
#include "reference/forces/force.h"
#include "reference/forces/symmetric_modes.h"
#include "verification/tests/reference/forces/force_differences.h"
#include "verification/tests/reference/forces/at_state.h"

using namespace foldproof;

namespace {

constexpr int n = 5;

State state() { return {0.37, scattered(n, 0.4), scattered(n, 2.9)}; }

StretchSprings springs() {
  return {{{3, 1, 0.7, 13.0, 0.31}, {0, 4, 1.9, 4.1, 0.17}, {1, 4, 1.1, 7.7, 0.53}}};
}

Bending bending() {
  BendingMaterial material;
  material.stiffness = 0.29;
  material.damping = 0.071;
  return {material, {{{2, 0, 4, 1}, 0.83, 0.63, std::sin(0.315)}}};
}

/// Particle 4 sticks to the cloth's triangle of 0, 1, 2, and is off its place there.
Sticking sticking() {
  StickyPatch patch;
  patch.triangles = {{0, 1, 2}};
  patch.particles = {4};
  patch.stiffness = 19;
  patch.forecast_time = 0.023;
  patch.near = 0.9;
  patch.far = 5.1;
  return {{patch}};
}

State stuck_state() {
  State s = state();
  s.bonds = {{0, 0, 4, Vector3(0.21, 0.34, 0.13)}};
  return s;
}

CustomForce custom() {
  CustomForce force;
  force.elastic = [](const State& s, PerParticle3& f) { f -= 2.3 * s.time * s.x; };
  force.damping = [](const State& s, const PerParticle3& v, PerParticle3& f) {
    f -= 0.7 * s.time * v;
  };
  force.differential = [](const State& s, const PerParticle3& dx, PerParticle3& df) {
    df -= 2.3 * s.time * dx;
  };
  force.potential = [](const State& s) { return 1.15 * s.time * s.x.squaredNorm(); };
  return force;
}

PerParticle masses() { return (PerParticle(n) << 0.3, 0.7, 0.4, 0.9, 0.6).finished(); }

std::vector<Force> all_forces() {
  return {Gravity{{0.3, -9.1, 1.7}, masses()}, springs(), bending(), sticking(), custom()};
}

/// The numbers of a Work that are not 0, by their place in the list.
std::vector<long> counted(const Work& work) {
  std::vector<long> list;
  for (const auto count : summed_counters) list.push_back(work.*count);
  return list;
}

PerParticle one_hot(int i, double value) {
  PerParticle list = PerParticle::Zero(n);
  list[i] = value;
  return list;
}

}  // namespace

TEST_CASE("energies begin at zero, and their total has each of the six terms once") {
  Energies energies;
  CHECK(energies.total() == 0);
  double value = 0.375, sum = 0;
  for (const auto term : energy_terms) {
    CHECK(energies.*term == 0);
    energies.*term = value;
    sum += value;
    value *= 2;
  }
  CHECK(energies.total() == sum);
  CHECK(sum == 0.375 * 63);
  CHECK(energies.kinetic == 0.375);
  CHECK(energies.sticking == 12);
}

TEST_CASE("each force has its own term of the energy") {
  CHECK(Gravity::energy_term == &Energies::gravity);
  CHECK(StretchSprings::energy_term == &Energies::stretch);
  CHECK(Bending::energy_term == &Energies::bending);
  CHECK(Sticking::energy_term == &Energies::sticking);
  CHECK(CustomForce::energy_term == &Energies::custom);
}

TEST_CASE("an element that degenerates is reported with its particles") {
  const DegenerateElement error("a spring has no length", {41, 7, 7});
  CHECK(std::string(error.what()) == "a spring has no length (particles 41 7 7)");
  CHECK(error.particles == std::vector<int>{41, 7, 7});
}

TEST_CASE("gravity adds a particle's weight to its force, on any number of threads") {
  const Vector3 g(0.3, -9.1, 1.7);
  Gravity gravity{g, masses()};
  const State s = state();
  const PerParticle3 start = scattered(n, 5.1);
  double energy = 0;
  for (const int threads : {1, 2, 3}) {
    gravity.set_team(threads, n);
    CHECK(gravity.team.threads() == threads);
    PerParticle3 f = start;
    add_elastic(gravity, s, f);
    for (int i = 0; i < n; ++i) CHECK((f.col(i) - start.col(i) - masses()[i] * g).norm() < 1e-14);
  }
  for (int i = 0; i < n; ++i) energy -= masses()[i] * g.dot(s.x.col(i));
  CHECK(energy_of(gravity, s) == Approx(energy).epsilon(1e-14));
}

TEST_CASE("a custom force without functions adds nothing") {
  const CustomForce nothing;
  const State s = state();
  PerParticle3 f = scattered(n, 5.1);
  add_elastic(nothing, s, f);
  CHECK(f == scattered(n, 5.1));
  CHECK(energy_of(nothing, s) == 0);
  DampingOperator damping;
  prepare_damping(nothing, s, damping);
  CHECK(damping.custom.empty());
  ForceDifferential differential;
  nothing.add_elastic_differential(s, Definiteness::exact, differential);
  nothing.add_force_differential(s, differential);
  CHECK(differential.custom.empty());
  CHECK(differential.symmetric);
}

TEST_CASE("a custom force is asked at the state for which it was prepared") {
  const CustomForce force = custom();
  const State s = state();
  const PerParticle3 start = scattered(n, 5.1), moved = scattered(n, 6.2);
  PerParticle3 f = start;
  add_elastic(force, s, f);
  CHECK(agree(f, start - 2.3 * 0.37 * s.x, 1e-15));
  CHECK(energy_of(force, s) == Approx(1.15 * 0.37 * s.x.squaredNorm()));

  DampingOperator damping;
  prepare_damping(force, s, damping);
  f = start;
  damping.add_product(moved, f);
  CHECK(agree(f, start - 0.7 * 0.37 * moved, 1e-15));

  ForceDifferential elastic, whole;
  force.add_elastic_differential(s, Definiteness::semidefinite, elastic);
  force.add_force_differential(s, whole);
  for (const ForceDifferential* differential : {&elastic, &whole}) {
    CHECK(differential->symmetric);
    f = start;
    differential->add_product(moved, f);
    CHECK(agree(f, start - 2.3 * 0.37 * moved, 1e-15));
  }
}

TEST_CASE("elastic forces are the sum over the table, begin at zero, and count as one evaluation") {
  State s = stuck_state();
  PerParticle3 sum = PerParticle3::Zero(3, n);
  for (const Force& force : all_forces()) {
    Work one;
    const PerParticle3 f = elastic_forces({force}, s, one);
    CHECK(f.norm() > 0.1);
    sum += f;
  }
  s.v = {};  // of no use to them
  Work work;
  work.elastic_evaluations = 6;
  CHECK(agree(elastic_forces(all_forces(), s, work), sum, 1e-15));
  CHECK(work.elastic_evaluations == 7);
  work.elastic_evaluations = 0;
  CHECK(counted(work) == counted(Work{}));
  CHECK(elastic_forces({}, s, work) == PerParticle3::Zero(3, n));
}

TEST_CASE("damping is that of all forces that damp, and counts as one preparation") {
  const State s = stuck_state();
  const auto matrix = [&](const std::vector<Force>& forces) {
    Work work;
    work.damping_preparations = 3;
    const DampingOperator damping = *damping_at(forces, s, work);
    CHECK(work.damping_preparations == 4);
    work.damping_preparations = 0;
    CHECK(counted(work) == counted(Work{}));
    return matrix_of(n, [&](const auto& v, auto& f) { damping.add_product(v, f); });
  };
  Eigen::MatrixXd sum = matrix({Gravity{{0, 0, -9.8}, masses()}});
  CHECK(sum.norm() == 0);
  for (const Force& force :
       {Force(springs()), Force(bending()), Force(sticking()), Force(custom())}) {
    const Eigen::MatrixXd one = matrix({force});
    CHECK(one.norm() > 0.01);
    sum += one;
  }
  CHECK(agree(matrix(all_forces()), sum, 1e-14));
}

TEST_CASE("derivatives are those of all forces that have one, and count as one preparation") {
  const State s = stuck_state();
  const auto elastic = [&](const std::vector<Force>& forces, Definiteness definiteness) {
    Work work;
    work.stiffness_preparations = 8;
    const ForceDifferential K = elastic_differential_at(forces, s, definiteness, work);
    CHECK(K.symmetric);
    CHECK(work.stiffness_preparations == 9);
    work.stiffness_preparations = 0;
    CHECK(counted(work) == counted(Work{}));
    return matrix_of(n, [&](const auto& v, auto& f) { K.add_product(v, f); });
  };
  const auto whole = [&](const std::vector<Force>& forces) {
    Work work;
    work.stiffness_preparations = 8;
    const ForceDifferential K = force_differential_at(forces, s, work);
    CHECK(work.stiffness_preparations == 9);
    work.stiffness_preparations = 0;
    CHECK(counted(work) == counted(Work{}));
    return matrix_of(n, [&](const auto& v, auto& f) { K.add_product(v, f); });
  };
  const auto of_elastic = [&](const std::vector<Force>& forces) {
    return differences(s.x, 2e-4, [&](const PerParticle3& x) {
      State moved = s;
      moved.x = x;
      Work work;
      return elastic_forces(forces, moved, work);
    });
  };
  const auto of_both = [&](const std::vector<Force>& forces) {
    return differences(s.x, 2e-4, [&](const PerParticle3& x) {
      State moved = s;
      moved.x = x;
      Work work;
      PerParticle3 f = elastic_forces(forces, moved, work);
      // custom forces contribute their elastic part only
      DampingOperator damping = *damping_at(forces, moved, work);
      damping.custom.clear();
      damping.add_product(s.v, f);
      return f;
    });
  };
  std::vector<std::vector<Force>> lists{all_forces()};
  for (const Force& force : all_forces()) lists.push_back({force});
  for (const std::vector<Force>& forces : lists) {
    CHECK((elastic(forces, Definiteness::exact) - of_elastic(forces)).norm() < 1e-8);
    CHECK((whole(forces) - of_both(forces)).norm() < 1e-8);
    // the largest eigenvalue is 0, where the exact one's may be positive
    const Eigen::MatrixXd K = elastic(forces, Definiteness::semidefinite);
    CHECK(symmetric_modes(K).values[3 * n - 1] < 1e-13);
  }
  CHECK(symmetric_modes(elastic(all_forces(), Definiteness::exact)).values[3 * n - 1] > 0.1);
}

TEST_CASE("the product of a derivative adds each pair, each hinge and each function once") {
  ForceDifferential K;
  CHECK(K.symmetric);
  const auto random = [](int rows, double seed) {
    return Eigen::MatrixXd(scattered(rows * rows / 3, seed).reshaped(rows, rows));
  };
  K.pairs = {{3, 1, random(3, 0.3)}, {1, 4, random(3, 1.4)}};
  K.hinges = {{{2, 0, 4, 1}, random(12, 2.6)}, {{4, 3, 1, 0}, random(12, 3.7)}};
  K.custom = {[](const PerParticle3& dx, PerParticle3& df) { df -= 0.3 * dx; },
              [](const PerParticle3& dx, PerParticle3& df) { df.col(2) += 1.7 * dx.col(3); }};

  Eigen::MatrixXd dense = -0.3 * Eigen::MatrixXd::Identity(3 * n, 3 * n);
  dense.block<3, 3>(6, 9) += 1.7 * Eigen::Matrix3d::Identity();
  for (const PairStiffness& pair : K.pairs) {
    dense.block<3, 3>(3 * pair.a, 3 * pair.a) += pair.block;
    dense.block<3, 3>(3 * pair.b, 3 * pair.b) += pair.block;
    dense.block<3, 3>(3 * pair.a, 3 * pair.b) -= pair.block;
    dense.block<3, 3>(3 * pair.b, 3 * pair.a) -= pair.block;
  }
  for (const HingeStiffness& hinge : K.hinges)
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        dense.block<3, 3>(3 * hinge.particles[size_t(i)], 3 * hinge.particles[size_t(j)]) +=
            hinge.block.block<3, 3>(3 * i, 3 * j);

  const PerParticle3 dx = scattered(n, 4.4), start = scattered(n, 5.1);
  PerParticle3 df = start;
  K.add_product(dx, df);
  const Eigen::VectorXd expected = start.reshaped() + dense * dx.reshaped();
  CHECK(agree(Eigen::VectorXd(df.reshaped()), expected, 1e-14));
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
  const Vector3 along(0.3, -0.2, 0.5), other(0.1, 0.6, -0.4), third(-0.5, 0.2, 0.7);
  damping.pairs = {{3, 1, along}, {1, 4, other}, {3, 4, third}};
  const Vector3 w1(0.12, -0.31, 0.07), w2(-0.22, 0.05, 0.41);
  damping.hinges = {{{2, 0, 4, 1}, 0.37, -0.24, w1, w2}};
  const Vector3 w3 = -0.37 * w1 + 0.24 * w2, w4 = -0.63 * w1 - 1.24 * w2;
  const double sum = w1.norm() + w2.norm() + w3.norm() + w4.norm();
  PerParticle rows(n);
  const double of_along = 2 * along.squaredNorm(), of_other = 2 * other.squaredNorm(),
               of_third = 2 * third.squaredNorm();
  rows << w2.norm() * sum, of_along + of_other + w4.norm() * sum, w1.norm() * sum,
      of_along + of_third, of_other + of_third + w3.norm() * sum;
  for (int i = 0; i < n; ++i)
    for (const double inverse : {0.013, 7.1})
      CHECK(damping_rate_bound(damping, one_hot(i, inverse)) ==
            Approx(inverse * rows[i]).epsilon(1e-13));

  // a particle at rest holds another with a rate of its own coefficient
  DampingOperator targets;
  targets.targets = {{2, 0.41, {}}, {0, 0.29, {}}};
  CHECK(damping_rate_bound(targets, masses().cwiseInverse()) ==
        Approx(std::max(0.41 / 0.4, 0.29 / 0.3)));
  CHECK(damping_rate_bound(targets, one_hot(0, 0.7)) == Approx(0.29 * 0.7));
  CHECK(damping_rate_bound({}, masses()) == 0);
  targets.targets[1].coefficient = std::nan("");
  CHECK(std::isnan(damping_rate_bound(targets, masses())));
}

TEST_CASE("the bound of frequencies is the root of the largest row sum over its mass") {
  State s = stuck_state();
  s.v = {};
  const std::vector<Force> forces = all_forces();
  PerParticle all = PerParticle::Zero(n), without = PerParticle::Zero(n);
  add_stiffness_bound(springs(), s, all);
  add_stiffness_bound(bending(), s, all);
  without = all;
  add_stiffness_bound(sticking(), s, all);
  sticking().add_bound_without_springs(s, without);
  CHECK(all.minCoeff() > 0);
  CHECK((all - without).minCoeff() >= 0);
  CHECK(all[4] > 1.1 * without[4]);
  CHECK(agree(stiffness_row_bounds(forces, s, StickingPart::all), all, 1e-15));
  CHECK(agree(stiffness_row_bounds(forces, s, StickingPart::without_springs), without, 1e-15));
  for (int i = 0; i < n; ++i)
    for (const double inverse : {0.0003, 3.9}) {
      CHECK(frequency_bound(forces, s, one_hot(i, inverse)) == Approx(std::sqrt(inverse * all[i])));
      CHECK(frequency_without_sticking_springs(forces, s, one_hot(i, inverse)) ==
            Approx(std::sqrt(inverse * without[i])));
    }
  CHECK(frequency_bound(forces, s, masses()) ==
        Approx(std::sqrt(all.cwiseProduct(masses()).maxCoeff())));
  CHECK(frequency_bound({Gravity{{0, 0, -9.8}, masses()}}, s, masses()) == 0);
}
