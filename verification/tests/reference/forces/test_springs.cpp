// Springs and their dampers against the formulas at the head of reference/forces/springs.h.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/forces/degenerate.h"
#include "reference/forces/springs.h"
#include "reference/mesh/shapes.h"
#include "verification/tests/reference/forces/force_differences.h"
#include "verification/tests/reference/forces/at_state.h"

using namespace foldproof;

namespace {

constexpr int n = 6;

State state() { return {0.37, scattered(n, 0.4), scattered(n, 2.9)}; }

/// Pulled, at rest and compressed ones, to less than half too; the second does not damp, the
/// fourth damps with 1.
StretchSprings springs() {
  return {{{3, 1, 0.3, 13.0, 0.31},
           {0, 4, 1.2, 4.1, 0},
           {1, 4, 2.9, 7.7, 0.53},
           {5, 0, 0.6, 2.3, 1},
           {2, 5, 3.7, 5.9, 0.26}}};
}

struct Arm {
  Vector3 d, dv;
  double length;
};

Arm arm_of(const Spring& spring, const State& s) {
  const Vector3 d = s.x.col(spring.b) - s.x.col(spring.a);
  return {d, s.v.col(spring.b) - s.v.col(spring.a), d.norm()};
}

PerParticle3 damping_forces(const StretchSprings& springs, const State& s) {
  DampingOperator damping;
  prepare_damping(springs, s, damping);
  PerParticle3 f = PerParticle3::Zero(3, s.x.cols());
  damping.add_product(s.v, f);
  return f;
}

PerParticle3 coincident(int a, int b) {
  PerParticle3 x = state().x;
  x.col(b) = x.col(a);
  return x;
}

}  // namespace

TEST_CASE("springs add stiffness times extension along themselves, and its energy") {
  const State s = state();
  const PerParticle3 start = scattered(n, 5.1);
  PerParticle3 expected = start, f = start;
  double energy = 0;
  bool has_pulled = false, has_compressed = false;
  for (const Spring& spring : springs().springs) {
    const Arm arm = arm_of(spring, s);
    const double extension = arm.length - spring.rest_length;
    expected.col(spring.a) += spring.stiffness * extension * arm.d.normalized();
    expected.col(spring.b) -= spring.stiffness * extension * arm.d.normalized();
    energy += spring.stiffness * std::pow(extension, 2) / 2;
    has_pulled |= extension > 0;
    has_compressed |= arm.length < spring.rest_length / 2;
  }
  CHECK(has_pulled);
  CHECK(has_compressed);
  add_elastic(springs(), s, f);
  CHECK(agree(f, expected, 1e-14));
  CHECK(energy_of(springs(), s) == Approx(energy).epsilon(1e-14));
}

TEST_CASE("springs damp their lengthening; where none damps there are no dampers") {
  const State s = state();
  DampingOperator damping;
  prepare_damping(springs(), s, damping);
  REQUIRE(damping.pairs.size() == 5);
  StretchSprings undamped = springs();
  for (Spring& spring : undamped.springs) spring.damping = 0;
  DampingOperator none;
  prepare_damping(undamped, s, none);
  CHECK(none.empty());
  PerParticle3 expected = PerParticle3::Zero(3, n);
  size_t at = 0;
  for (const Spring& spring : springs().springs) {
    const Arm arm = arm_of(spring, s);
    const Vector3 direction = arm.d / arm.length;
    const PairDamper& damper = damping.pairs[at++];
    CHECK(damper.a == spring.a);
    CHECK(damper.b == spring.b);
    CHECK((damper.along - std::sqrt(spring.damping) * direction).norm() < 1e-15);
    const Vector3 force = spring.damping * arm.dv.dot(direction) * direction;
    expected.col(spring.a) += force;
    expected.col(spring.b) -= force;
  }
  CHECK(agree(damping_forces(springs(), s), expected, 1e-14));
  // further springs join those that are there
  prepare_damping(springs(), s, damping);
  CHECK(damping.pairs.size() == 10);
  const PerParticle3 start = scattered(n, 5.1);
  PerParticle3 f = start;
  damping.add_product(s.v, f);
  CHECK(agree(f, start + 2 * expected, 1e-14));
}

