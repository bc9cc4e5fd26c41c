// The implicit velocity, iterate by iterate, against the textbook's in dense matrices.
#include <catch2/catch.hpp>

#include "reference/dynamics/conjugate_gradient.h"
#include "verification/tests/reference/dynamics/linear_specimen.h"

using namespace foldproof;
using Eigen::MatrixXd, Eigen::VectorXd;

namespace {

constexpr double s = 0.07;

}  // namespace

TEST_CASE("a solver's settings are 1e-10 and a thousand iterations unless they are set") {
  const SolverSettings settings;
  CHECK(settings.tolerance == 1e-10);
  CHECK(settings.max_iterations == 1000);
  CHECK(settings.scale == ResidualScale::momentum);
}

TEST_CASE("each iterate of the implicit velocity is that of plain conjugate gradients") {
  const LinearSystem of;
  const MatrixXd B = MatrixXd::Identity(9, 9) - s * of.scaled(of.D);
  const VectorXd w0 = flat(of.v), b = of.free(s * of.D * w0).cwiseQuotient(of.roots());
  const double momentum = of.free(w0).cwiseProduct(of.roots()).norm();
  for (const ResidualScale scale : {ResidualScale::momentum, ResidualScale::initial_residual}) {
    const double size = scale == ResidualScale::momentum ? momentum : b.norm();
    for (int iterations = 0; iterations < 4; ++iterations) {
      const Iterate expected = conjugate_gradients(B, b, iterations);
      SolverSettings settings = settings_of(1e-7, iterations);
      settings.scale = scale;
      System system = system_of(of.mass, of.inverse_mass, settings);
      system.team = 1 + iterations;
      PerParticle3 w = of.v;
      Work work;
      work.worst_residual = 1e-9;
      const SolveResult solve = solve_velocity(system, of.damping(), s, w, work);
      const PerParticle3 change = of.spread(expected.y, Vector3::Zero());
      CHECK(difference(w, of.v + change) < 1e-12);
      CHECK(w.col(2) == of.v.col(2));
      CHECK(solve.residual == Approx(expected.residual / size).epsilon(1e-9));
      CHECK(solve.iterations == iterations);
      CHECK_FALSE(solve.converged);
      CHECK_FALSE(solve.indefinite);
      CHECK(work.damping_products == iterations + 1);
      CHECK(work.cg_iterations == iterations);
      CHECK(work.solves == 1);
      CHECK(work.unfinished_solves == 1);
      CHECK(work.worst_residual == solve.residual);
    }
  }
}

TEST_CASE("a solve ends as soon as its residual is no larger than the tolerance") {
  const LinearSystem of;
  const auto solved = [&](double tolerance, int most, Work& work) {
    PerParticle3 w = of.v;
    return solve_velocity(system_of(of.mass, of.inverse_mass, settings_of(tolerance, most)),
                          of.damping(), s, w, work);
  };
  Work work;
  const double reached = solved(1e-12, 2, work).residual;
  CHECK(work.unfinished_solves == 1);
  const SolveResult same = solved(reached, 9, work);
  CHECK(same.iterations == 2);
  CHECK(same.converged);
  CHECK(work.unfinished_solves == 1);
  CHECK(work.solves == 2);
  CHECK(work.cg_iterations == 4);
  CHECK(solved(std::nextafter(reached, 0), 9, work).iterations == 3);
}

TEST_CASE("the implicit velocity of many particles on several threads is that of each alone") {
  // damping of each particle by itself, at two rates: two iterations, over more than one block
  const int n = 8192 + 777;
  PerParticle mass(n), inverse_mass(n), c(n);
  PerParticle3 v(3, n);
  for (int i = 0; i < n; ++i) {
    mass[i] = 0.2 + 0.1 * std::sin(i);
    inverse_mass[i] = i % 1000 == 999 || i == n - 1 ? 0 : 1 / mass[i];
    c[i] = mass[i] * (i % 3 == 0 || i > n - 50 ? 5.0 : 11.0);
    v.col(i) = Vector3(std::cos(0.7 * i), 0.3 + std::sin(1.1 * i), i > n - 50 ? 9.0 : -0.4);
  }
  DampingOperator damping;
  damping.custom.push_back(
      [&](const PerParticle3& p, PerParticle3& f) { f -= p * c.asDiagonal(); });
  double residual = 0, momentum = 0;
  for (int i = 0; i < n; ++i) {
    residual += s * s * c[i] * c[i] * v.col(i).squaredNorm() * inverse_mass[i];
    if (inverse_mass[i] > 0) momentum += mass[i] * v.col(i).squaredNorm();
  }
  for (const int threads : {1, 3}) {
    System system = system_of(mass, inverse_mass, settings_of(1e-12, 0));
    system.team = threads;
    PerParticle3 w = v;
    Work work;
    const SolveResult none = solve_velocity(system, damping, s, w, work);
    CHECK(none.residual == Approx(std::sqrt(residual / momentum)).epsilon(1e-11));
    CHECK(w == v);
    system.solver.scale = ResidualScale::initial_residual;
    CHECK(solve_velocity(system, damping, s, w, work).residual == Approx(1).epsilon(1e-11));
    system.solver.max_iterations = 9;
    const SolveResult solve = solve_velocity(system, damping, s, w, work);
    CHECK(solve.iterations == 2);
    CHECK(solve.converged);
    double worst = 0;
    for (int i = 0; i < n; ++i) {
      const double share = inverse_mass[i] > 0 ? mass[i] / (mass[i] + s * c[i]) : 1;
      worst = std::max(worst, (w.col(i) - share * v.col(i)).norm());
    }
    CHECK(worst < 1e-11);
  }
}

