// Solvers of a Newton step, iterate by iterate, against the textbooks' in dense matrices.
#include <catch2/catch.hpp>

#include "reference/dynamics/conjugate_gradient.h"
#include "reference/dynamics/biconjugate_gradient.h"
#include "verification/tests/reference/dynamics/linear_specimen.h"

using namespace foldproof;
using Eigen::MatrixXd, Eigen::VectorXd;

namespace {

constexpr double s = 0.07;

}  // namespace

TEST_CASE("the Newton matrix is M - s D - s^2 K, and nothing for prescribed particles") {
  const LinearSystem of;
  const DampingOperator damping = of.damping();
  const ForceDifferential stiffness = of.stiffness();
  const NewtonMatrix A{of.mass, of.inverse_mass, damping, stiffness, s};
  PerParticle3 q;
  Work work;
  multiply(A, of.v, q, work);
  VectorXd expected = of.newton(s) * flat(of.v);
  expected.segment<3>(6).setZero();
  CHECK(difference(q, columns(expected)) < 1e-13);
  CHECK(q.col(2) == Vector3::Zero());
  CHECK(work.damping_products == 1);
  CHECK(work.stiffness_products == 1);
}

TEST_CASE("each iterate of a symmetric Newton step is that of plain conjugate gradients") {
  const LinearSystem of;
  const DampingOperator damping = of.damping();
  const ForceDifferential stiffness = of.stiffness();
  const NewtonMatrix A{of.mass, of.inverse_mass, damping, stiffness, s};
  PerParticle3 r = of.v;
  r.col(2).setZero();
  const VectorXd b = of.free(flat(r)).cwiseQuotient(of.roots());
  for (int iterations = 0; iterations < 4; ++iterations) {
    const Iterate expected = conjugate_gradients(of.scaled(of.newton(s)), b, iterations);
    const SolverSettings settings = settings_of(1e-6, iterations);
    PerParticle3 dw = PerParticle3::Constant(3, 4, 77);
    Work work;
    const SolveResult solve = solve_newton_step(A, settings, r, dw, work);
    CHECK(difference(dw, of.spread(expected.y, Vector3::Zero())) < 1e-12);
    CHECK(solve.residual == Approx(expected.residual / b.norm()).epsilon(1e-9));
    CHECK(solve.iterations == iterations);
    CHECK_FALSE(solve.converged);
    CHECK_FALSE(solve.indefinite);
    CHECK(work.solves == 1);
    CHECK(work.cg_iterations == iterations);
    CHECK(work.damping_products == iterations);
    CHECK(work.stiffness_products == iterations);
    CHECK(work.unfinished_solves == 0);
    CHECK(work.worst_residual == 0);
  }
}

TEST_CASE("a Newton step ends at its latest iterate where the matrix turns out indefinite") {
  LinearSystem of;
  of.D.setZero();
  // along x the matrix is 2 M, along y -M: of the first direction p.A p is still positive
  of.K.setZero();
  for (int i = 0; i < 4; ++i) {
    of.K(3 * i, 3 * i) = -of.mass[i] / (s * s);
    of.K(3 * i + 1, 3 * i + 1) = 2 * of.mass[i] / (s * s);
  }
  const DampingOperator damping = of.damping();
  const ForceDifferential stiffness = of.stiffness();
  const NewtonMatrix A{of.mass, of.inverse_mass, damping, stiffness, s};
  PerParticle3 r = PerParticle3::Zero(3, 4);
  r.col(1) = Vector3(0.3, 0.1, 0);
  PerParticle3 dw;
  Work work;
  const SolveResult solve = solve_newton_step(A, settings_of(1e-9, 9), r, dw, work);
  CHECK(solve.indefinite);
  CHECK_FALSE(solve.converged);
  CHECK(solve.iterations == 1);
  // alpha = (0.09 + 0.01)/(2 0.09 - 0.01), of r/m
  CHECK((dw.col(1) - 0.1 / 0.17 * r.col(1) / 0.47).norm() < 1e-14);
  CHECK(dw.col(0) == Vector3::Zero());
  CHECK(work.stiffness_products == 2);
  CHECK(work.solves == 1);
  CHECK(work.cg_iterations == 1);

  r.setZero();
  CHECK(solve_newton_step(A, settings_of(1e-9, 9), r, dw, work).converged);
  CHECK(dw == PerParticle3::Zero(3, 4));
}

