// Systems, the table of integrators, histories and events.
#include <catch2/catch.hpp>

#include "reference/dynamics/system.h"
#include "reference/dynamics/events.h"
#include "reference/dynamics/explicit.h"
#include "reference/dynamics/implicit.h"
#include "reference/dynamics/integrator.h"
#include "reference/dynamics/mixed.h"

using namespace foldproof;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using Catch::Matchers::Equals;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

PerParticle three_masses() { return (PerParticle(3) << 0.4, 0.7, 0.9).finished(); }

State three_particles() {
  State s;
  s.time = 0.6;
  s.x = (PerParticle3(3, 3) << 0.3, 1.7, -0.4, 0.8, -0.6, 2.3, 1.1, 0.9, -1.3).finished();
  s.v = (PerParticle3(3, 3) << 1.2, -0.7, 0.5, 2.1, 0.4, -1.6, -0.9, 3.1, 0.2).finished();
  return s;
}

}  // namespace

TEST_CASE("a system's masses are positive and finite, or the first other one is named") {
  const System system = make_system(three_masses());
  CHECK(system.mass == three_masses());
  CHECK((system.inverse_mass - PerParticle(three_masses().cwiseInverse())).norm() < 1e-15);
  CHECK(system.forces.empty());
  CHECK(system.prescribed.empty());
  for (const double wrong : {0.0, -0.3, infinite, double(NAN)}) {
    for (int i = 0; i < 3; ++i) {
      PerParticle mass = three_masses();
      mass[i] = wrong;
      CHECK_THROWS_WITH(make_system(mass), Equals("particle " + std::to_string(i) + " has mass " +
                                                  std::to_string(wrong) + " kg; it must be > 0"));
    }
  }
  CHECK(make_system((PerParticle(1) << 1e-300).finished()).mass[0] == 1e-300);
}

TEST_CASE("a team is given to the system, its forces and filters; it has at least one thread") {
  System system = make_system(three_masses());
  system.forces.emplace_back(CustomForce{});
  system.forces.emplace_back(Gravity{{0, -9, 0}, three_masses()});
  system.filters.emplace_back(CustomFilter{});
  system.filters.emplace_back(ObjectCollision{});
  for (const int threads : {4, 1}) {
    set_team(system, threads);
    CHECK(system.team.threads() == threads);
    CHECK(std::get<Gravity>(system.forces[1]).team.threads() == threads);
    CHECK(std::get<ObjectCollision>(system.filters[1]).team.threads() == threads);
  }
  for (const int threads : {0, -3})
    CHECK_THROWS_WITH(set_team(system, threads), Contains("at least one thread"));
}

TEST_CASE("a particle's motion is prescribed once, and only if there is the particle") {
  System system = make_system(three_masses());
  CHECK_THROWS_WITH(prescribe(system, {-1, {}, {}}),
                    Equals("cannot prescribe the motion of particle -1: there are 3"));
  CHECK_THROWS_WITH(prescribe(system, {3, {}, {}}),
                    Equals("cannot prescribe the motion of particle 3: there are 3"));
  CHECK(system.prescribed.empty());
  prescribe(system, {2, {1, 2, 3}, {}});
  CHECK(system.inverse_mass[2] == 0);
  CHECK(system.inverse_mass[0] == 1 / 0.4);
  CHECK(system.mass == three_masses());
  prescribe(system, {0, {4, 5, 6}, {}});
  CHECK(system.inverse_mass[0] == 0);
  CHECK(system.inverse_mass[1] == 1 / 0.7);
  REQUIRE(system.prescribed.size() == 2);
  CHECK(system.prescribed[1].start == Vector3(4, 5, 6));
  CHECK_THROWS_WITH(prescribe(system, {2, {}, {}}),
                    Equals("the motion of particle 2 is prescribed twice"));
  CHECK(system.prescribed.size() == 2);
}

