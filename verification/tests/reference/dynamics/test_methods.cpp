// What the steps of methods share: bonds, and their ends.
#include <catch2/catch.hpp>

#include "reference/dynamics/finish_step.h"
#include "reference/dynamics/integrator.h"
#include "verification/tests/reference/dynamics/uneven_matrices.h"

using namespace foldproof;

namespace {

constexpr double h = 0.13;

/// Four particles under forces that depend on x, v and t. Particle 2 is prescribed.
struct DynamicsSpecimen {
  static constexpr int prescribed = 2;
  Motion motion{{0.3, -0.4, 0.5}, {0.11, 0.07, -0.13}, 0.6, 0.8,
                {0.4, 0.3, -0.2}, {0.5, 0.9, -0.7}};
  Vector3 start{0.6, -0.3, 0.8};
  System system = make_system((PerParticle(4) << 0.31, 0.47, 0.23, 0.59).finished());
  State now{0.7,
            columns(uneven_matrix(12, 0.9, 0.2).col(4)),
            columns(uneven_matrix(12, 1.3, 3.9).col(8)),
            {{5, 3, 1, Vector3(0.2, 0.4, 0.6)}}};

  DynamicsSpecimen() {
    CustomForce force;
    force.elastic = [](const State& s, PerParticle3& f) { f -= 7.3 * s.x; };
    force.damping = [](const State& s) -> DampingOperator::Custom {
      return {[s](const PerParticle3& v, PerParticle3& f) { f -= (1 + 0.3 * s.time) * v; }, {}};
    };
    force.differential = [](const State&, Definiteness) {
      return [](const PerParticle3& dx, PerParticle3& df) { df -= 7.3 * dx; };
    };
    system.forces.emplace_back(std::move(force));
    now.x.col(prescribed) = path(now.time);
    now.v.col(prescribed) = path_velocity(now.time);
    prescribe(system, {prescribed, start, motion});
  }
  Vector3 path(double t) const { return position_at(motion, start, t); }
  Vector3 path_velocity(double t) const { return velocity_at(motion, start, t); }
};

double difference(const PerParticle3& a, const PerParticle3& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("a step's end and all of its stages have the bonds of its start") {
  DynamicsSpecimen of;
  CustomForce force;
  size_t least = 1;
  force.elastic = [&](const State& s, PerParticle3&) { least = std::min(least, s.bonds.size()); };
  of.system.forces.emplace_back(force);
  for (const Integrator& integrator : integrators()) {
    INFO(integrator.name);
    Work work;
    const State step = integrator.step(of.system, {&of.now, 1}, h, work);
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
