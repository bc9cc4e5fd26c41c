// Steps of methods: the linearised one against its formula, and the parts that several share.
#include <catch2/catch.hpp>

#include "reference/dynamics/finish_step.h"
#include "reference/dynamics/implicit.h"
#include "reference/dynamics/integrator.h"
#include "verification/tests/reference/dynamics/uneven_matrices.h"

using namespace foldproof;
using Eigen::MatrixXd, Eigen::VectorXd;

namespace {

constexpr double h = 0.13;

/// Four particles under a force F = -K d - 3.1 d^3, d = x - rest, and a damping D = -(1 + 0.4
/// sin(x_0) + 0.3 t) C, with full matrices. Particle 2 is prescribed.
struct DynamicsSpecimen {
  static constexpr int prescribed = 2;
  MatrixXd K = uneven_definite_matrix(12, 7.3, 0.4), C = uneven_definite_matrix(12, 1.9, 2.6);
  VectorXd rest = uneven_matrix(12, 0.2, 5.1).col(3);
  Motion motion{{0.3, -0.4, 0.5}, {0.11, 0.07, -0.13}, 0.6, 0.8,
                {0.4, 0.3, -0.2}, {0.5, 0.9, -0.7}};
  Vector3 start{0.6, -0.3, 0.8};
  System system = make_system((PerParticle(4) << 0.31, 0.47, 0.23, 0.59).finished());
  State now{0.7,
            columns(uneven_matrix(12, 0.9, 0.2).col(4)),
            columns(uneven_matrix(12, 1.3, 3.9).col(8)),
            {{5, 3, 1, Vector3(0.2, 0.4, 0.6)}}};

  DynamicsSpecimen() {
    system.solver.tolerance = 1e-14;
    CustomForce force;
    force.elastic = [this](const State& s, PerParticle3& f) { f += columns(elastic(flat(s.x))); };
    force.damping = [this](const State& s, const PerParticle3& v, PerParticle3& f) {
      f += columns(damping(s.time, flat(s.x)) * flat(v));
    };
    force.differential = [this](const State& s, const PerParticle3& dx, PerParticle3& df) {
      df += columns(stiffness(flat(s.x)) * flat(dx));
    };
    system.forces.emplace_back(std::move(force));
    now.x.col(prescribed) = path(now.time);
    now.v.col(prescribed) = path_velocity(now.time);
    prescribe(system, {prescribed, start, motion});
  }
  DynamicsSpecimen(const DynamicsSpecimen&) = delete;

  VectorXd elastic(const VectorXd& x) const {
    const VectorXd d = x - rest;
    return -K * d - 3.1 * d.array().cube().matrix();
  }
  MatrixXd damping(double t, const VectorXd& x) const {
    return -(1 + 0.4 * std::sin(x[0]) + 0.3 * t) * C;
  }
  MatrixXd stiffness(const VectorXd& x) const {
    return -K - 9.3 * MatrixXd((x - rest).array().square().matrix().asDiagonal());
  }
  Vector3 path(double t) const { return position_at(motion, start, t); }
  Vector3 path_velocity(double t) const { return velocity_at(motion, start, t); }

  State step(std::string_view name, Work& work) const {
    return integrator_named(name).step(system, {&now, 1}, h, work);
  }
};

double difference(const PerParticle3& a, const PerParticle3& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("linearised backward Euler solves one linear system about the step's start") {
  DynamicsSpecimen of;
  const double t = of.now.time, end = t + h;
  const VectorXd x = flat(of.now.x), v = flat(of.now.v);
  const VectorXd m = of.system.mass.transpose().replicate(3, 1).reshaped();
  MatrixXd A = MatrixXd(m.asDiagonal()) - h * of.damping(t, x) - h * h * of.stiffness(x);
  VectorXd b = m.cwiseProduct(v) + h * of.elastic(x);
  A.middleRows<3>(6).setZero();
  A.block<3, 3>(6, 6).setIdentity();
  b.segment<3>(6) = (of.path(end) - of.now.x.col(of.prescribed)) / h;
  PerParticle3 w = columns(A.partialPivLu().solve(b));
  Work work;
  const State step = of.step("linear-backward-euler", work);
  CHECK(difference(step.x, of.now.x + h * w) < 1e-11);
  w.col(of.prescribed) = of.path_velocity(end);
  CHECK(difference(step.v, w) < 1e-11);
  CHECK(step.bonds.size() == 1);
  CHECK(work.solves == 1);
  CHECK(work.unfinished_solves == 0);
  CHECK(work.elastic_evaluations == 1);
  CHECK(work.damping_preparations == 1);
  CHECK(work.stiffness_preparations == 1);
  CHECK(work.damping_products == work.cg_iterations + 1);
  CHECK(work.stiffness_products == work.cg_iterations + 1);
  CHECK(work.newton_iterations == 0);

  of.system.solver.max_iterations = 2;
  Work cut;
  of.step("linear-backward-euler", cut);
  CHECK(cut.unfinished_solves == 1);
  CHECK(cut.cg_iterations == 2);
  CHECK(cut.worst_residual > 1e-6);
}

TEST_CASE("a step's end and all of its stages have the bonds of its start") {
  DynamicsSpecimen of;
  CustomForce force;
  size_t least = 1;
  force.elastic = [&](const State& s, PerParticle3&) { least = std::min(least, s.bonds.size()); };
  of.system.forces.emplace_back(force);
  for (const Integrator& integrator : integrators()) {
    INFO(integrator.name);
    Work work;
    const State step = of.step(integrator.name, work);
    CHECK(step.bonds.size() == 1);
    CHECK(step.time == of.now.time + h);
    CHECK(least == 1);
  }
}

TEST_CASE("at the end of a step filters see the move first, then the velocity that it left") {
  DynamicsSpecimen of;
  struct Call {
    double from, to, length;
    State at;
    PerParticle3 given;
  };
  std::vector<Call> calls;
  of.system.filters.emplace_back(CustomFilter{[&](const Span& span, const State& s, auto& v) {
    calls.push_back({span.start, span.end, span.step, s, v});
    v.leftCols(2) *= 0.8;
  }});
  const double t = of.now.time, end = t + h;
  PerParticle3 move = columns(uneven_matrix(12, 1.1, 0.3).col(2)),
               last = columns(uneven_matrix(12, 0.8, 4.3).col(5));
  Work work;
  const State step = finish_step(of.system, of.now, h, {move, last}, work);
  move.col(of.prescribed) = (of.path(end) - of.now.x.col(of.prescribed)) / h;
  last.leftCols(2) -= 0.2 * move.leftCols(2);
  last.col(of.prescribed) = of.path_velocity(end);
  REQUIRE(calls.size() == 2);
  const auto expect = [](const Call& call, double from, double to, const PerParticle3& given) {
    CHECK(std::tuple(call.from, call.to, call.length) == std::tuple(from, to, h));
    CHECK(call.at.time == from);
    CHECK(difference(call.given, given) < 1e-14);
  };
  expect(calls[0], t, end, move);
  expect(calls[1], end, end, last);
  CHECK(calls[0].at.x == of.now.x);
  CHECK(calls[0].at.v == of.now.v);
  CHECK(difference(calls[1].at.v, last) < 1e-14);
  CHECK(calls[1].at.x == step.x);
  move.leftCols(2) *= 0.8;
  last.leftCols(2) *= 0.8;
  CHECK(difference(step.x, of.now.x + h * move) < 1e-14);
  CHECK(difference(step.v, last) < 1e-14);
}