TEST_CASE("springs do the same on any number of threads, to the bit") {
  // so many that forces on a particle come from the same and from another thread in turn
  constexpr int particles = 12;
  const State s{0, scattered(particles, 0.4), scattered(particles, 2.9)};
  StretchSprings all_damp;
  for (int k = 0; k < 60; ++k) {
    const int a = (5 * k + 1) % particles, b = (a + 1 + k % 11) % particles;
    all_damp.springs.push_back({a, b, 0.3 + 0.01 * k, 3 + 0.7 * k, 0.1 + 0.03 * k});
  }
  StretchSprings one_does_not = all_damp;
  one_does_not.springs[7].damping = 0;
  const PerParticle3 start = scattered(particles, 5.1);
  const auto results = [&](StretchSprings springs, int threads) {
    springs.set_team(threads, particles);
    PerParticle3 f = start, damped = start;
    PerParticle rows = start.row(0).transpose();
    add_elastic(springs, s, f);
    add_stiffness_bound(springs, s, rows);
    DampingOperator damping;
    prepare_damping(springs, s, damping);
    damping.add_product(s.v, damped);
    return std::tuple(f, damped, rows, energy_of(springs, s));
  };
  for (const int threads : {2, 3, 6})
    for (const StretchSprings& list : {one_does_not, all_damp})
      CHECK(results(list, threads) == results(list, 1));
}

TEST_CASE("a spring without length is refused with both of its ends, wherever it is asked") {
  const StretchSprings list = springs();
  State s = state();
  s.x = coincident(1, 4);
  PerParticle3 f = s.x;
  PerParticle rows = PerParticle::Zero(n);
  DampingOperator damping;
  ForceDifferential differential;
  const auto refusal = Catch::Message("a spring has no length (particles 1 4)");
  CHECK_THROWS_MATCHES(add_elastic(list, s, f), DegenerateElement, refusal);
  CHECK_THROWS_MATCHES(prepare_damping(list, s, damping), DegenerateElement, refusal);
  CHECK_THROWS_MATCHES(list.add_elastic_differential(s, Definiteness::exact, differential),
                       DegenerateElement, refusal);
  CHECK_THROWS_MATCHES(list.add_force_differential(s, differential), DegenerateElement, refusal);
  CHECK_THROWS_MATCHES(add_stiffness_bound(list, s, rows), DegenerateElement, refusal);
  s.x(2, 4) = std::nan("");
  CHECK_THROWS_WITH(add_elastic(list, s, f), "a spring has no length (particles 0 4)");
}

TEST_CASE("the derivative of springs is that of their forces, added to what is there") {
  const State s = state();
  ForceDifferential K;
  K.pairs = {{0, 1, Eigen::Matrix3d::Zero()}};
  springs().add_elastic_differential(s, Definiteness::exact, K);
  REQUIRE(K.pairs.size() == 6);
  CHECK(K.pairs[0].block.norm() == 0);
  CHECK(K.symmetric);
  const auto product = [&](const auto& dx, auto& df) { K.add_product(dx, df); };
  const Eigen::MatrixXd elastic = differences(s.x, 1e-3, [&](const PerParticle3& x) {
    PerParticle3 f = PerParticle3::Zero(3, n);
    add_elastic(springs(), {0, x, {}}, f);
    return f;
  });
  CHECK(agree(matrix_of(n, product), elastic, 1e-9));

  K.pairs.resize(1);
  springs().add_force_differential(s, K);
  REQUIRE(K.pairs.size() == 6);
  CHECK(K.pairs[0].block.norm() == 0);
  CHECK_FALSE(K.symmetric);
  const Eigen::MatrixXd damping = differences(s.x, 1e-3, [&](const PerParticle3& x) {
    return damping_forces(springs(), {0, x, s.v});
  });
  CHECK(agree(matrix_of(n, product), elastic + damping, 1e-9));
}

TEST_CASE("springs that do not damp leave the derivative symmetric") {
  StretchSprings list = springs();
  for (Spring& spring : list.springs) spring.damping = 0;
  ForceDifferential whole, elastic;
  list.add_force_differential(state(), whole);
  list.add_elastic_differential(state(), Definiteness::exact, elastic);
  CHECK(whole.symmetric);
  for (size_t k = 0; k < 5; ++k) CHECK(whole.pairs[k].block == elastic.pairs[k].block);
}