TEST_CASE("the elastic limit is twice the inverse of the bound on the frequency") {
  System system = make_system(three_masses());
  const State s = three_particles();
  CHECK(elastic_limit(system, s) == infinite);
  const double length = (s.x.col(1) - s.x.col(0)).norm();
  system.forces.emplace_back(StretchSprings{{{0, 1, length, 30, 0}}});
  // the row sum of either end is twice the rate; the lighter end counts
  CHECK(elastic_limit(system, s) == Approx(2 / std::sqrt(2 * 30 / 0.4)).epsilon(1e-14));
  prescribe(system, {0, s.x.col(0), {}});
  CHECK(elastic_limit(system, s) == Approx(2 / std::sqrt(2 * 30 / 0.7)).epsilon(1e-14));
}

TEST_CASE("energies and momenta are sums over particles, prescribed ones too") {
  System system = make_system(three_masses());
  const State s = three_particles();
  const auto energy = [](double joule) {
    CustomForce force;
    force.potential = [joule](const State& at) { return joule * at.time; };
    return force;
  };
  system.forces.emplace_back(energy(5));
  system.forces.emplace_back(Gravity{{0.3, -9, 0.2}, three_masses()});
  system.forces.emplace_back(energy(7));
  prescribe(system, {1, s.x.col(1), {}});
  double kinetic = 0, gravity = 0;
  Vector3 linear = Vector3::Zero(), angular = Vector3::Zero();
  for (int i = 0; i < 3; ++i) {
    const double m = system.mass[i];
    const Vector3 x = s.x.col(i), v = s.v.col(i);
    kinetic += m * v.dot(v) / 2;
    gravity -= m * x.dot(Vector3(0.3, -9, 0.2));
    linear += m * v;
    angular += m * Vector3(x.y() * v.z() - x.z() * v.y(), x.z() * v.x() - x.x() * v.z(),
                           x.x() * v.y() - x.y() * v.x());
  }
  const Energies e = energies(system, s);
  CHECK(e.kinetic == Approx(kinetic).epsilon(1e-14));
  CHECK(e.gravity == Approx(gravity).epsilon(1e-14));
  CHECK(e.custom == Approx(12 * 0.6).epsilon(1e-14));
  CHECK(e.stretch == 0);
  CHECK((linear_momentum(system, s) - linear).norm() < 1e-14);
  CHECK((angular_momentum(system, s) - angular).norm() < 1e-14);
}

TEST_CASE("the table's rows say each method's order, history, family and limits") {
  struct Row {
    const char* name;
    int order, history;
    decltype(Integrator::step) step;
    Family family;
  };
  using enum Family;
  const std::vector<Row> rows{
      {"A", 2, 1, mixed_explicit_implicit, mixed},
      {"B", 2, 1, central_newmark, mixed},
      {"C", 2, 1, variable_step_newmark, mixed},
      {"forward-euler", 1, 1, forward_euler, fully_explicit},
      {"RK2", 2, 1, explicit_midpoint, fully_explicit},
      {"SSP-RK3", 3, 1, ssp_runge_kutta_3, fully_explicit},
      {"RK4", 4, 1, runge_kutta_4, fully_explicit},
      {"backward-euler", 1, 1, backward_euler, fully_implicit},
      {"linear-backward-euler", 1, 1, linearised_backward_euler, fully_implicit},
      {"BDF2", 2, 2, bdf2, fully_implicit},
      {"implicit-midpoint", 2, 1, implicit_midpoint, fully_implicit},
  };
  REQUIRE(integrators().size() == rows.size());
  std::string known;
  for (size_t k = 0; k < rows.size(); ++k) {
    const Integrator& found = integrator_named(rows[k].name);
    INFO(rows[k].name);
    CHECK(&found == &integrators()[k]);
    CHECK(found.order == rows[k].order);
    CHECK(found.history == rows[k].history);
    CHECK(found.step == rows[k].step);
    CHECK(found.family == rows[k].family);
    CHECK(found.damping_widens_limit == (found.name == "C"));
    // BDF2 is stable up to 1 + sqrt(2)
    CHECK(found.largest_growth == (found.name == "BDF2" ? 2.4 : infinite));
    known += (k > 0 ? ", " : "") + std::string(rows[k].name);
  }
  CHECK_THROWS_WITH(integrator_named("a"), Equals("unknown integrator 'a'; known: " + known));
  const std::vector<Integrator> schemes = paper_schemes();
  REQUIRE(schemes.size() == 3);
  CHECK(schemes[0].name == "A");
  CHECK(schemes[2].name == "C");
}