TEST_CASE("each iterate of an unsymmetric Newton step is that of plain BiCGSTAB") {
  LinearSystem of;
  of.K += uneven_matrix(12, 60, 1.9);
  const DampingOperator damping = of.damping();
  const ForceDifferential stiffness = of.stiffness();
  const NewtonMatrix A{of.mass, of.inverse_mass, damping, stiffness, s};
  PerParticle3 r = of.v;
  r.col(2).setZero();
  const VectorXd b = of.free(flat(r)).cwiseQuotient(of.roots());
  for (int iterations = 0; iterations < 4; ++iterations) {
    const Iterate expected = stabilised_gradients(of.scaled(of.newton(s)), b, iterations);
    PerParticle3 dw = PerParticle3::Constant(3, 4, 77);
    Work work;
    const SolveResult solve = solve_unsymmetric_step(A, settings_of(1e-9, iterations), r, dw, work);
    CHECK(difference(dw, of.spread(expected.y, Vector3::Zero())) < 1e-10);
    CHECK(solve.residual == Approx(expected.residual / b.norm()).epsilon(1e-7));
    CHECK(solve.iterations == iterations);
    CHECK_FALSE(solve.converged);
    CHECK_FALSE(solve.indefinite);
    CHECK(work.solves == 1);
    CHECK(work.cg_iterations == 2 * iterations);
    CHECK(work.damping_products == 2 * iterations);
    CHECK(work.stiffness_products == 2 * iterations);
  }
  PerParticle3 dw;
  Work work;
  const double reached = solve_unsymmetric_step(A, settings_of(1e-9, 1), r, dw, work).residual;
  REQUIRE(reached < 1);
  const SolveResult same = solve_unsymmetric_step(A, settings_of(reached, 9), r, dw, work);
  CHECK(same.converged);
  CHECK(same.iterations == 1);
  const SolveResult all = solve_unsymmetric_step(A, settings_of(1e-10, 99), r, dw, work);
  CHECK(all.converged);
  CHECK((of.free(of.newton(s) * flat(dw) - flat(r))).norm() < 1e-8);
}

TEST_CASE("BiCGSTAB ends where it breaks down, at its latest iterate") {
  LinearSystem of;
  of.D.setZero();
  of.inverse_mass[2] = 1 / of.mass[2];
  const DampingOperator damping = of.damping();
  PerParticle3 dw;
  const auto solved = [&](const Eigen::Matrix3d& block, const PerParticle3& r, Work& work) {
    // A = M block, particle by particle
    for (int i = 0; i < 4; ++i)
      of.K.block<3, 3>(3 * i, 3 * i) = of.mass[i] / (s * s) * (Eigen::Matrix3d::Identity() - block);
    const ForceDifferential stiffness = of.stiffness();
    const NewtonMatrix A{of.mass, of.inverse_mass, damping, stiffness, s};
    return solve_unsymmetric_step(A, settings_of(1e-9, 9), r, dw, work);
  };
  of.K.setZero();
  PerParticle3 r = PerParticle3::Zero(3, 4);
  r.col(1) = Vector3(0.5, 0, 0);

  // r.A r = 0: no step at all
  const Eigen::Matrix3d turn = (Eigen::Matrix3d() << 0, -1, 0, 1, 0, 0, 0, 0, 1).finished();
  Work none;
  const SolveResult nothing = solved(turn, r, none);
  CHECK(dw == PerParticle3::Zero(3, 4));
  CHECK(nothing.residual == 1);
  CHECK_FALSE(nothing.converged);
  CHECK(nothing.iterations == 1);
  CHECK(none.solves == 1);
  CHECK(none.cg_iterations == 2);

  // t.s = 0: the first half of a step. A e1 = e1 + e2, A e2 = e3, so that alpha = 1, s = -e2
  const Eigen::Matrix3d half = (Eigen::Matrix3d() << 1, 0, 0, 1, 0, 0, 0, 1, 0).finished();
  Work one;
  const SolveResult stalled = solved(half, r, one);
  CHECK((dw.col(1) - r.col(1) / 0.47).norm() < 1e-12);
  CHECK(stalled.residual == Approx(1).epsilon(1e-12));
  CHECK_FALSE(stalled.converged);
  CHECK(stalled.iterations == 1);

  // A s = 0: the first half of a step, and no part of the second
  const Eigen::Matrix3d flat_block = (Eigen::Matrix3d() << 1, 0, 0, 1, 0, 0, 0, 0, 0).finished();
  Work none_of_s;
  CHECK(solved(flat_block, r, none_of_s).residual == Approx(1).epsilon(1e-12));
  CHECK((dw.col(1) - r.col(1) / 0.47).norm() < 1e-12);
  CHECK(none_of_s.cg_iterations == 2);

  // s = 0: the first half step solves it
  Work exact;
  const SolveResult done = solved(2 * Eigen::Matrix3d::Identity(), r, exact);
  CHECK(done.converged);
  CHECK(done.iterations == 1);
  CHECK((dw.col(1) - r.col(1) / 0.94).norm() < 1e-12);

  Work empty;
  r.setZero();
  CHECK(solved(turn, r, empty).converged);
  CHECK(empty.stiffness_products == 0);
  CHECK(empty.solves == 1);
}

TEST_CASE("solves of Newton steps add to what others counted") {
  const LinearSystem of;
  const DampingOperator damping = of.damping();
  const ForceDifferential stiffness = of.stiffness();
  const NewtonMatrix A{of.mass, of.inverse_mass, damping, stiffness, s};
  PerParticle3 r = of.v, dw;
  r.col(2).setZero();
  Work work;
  work.solves = 70, work.cg_iterations = 50;
  solve_newton_step(A, settings_of(1e-12, 3), r, dw, work);
  CHECK(work.solves == 71);
  CHECK(work.cg_iterations == 53);
  solve_unsymmetric_step(A, settings_of(1e-12, 2), r, dw, work);
  CHECK(work.solves == 72);
  CHECK(work.cg_iterations == 57);
}
