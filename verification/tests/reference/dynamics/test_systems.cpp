// Systems and events.
#include <catch2/catch.hpp>

#include "reference/dynamics/events.h"
#include "reference/dynamics/integrator.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

PerParticle three_masses() { return (PerParticle(3) << 0.4, 0.7, 0.9).finished(); }

State three_particles(double time) {
  return {time, PerParticle3{{0.3, 1.7, -0.4}, {0.8, -0.6, 2.3}, {1.1, 0.9, -1.3}},
          PerParticle3{{1.2, -0.7, 0.5}, {2.1, 0.4, -1.6}, {-0.9, 3.1, 0.2}}};
}

}  // namespace

TEST_CASE("a system's masses are positive and finite, or the first other one is named") {
  for (const double wrong : {0.0, -0.3, infinite, double(NAN)})
    for (int i = 0; i < 3; ++i) {
      PerParticle mass = three_masses();
      mass.tail(3 - i).setConstant(wrong);
      CHECK_THROWS_WITH(make_system(mass), Contains("particle " + std::to_string(i)));
    }
}

TEST_CASE("a particle's motion is prescribed once, and only if there is the particle") {
  System system = make_system(three_masses());
  prescribe(system, {2, {1, 2, 3}, {}});
  prescribe(system, {0, {4, 5, 6}, {}});
  CHECK(system.inverse_mass == Vector3(0, 1 / 0.7, 0));
  CHECK(system.mass == three_masses());
  for (const auto& [particle, why] : {std::pair{-1, "-1"}, {3, "particle 3"}, {2, "twice"}})
    CHECK_THROWS_WITH(prescribe(system, {particle, {1, 2, 3}, {}}), Contains(why));
  REQUIRE(system.prescribed.size() == 2);
  CHECK(system.prescribed[1].start == Vector3(4, 5, 6));
}

namespace {

RigidObject moving(const RigidMotion& motion) { return {{}, {}, motion}; }

Motion between(double from, double until) {
  Motion motion;
  motion.from = from, motion.until = until;
  motion.velocity = {0.5, 0.25, -2};
  return motion;
}

System system_of_events() {
  System system = make_system(three_masses());
  StickyPatch first, second;
  first.from = 0.35, first.until = 0.95, first.release = 0.25;
  second.from = 0.45;
  system.forces = {CustomForce{}, Sticking{{first, second}}};
  const auto body = std::make_shared<DeformingBody>();
  for (const double time : {0.15, 0.55, 0.85}) {
    body->frames.emplace_back();
    body->frames.back().time = time;
  }
  ObjectCollision one, other;
  one.objects = {{"a", moving(between(0.2, 0.6))}, {"b", DeformingObject{body}}};
  other.objects = {{"c", moving(make_keyframes({{0.3, {}}, {0.5, {}}, {0.75, {}}}))},
                   {"d", moving(between(-infinite, infinite))}};
  system.filters = {CustomFilter{}, one, other};
  return system;
}

/// The times that events are passed at until none is left, from the start on.
std::vector<double> times_passed(const System& system, double start, double tolerance) {
  Events events(system, start, tolerance);
  CHECK(events.last() == start);
  std::vector<double> passed;
  while (events.next() < infinite) {
    const State s = three_particles(events.next());
    passed.push_back(s.time);
    CHECK(events.pass_events(s).v == s.v);
    CHECK(events.last() == s.time);
  }
  return passed;
}

}  // namespace

TEST_CASE("events are passed in order, those up to a tolerance apart at once") {
  const System system = system_of_events();
  CHECK(times_passed(system, 0.51, 0.02) ==
        std::vector<double>{0.55, 0.6, 0.95 - 0.25, 0.75, 0.85, 0.95});
  CHECK(times_passed(system, 0.51, 0.06) == std::vector<double>{0.55, 0.95 - 0.25, 0.85, 0.95});
  System one = make_system(three_masses());
  CHECK(times_passed(one, 0.3, 0.1).empty());
  ObjectCollision collision;
  collision.objects = {{"a", moving(between(0.5, 0.75))}};
  one.filters = {collision};
  CHECK(times_passed(one, 0.25, 0.25) == std::vector<double>{0.5});
  CHECK(times_passed(one, 0.25, 0.2499) == std::vector<double>{0.5, 0.75});
  // a run begins without passing an event close to its start
  prescribe(one, {1, Vector3::Zero(), between(0.31, 0.9)});
  CHECK(Events(one, 0.3, 0.02, 0.3).next() == 0.31);
}

TEST_CASE("sticking that forecasts allows steps of twice its time, if nothing else forbids them") {
  System system = make_system((PerParticle(3) << 0.5, 0.02, 0.3).finished());
  State s{0, PerParticle3{{0, 1, 2}, {0, 0, 0}, {0.01, 0, 0}}, PerParticle3::Zero(3, 3)};
  const StretchSprings springs{{{1, 2, 1.0, 30.0, 0.0}}};
  system.forces.emplace_back(springs);
  const double of_springs = elastic_limit(system, s);
  CHECK(widened_limit(system, s, 0.001) == 0.001);  // nothing sticks

  StickyPatch patch;
  patch.triangles = {{0, 1, 2}};
  patch.place = [](double) { return PerParticle3{{-1, 1, 0}, {-1, -1, 2}, {0, 0, 0}}; };
  patch.velocity = [](double) { return PerParticle3(PerParticle3::Zero(3, 3)); };
  patch.particles = {0};
  patch.stiffness = 1e7;
  patch.near = patch.far = 0.1;
  for (const double forecast : {0.2 * of_springs, 3 * of_springs}) {
    patch.forecast_time = forecast;
    system.forces = {springs, Sticking{{patch}}};
    begin_step(system, s);
    REQUIRE(s.bonds.size() == 1);
    const double wanted = std::min(of_springs, 2 * forecast);
    CHECK(elastic_limit(system, s) < 0.1 * wanted);
    CHECK(widened_limit(system, s, elastic_limit(system, s)) == Approx(wanted).epsilon(1e-14));
    CHECK(widened_limit(system, s, 7 * of_springs) == 7 * of_springs);
  }
}