TEST_CASE(
    "a direction without curvature ends a solve as indefinite, one of no residual as solved") {
  const PerParticle mass = (PerParticle(2) << 0.5, 0.25).finished(), inverse = mass.cwiseInverse();
  const PerParticle3 v = (PerParticle3(3, 2) << 3, 5, 7, 11, 13, 17).finished();
  for (const double factor : {0.0, 1.0, 3.0}) {  // D = factor M/s: M - s D = (1 - factor) M
    DampingOperator damping;
    damping.custom.push_back(
        [&](const PerParticle3& p, PerParticle3& f) { f += factor * 4 * (p * mass.asDiagonal()); });
    PerParticle3 w = v;
    Work work;
    const SolveResult solve =
        solve_velocity(system_of(mass, inverse, settings_of(1e-9, 9)), damping, 0.25, w, work);
    CHECK(w == v);
    CHECK(solve.iterations == 0);
    CHECK(solve.indefinite == (factor > 0));
    CHECK(solve.converged == (factor == 0));
    CHECK(solve.residual == Approx(factor));
    CHECK(work.unfinished_solves == (factor > 0));
    CHECK(work.worst_residual == solve.residual);
  }
  // without a residual to compare with, and without momentum
  for (const ResidualScale scale : {ResidualScale::momentum, ResidualScale::initial_residual}) {
    SolverSettings settings = settings_of(1e-9, 9);
    settings.scale = scale;
    PerParticle3 w = PerParticle3::Zero(3, 2);
    Work work;
    const SolveResult solve = solve_velocity(system_of(mass, inverse, settings), {}, 0.25, w, work);
    CHECK(solve.residual == 0);
    CHECK(solve.converged);
  }
}

TEST_CASE("a particle of 1 kg is as free as any other") {
  LinearSystem of;
  of.mass[1] = of.inverse_mass[1] = 1;
  of.mass[3] = of.inverse_mass[3] = 1;
  const MatrixXd B = MatrixXd::Identity(9, 9) - s * of.scaled(of.D);
  const VectorXd b = of.free(s * of.D * flat(of.v)).cwiseQuotient(of.roots());
  PerParticle3 w = of.v, q;
  Work work;
  solve_velocity(system_of(of.mass, of.inverse_mass, settings_of(1e-14, 99)), of.damping(), s, w,
                 work);
  CHECK(difference(w, of.v + of.spread(B.partialPivLu().solve(b), Vector3::Zero())) < 1e-11);
  const DampingOperator damping = of.damping();
  const ForceDifferential stiffness = of.stiffness();
  multiply({of.mass, of.inverse_mass, damping, stiffness, s}, of.v, q, work);
  VectorXd expected = of.newton(s) * flat(of.v);
  expected.segment<3>(6).setZero();
  CHECK(difference(q, columns(expected)) < 1e-13);
}

TEST_CASE("a solve of numbers that are none says so") {
  const LinearSystem of;
  DampingOperator damping;
  damping.custom.push_back([](const PerParticle3&, PerParticle3& f) { f(1, 3) = NAN; });
  PerParticle3 w = of.v;
  Work work;
  const SolveResult solve = solve_velocity(
      system_of(of.mass, of.inverse_mass, settings_of(1e-9, 9)), damping, s, w, work);
  CHECK(std::isnan(solve.residual));
  CHECK_FALSE(solve.converged);
  CHECK(work.unfinished_solves == 1);
  CHECK(std::isnan(work.worst_residual));
}
