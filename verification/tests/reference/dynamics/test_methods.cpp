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