TEST_CASE("a method that says nothing else is mixed, grows freely and has no wider limit") {
  const Integrator integrator{"", "", "", 1, 1, forward_euler};
  CHECK(integrator.family == Family::mixed);
  CHECK(integrator.largest_growth == infinite);
  CHECK_FALSE(integrator.damping_widens_limit);
}

TEST_CASE("a history keeps the latest states, as many as its method uses") {
  const auto at = [](double time) {
    State s;
    s.time = time;
    return s;
  };
  for (const size_t length : {1, 2, 3}) {
    History history(at(0.5), int(length));
    for (int k = 1; k < 6; ++k) {
      history.advance(at(0.5 + k));
      REQUIRE(history.past().size() == std::min<size_t>(length, size_t(k) + 1));
      CHECK(history.now().time == 0.5 + k);
      CHECK(history.past().front().time == 1.5 + k - double(history.past().size()));
    }
    History later(history.past(), int(length));
    later.advance(at(9));
    CHECK(later.past().size() == length);
  }
}

namespace {

RigidObject moving(const RigidMotion& motion) { return {{}, {}, motion}; }

Motion between(double from, double until) {
  Motion motion;
  motion.from = from, motion.until = until;
  motion.velocity = {0.5, 0.25, -2};
  return motion;
}

std::vector<double> sorted(std::vector<double> times) {
  std::sort(times.begin(), times.end());
  return times;
}

System system_of_events() {
  System system = make_system(three_masses());
  system.forces.emplace_back(CustomForce{});
  StickyPatch first, second;
  first.from = 0.35, first.until = 0.95, first.release = 0.25;
  second.from = 0.45;
  system.forces.emplace_back(Sticking{{first, second}});
  system.filters.emplace_back(CustomFilter{});
  const auto body = std::make_shared<DeformingBody>();
  for (const double time : {0.15, 0.55, 0.85}) {
    body->frames.emplace_back();
    body->frames.back().time = time;
  }
  ObjectCollision one, other;
  one.objects = {{"a", moving(between(0.2, 0.6))}, {"b", DeformingObject{body}}};
  other.objects = {{"c", moving(make_keyframes({{0.3, {}}, {0.5, {}}, {0.75, {}}}))},
                   {"d", moving(between(-infinite, infinite))}};
  system.filters.emplace_back(one);
  system.filters.emplace_back(other);
  return system;
}

}  // namespace

TEST_CASE("objects have events where their motions start, stop or pass a frame") {
  const System system = system_of_events();
  CHECK(sorted(object_event_times(system, 0.1)) ==
        std::vector<double>{0.15, 0.2, 0.3, 0.5, 0.55, 0.6, 0.75, 0.85});
  CHECK(sorted(object_event_times(system, 0.55)) == std::vector<double>{0.6, 0.75, 0.85});
}

TEST_CASE("sticky patches have events where they start, begin their release and end") {
  const System system = system_of_events();
  CHECK(sorted(sticking_event_times(system, 0.1)) ==
        std::vector<double>{0.35, 0.45, 0.95 - 0.25, 0.95});
  CHECK(sorted(sticking_event_times(system, 0.45)) == std::vector<double>{0.95 - 0.25, 0.95});
}

TEST_CASE("events are passed in order, those close together at once") {
  System system = system_of_events();
  Events events(system, 0.51, 0.02);
  CHECK(events.last() == 0.51);
  CHECK(&events.system() == &system);
  std::vector<double> passed;
  State s = three_particles();
  while (events.next() < infinite) {
    s.time = events.next();
    passed.push_back(s.time);
    CHECK(events.pass_events(s).v == s.v);
    CHECK(events.last() == s.time);
  }
  CHECK(passed == std::vector<double>{0.55, 0.6, 0.95 - 0.25, 0.75, 0.85, 0.95});

  Events wide(system, 0.51, 0.05);  // 0.55 and 0.6, 0.7 and 0.75 are one
  s.time = wide.next();
  wide.pass_events(s);
  s.time = wide.next();
  CHECK(s.time == 0.95 - 0.25);
  wide.pass_events(s);
  CHECK(wide.next() == 0.85);
  CHECK(Events(make_system(three_masses()), 0.3, 0.1).next() == infinite);
}

