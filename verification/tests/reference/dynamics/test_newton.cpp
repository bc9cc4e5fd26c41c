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

TEST_CASE("Newton's method ends after sixty iterations, and after sixty more from another start") {
  Oscillator of{.length = 0.01};
  Work work;
  const State end = of.step(1e-3, work);
  const double left = std::pow(0.99, 61);
  CHECK((end.v.col(0) - (1 - left) * of.solution()).norm() < 1e-12);
  CHECK(work.newton_iterations == 120);
  CHECK(work.unfinished_solves == 1);
  CHECK(work.worst_residual == Approx(left).epsilon(1e-12));
  CHECK(work.solves == 121);
  CHECK(work.elastic_evaluations == 123);
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

namespace {

/// A spring from a held particle to a free one that the load keeps in balance, pushed aside.
struct PushedSpring {
  Vector3 along = Vector3(2, -1, 2) / 3;
  Spring spring{0, 1, 1.3, 20, 0};
  System system = make_system((PerParticle(2) << 0.7, 0.4).finished());
  State start{0.3, PerParticle3::Zero(3, 2), PerParticle3::Zero(3, 2)};
  Work work;

  PushedSpring(double length, double damping, const Vector3& velocity) {
    const Vector3 held(0.2, 0.5, -0.1);
    spring.damping = damping;
    start.x.col(0) = held;
    start.x.col(1) = held + length * along;
    start.v.col(1) = velocity;
    prescribe(system, {0, held, {}});
    system.forces.emplace_back(StretchSprings{{spring}});
    CustomForce load;
    load.elastic = [force = Vector3(spring.stiffness * (length - spring.rest_length) * along)](
                       const State&, PerParticle3& f) { f.col(1) += force; };
    system.forces.emplace_back(load);
    system.solver.tolerance = 1e-10;
  }
  State step(double length) { return backward_euler(system, {&start, 1}, length, work); }
  /// M (w - V) - s F(X + s w) of the free particle, without its damping.
  double error(const State& end, double step) const {
    State there = start;
    there.x += step * end.v;
    Work uncounted;
    const Vector3 f = elastic_forces(system.forces, there, uncounted).col(1);
    return (system.mass[1] * (end.v.col(1) - start.v.col(1)) - step * f).norm();
  }
};

/// The rate across is -20 (1.3 - 0.65)/0.65 = -20 N/m: of M, 1 - part is left after `step_over`.
PushedSpring compressed_spring() { return {0.65, 0, 1e-3 * Vector3(1, 2, 0).normalized()}; }
double step_over(double part) { return std::sqrt(part * 0.4 / 20); }

}  // namespace

TEST_CASE("the derivative of a compressed spring is taken as it is where the step allows") {
  PushedSpring of = compressed_spring();
  CHECK(of.error(of.step(step_over(0.9)), step_over(0.9)) < 1e-12);
  CHECK(of.work.unfinished_solves == 0);
  CHECK(of.work.newton_iterations <= 4);
  CHECK(of.work.stiffness_preparations == 2 * of.work.newton_iterations);
}

TEST_CASE("the derivative of a compressed spring is made semidefinite where the step is too long") {
  PushedSpring of = compressed_spring();
  CHECK(of.error(of.step(step_over(1.5)), step_over(1.5)) < 1e-9);
  CHECK(of.work.unfinished_solves == 0);
  CHECK(of.work.stiffness_preparations > 2 * of.work.newton_iterations);
  // in a linearised step nothing moves along the spring; across it the derivative, left out,
  // would have tripled the speed
  const State end = linearised_backward_euler(of.system, {&of.start, 1}, step_over(1.5), of.work);
  CHECK((end.v - of.start.v).norm() < 1e-15);
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
