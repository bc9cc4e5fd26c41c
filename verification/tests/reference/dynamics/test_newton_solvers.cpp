// Solvers of the implicit velocity and of a Newton step: solutions, ends, ties and breakdowns.
#include <catch2/catch.hpp>

#include "reference/dynamics/biconjugate_gradient.h"
#include "reference/dynamics/conjugate_gradient.h"
#include "verification/specimens/solver_problems.h"
#include "verification/tests/reference/dynamics/uneven_matrices.h"

using namespace foldproof;
using Eigen::MatrixXd, Eigen::VectorXd, Eigen::Matrix3d;

namespace {

constexpr double s = 0.0625;

/// Four particles, of which the third is prescribed, with full matrices of damping and stiffness.
struct LinearSystem {
  PerParticle mass = (PerParticle(4) << 0.31, 1, 0.23, 0.59).finished();
  PerParticle inverse_mass = (PerParticle(4) << 1 / 0.31, 1, 0, 1 / 0.59).finished();
  MatrixXd D = -uneven_definite_matrix(12, 21, 2.6), K = -uneven_definite_matrix(12, 160, 0.4);
  PerParticle3 v = columns(uneven_matrix(12, 1.3, 3.9).col(8));

  DampingOperator damping() const {
    DampingOperator damping;
    damping.custom.push_back(
        {[D = D](const PerParticle3& p, PerParticle3& f) { f += columns(D * flat(p)); }, {}});
    return damping;
  }
  /// solve_unsymmetric_step with the Newton matrix.
  SolveResult solved(const SolverSettings& settings, const PerParticle3& r, PerParticle3& dw,
                     Work& work) const {
    const DampingOperator operator_of_damping = damping();
    ForceDifferential stiffness;
    stiffness.custom.push_back(
        [this](const PerParticle3& p, PerParticle3& f) { f += columns(K * flat(p)); });
    return solve_unsymmetric_step({mass, inverse_mass, operator_of_damping, stiffness, s}, settings,
                                  r, dw, work);
  }
};

SolverSettings settings_of(double tolerance, int iterations) {
  return {tolerance, iterations, ResidualScale::momentum};
}

}  // namespace

TEST_CASE("BiCGSTAB ends where it breaks down, at its latest iterate") {
  const auto expect = [](const Matrix3d& block, double first, double residual, double part) {
    LinearSystem of;  // A = M block, particle by particle
    of.D.setZero(), of.K.setZero();
    for (int i = 0; i < 4; ++i)
      of.K.block<3, 3>(3 * i, 3 * i) = of.mass[i] / (s * s) * (Matrix3d::Identity() - block);
    PerParticle3 r = PerParticle3::Zero(3, 4), dw;
    r(0, 1) = first;
    Work work;
    const SolveResult solve = of.solved(settings_of(1e-9, 9), r, dw, work);
    CHECK((dw - part * r).norm() < 1e-12);
    CHECK(solve.residual == Approx(residual).epsilon(1e-12).margin(1e-12));
    CHECK(solve.converged == (residual == 0));
    CHECK(solve.iterations == (first != 0));
    CHECK(work.cg_iterations == 2 * (first != 0));
    CHECK(work.solves == 1);
  };
  const Matrix3d turn{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}};
  expect(turn, 0.5, 1, 0);                                       // r.A r = 0: no step at all
  expect(Matrix3d{{1, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 0.5, 1, 1);  // t.s = 0: the first half
  expect(Matrix3d{{1, 0, 0}, {1, 0, 0}, {0, 0, 0}}, 0.5, 1, 1);  // A s = 0: the first half
  expect(2 * Matrix3d::Identity(), 0.5, 0, 0.5);                 // s = 0: the first half is all
  expect(turn, 0, 0, 0);
}

TEST_CASE("a solve ends as soon as its residual is no larger than the tolerance") {
  const LinearSystem of;
  const auto solved = [&](double tolerance, int most) {
    PerParticle3 w = of.v;
    Work work;
    return solve_velocity(system_of(of.mass, of.inverse_mass, settings_of(tolerance, most)),
                          of.damping(), s, w, work);
  };
  const double reached = solved(1e-12, 2).residual;
  const SolveResult same = solved(reached, 9);
  CHECK(same.iterations == 2);
  CHECK(same.converged);
  CHECK(solved(std::nextafter(reached, 0), 9).iterations == 3);
}

TEST_CASE("a direction without curvature ends a solve as indefinite, no residual as solved") {
  const PerParticle mass = (PerParticle(2) << 0.5, 0.25).finished(), inverse = mass.cwiseInverse();
  const PerParticle3 v{{3, 5}, {7, 11}, {13, 17}};
  for (const double factor : {0.0, 1.0, 3.0}) {  // D = factor M/s: M - s D = (1 - factor) M
    DampingOperator damping;
    damping.custom.push_back(
        {[&](const PerParticle3& p, PerParticle3& f) { f += factor * 4 * (p * mass.asDiagonal()); },
         {}});
    SolverSettings settings = settings_of(1e-9, 9);
    if (factor == 0) settings.scale = ResidualScale::initial_residual;  // which is 0
    PerParticle3 w = v;
    Work work;
    const SolveResult solve =
        solve_velocity(system_of(mass, inverse, settings), damping, 0.25, w, work);
    CHECK(w == v);
    CHECK(solve.iterations == 0);
    CHECK(solve.indefinite == (factor > 0));
    CHECK(solve.converged == (factor == 0));
    CHECK(solve.residual == Approx(factor));
    CHECK(work.unfinished_solves == (factor > 0));
    CHECK(work.worst_residual == solve.residual);
  }
}