TEST_CASE("an event exactly a tolerance later counts as passed") {
  System system = make_system(three_masses());
  ObjectCollision collision;
  collision.objects = {{"a", moving(between(0.5, 0.75))}};
  system.filters.emplace_back(collision);
  State s = three_particles();
  s.time = 0.5;
  Events events(system, 0.25, 0.25);
  events.pass_events(s);
  CHECK(events.next() == infinite);
  Events closer(system, 0.25, 0.2499);
  closer.pass_events(s);
  CHECK(closer.next() == 0.75);
}

TEST_CASE(
    "between events prescribed motions go on as they began, and change where they are passed") {
  System system = make_system(three_masses());
  const Vector3 first(0.2, 0.4, 0.6), second(-0.3, 0.7, 1.1);
  prescribe(system, {2, first, between(0.5, 0.9)});
  prescribe(system, {0, second, between(0.2, 0.7)});
  Events events(system, 0.3, 1e-9);
  const System& own = events.system();
  CHECK(&own != &system);
  CHECK(events.next() == 0.5);
  const auto place = [](const System& in, size_t k, double t) {
    return position_at(in.prescribed[k].motion, in.prescribed[k].start, t);
  };
  const auto speed = [](const System& in, size_t k, double t) {
    return velocity_at(in.prescribed[k].motion, in.prescribed[k].start, t).norm();
  };
  const double v = Vector3(0.5, 0.25, -2).norm();
  CHECK(speed(own, 0, 0.6) == 0);
  CHECK(speed(own, 1, 0.8) == Approx(v));
  CHECK((place(own, 1, 0.4) - place(system, 1, 0.4)).norm() < 1e-15);

  State s = three_particles();
  s.time = 0.5;
  const State after = events.pass_events(s);
  CHECK(&events.system() == &own);
  CHECK(after.v.col(2) == Vector3(0.5, 0.25, -2));
  CHECK(after.v.col(0) == Vector3(0.5, 0.25, -2));
  CHECK(after.v.col(1) == s.v.col(1));
  CHECK(after.x == s.x);
  CHECK(events.next() == 0.7);
  CHECK(speed(own, 0, 0.6) == Approx(v));
  s.time = 0.7;
  CHECK(events.pass_events(s).v.col(0) == Vector3::Zero());
  CHECK(speed(own, 1, 0.71) == 0);
  CHECK((place(own, 1, 0.71) - place(system, 1, 0.71)).norm() < 1e-15);
  CHECK(events.next() == 0.9);

  // resumed after the event at 0.5, and before any
  const Events resumed(system, 0.3, 1e-9, 0.5), begun(system, 0.3, 1e-9, 0.3);
  CHECK(resumed.last() == 0.5);
  CHECK(resumed.next() == 0.7);
  CHECK(speed(resumed.system(), 0, 0.6) == Approx(v));
  CHECK(begun.last() == 0.3);
  CHECK(begun.next() == 0.5);
  CHECK(speed(begun.system(), 0, 0.6) == 0);
}

TEST_CASE("a run is begun without passing events close to its start") {
  System system = make_system(three_masses());
  prescribe(system, {1, Vector3::Zero(), between(0.31, 0.9)});
  const Events begun(system, 0.3, 0.02, 0.3);
  CHECK(begun.next() == 0.31);
  CHECK(begun.last() == 0.3);
}

TEST_CASE("sticking that forecasts allows steps of twice its time, if nothing else forbids them") {
  System system = make_system((PerParticle(3) << 0.5, 0.02, 0.3).finished());
  State s;
  s.x = PerParticle3(3, 3);
  s.x << 0, 1, 2, 0, 0, 0, 0.01, 0, 0;
  s.v = PerParticle3::Zero(3, 3);
  const StretchSprings springs{{{1, 2, 1.0, 30.0, 0.0}}};
  system.forces.emplace_back(springs);
  const double of_springs = elastic_limit(system, s);
  CHECK(widened_limit(system, s, 0.001) == 0.001);  // nothing sticks

  StickyPatch patch;
  patch.triangles = {{0, 1, 2}};
  patch.place = [](double) {
    return (PerParticle3(3, 3) << -1, 1, 0, -1, -1, 2, 0, 0, 0).finished();
  };
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
