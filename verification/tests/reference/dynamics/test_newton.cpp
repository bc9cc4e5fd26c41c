// Newton's method, and the solvers of its linear systems.
#include <catch2/catch.hpp>

#include "reference/dynamics/biconjugate_gradient.h"
#include "reference/dynamics/conjugate_gradient.h"
#include "reference/dynamics/implicit.h"
#include "reference/forces/degenerate.h"
#include "verification/specimens/solver_problems.h"
#include "verification/tests/reference/dynamics/uneven_matrices.h"

using namespace foldproof;

namespace {

constexpr double h = 0.5, mass = 0.25, k = 7;  // M + h^2 k = 2 kg

/// A particle on a spring of three equal rates from `rest`. All numbers are exact in binary.
struct Oscillator {
  // of a Newton step over that to the solution; the derivative says (M + h^2 k)/length
  double length = 1;
  double farthest = 1e300;  // from the start: beyond it the force is degenerate [m]
  Vector3 rest = Vector3(3, 4, 12) / 16;
  System system = make_system((PerParticle(1) << mass).finished());
  State start{0.75, PerParticle3::Zero(3, 1), PerParticle3::Zero(3, 1)};

  State step(double tolerance, Work& work) {
    system.solver.tolerance = tolerance;
    CustomForce force;
    force.elastic = [this](const State& s, PerParticle3& f) {
      if (s.x.norm() > farthest) throw DegenerateElement("too far", {0});
      f.col(0) += k * (rest - s.x.col(0));
    };
    force.differential = [this](const State&, Definiteness) {
      return [this](const PerParticle3& dx, PerParticle3& df) {
        df -= (2 / length - mass) / (h * h) * dx;
      };
    };
    system.forces.assign(1, std::move(force));
    return backward_euler(system, {&start, 1}, h, work);
  }
  Work work_of(double tolerance) {
    Work work;
    step(tolerance, work);
    return work;
  }
  /// The solution from rest at the origin: h k rest/(M + h^2 k).
  Vector3 solution() const { return h * k / 2 * rest; }
};

}  // namespace

TEST_CASE("steps that overshoot are halved, and the iteration ends at the tolerance") {
  Oscillator of{.length = 3};  // halved to 1.5: each step leaves -1/2 of the residual
  for (const auto& [tolerance, iterations] : {std::pair{0.25, 2}, {0.2499, 3}, {0.3, 2}}) {
    Work work;
    const State end = of.step(tolerance, work);
    const double left = std::pow(-0.5, iterations);
    CHECK((end.v.col(0) - (1 - left) * of.solution()).norm() < 1e-14);
    CHECK(work.newton_iterations == iterations);
    CHECK(work.elastic_evaluations == 1 + 2 * iterations);
    CHECK(work.worst_residual == Approx(std::abs(left)).epsilon(1e-12));
    CHECK(work.unfinished_solves == 0);
  }
}

TEST_CASE("steps into degenerate places are halved, and no start is taken there") {
  Oscillator of{.length = 1.5};
  of.farthest = 1.01 * h * of.solution().norm();  // the full step leads half as far again
  const Work work = of.work_of(0.3);
  CHECK(work.newton_iterations == 1);
  CHECK(work.worst_residual == Approx(0.25));
  CHECK(work.unfinished_solves == 0);

  of.farthest = 1e-9;
  Work lost;
  CHECK(of.step(0.3, lost).v.norm() == 0);
  CHECK(lost.newton_iterations == 1);
  CHECK(lost.unfinished_solves == 1);
  CHECK(lost.worst_residual == Approx(1));
}

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