TEST_CASE("the semidefinite derivative of a spring drops what pushes it aside, no more") {
  const State s = state();
  const StretchSprings list = springs();
  ForceDifferential exact, semidefinite;
  list.add_elastic_differential(s, Definiteness::exact, exact);
  list.add_elastic_differential(s, Definiteness::semidefinite, semidefinite);
  for (size_t k = 0; k < 5; ++k) {
    const Spring& spring = list.springs[k];
    const Arm arm = arm_of(spring, s);
    const Vector3 along = arm.d / arm.length;
    const Eigen::Matrix3d pull = -spring.stiffness * along * along.transpose();
    const Eigen::Matrix3d& block = semidefinite.pairs[k].block;
    CHECK(semidefinite.pairs[k].a == spring.a);
    CHECK(semidefinite.pairs[k].b == spring.b);
    if (arm.length < spring.rest_length)
      CHECK((block - pull).norm() < 1e-14 * spring.stiffness);
    else
      CHECK(block == exact.pairs[k].block);
  }
}

TEST_CASE("a spring's rows sum to twice the larger of its stiffnesses along and across") {
  State s = state();
  s.v = {};
  const PerParticle start = scattered(n, 5.1).row(0).transpose();
  PerParticle expected = start, rows = start;
  int steeper_across = 0;
  for (const Spring& spring : springs().springs) {
    const double length = (s.x.col(spring.a) - s.x.col(spring.b)).norm();
    const double across = spring.stiffness * std::abs(spring.rest_length / length - 1);
    steeper_across += across > spring.stiffness;
    for (const int end : {spring.a, spring.b})
      expected[end] += 2 * std::max(spring.stiffness, across);
  }
  CHECK(steeper_across > 0);
  CHECK(steeper_across < 5);
  add_stiffness_bound(springs(), s, rows);
  CHECK(agree(rows, expected, 1e-14));
}

TEST_CASE("springs of a mesh: one an edge, with its length and the areas beside it") {
  const TriangleMesh mesh = make_sheet({SheetPattern::alternating, 1.3, 0.7, 3, 2});
  StretchMaterial material{37, 0.19, 1.07};
  const StretchSprings made = make_springs(mesh, material);
  REQUIRE(made.springs.size() == mesh.edges.size());
  const Eigen::VectorXd areas = triangle_areas(mesh.triangles, mesh.rest);
  for (size_t e = 0; e < mesh.edges.size(); ++e) {
    const Edge& edge = mesh.edges[e];
    const Spring& spring = made.springs[e];
    CHECK(spring.a == edge.a);
    CHECK(spring.b == edge.b);
    const double length = (mesh.rest.col(edge.b) - mesh.rest.col(edge.a)).norm();
    double area = areas[edge.triangles[0]];
    if (edge.triangles[1] >= 0) area += areas[edge.triangles[1]];
    CHECK(spring.rest_length == Approx(1.07 * length).epsilon(1e-14));
    CHECK(spring.stiffness == Approx(37 * area / (length * length)).epsilon(1e-14));
    CHECK(spring.damping == Approx(0.19 * area / (length * length)).epsilon(1e-14));
  }
}

TEST_CASE("a sheet's springs have no stiffness, no damping and their own lengths by default") {
  const StretchMaterial material;
  CHECK(material.stiffness == 0);
  CHECK(material.damping == 0);
  CHECK(material.rest_length_scale == 1);
}

TEST_CASE("springs refuse constants that are negative or no number, and lengths of 0") {
  const TriangleMesh mesh = make_sheet({SheetPattern::one_diagonal, 1.3, 0.7, 1, 1});
  const double nan = std::nan("");
  for (const double bad : {-1e-300, -3.0, nan}) {
    CHECK_THROWS_WITH(make_springs(mesh, {bad, 0.4, 0.9}),
                      "springs: stiffness must be a number >= 0 [N/m]");
    CHECK_THROWS_WITH(make_springs(mesh, {0.4, bad, 0.9}),
                      "springs: damping must be a number >= 0 [N s/m]");
  }
  for (const double bad : {0.0, -0.7, nan})
    CHECK_THROWS_WITH(make_springs(mesh, {0.4, 0.3, bad}),
                      "springs: rest_length_scale must be > 0");
  for (const double good : {0.0, 1e-300, 0.3})
    CHECK(make_springs(mesh, {good, good, 0.3}).springs.size() == 5);
  CHECK(make_springs(mesh, {2, 2, 1e-9}).springs.size() == 5);
}
