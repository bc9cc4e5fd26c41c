// The length of a step: what limits it, how it may grow, and where events end it.
#include <catch2/catch.hpp>

#include "reference/dynamics/simulate.h"
#include "reference/forces/degenerate.h"

using namespace foldproof;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

std::vector<double> steps_taken;
std::vector<size_t> history_seen;

State drift(const System& system, std::span<const State> past, double h, Work&) {
  steps_taken.push_back(h);
  history_seen.push_back(past.size());
  State next = past.back();
  next.time += h;
  next.x += h * next.v;
  impose(velocities_at(system.prescribed, next.time), next.v);
  return next;
}

Integrator drifting(Family family) { return {"", "", "", 1, 3, drift, family}; }

System masses() { return make_system((PerParticle(3) << 0.4, 0.7, 0.9).finished()); }

State start_state() {
  State s;
  s.time = 0.7;
  s.x = (PerParticle3(3, 3) << 0.5, 2.5, 0.7, -1, 0.4, 2, 0.3, -2.2, 1.4).finished();
  s.v = (PerParticle3(3, 3) << 0.2, -0.1, 0.3, 0.1, 0.5, -0.2, 0.6, 0.2, 0.1).finished();
  return s;
}

double step_of(const System& system, const Integrator& integrator, const State& s,
               const StepRule& rule, double limit) {
  return allowed_step(system, integrator, {&s, 1}, rule, limit);
}

/// The rate at which a spring's length changes, over its rest length [1/s].
double strain_rate(const State& s, const Spring& spring) {
  const double dt = 1e-6;
  const auto length = [&](double t) {
    return (s.x.col(spring.b) + t * s.v.col(spring.b) - s.x.col(spring.a) - t * s.v.col(spring.a))
        .norm();
  };
  return std::abs(length(dt) - length(-dt)) / (2 * dt) / spring.rest_length;
}

}  // namespace

TEST_CASE("a step grows from the one before by the method's factor at most") {
  Integrator integrator = drifting(Family::mixed);
  integrator.largest_growth = 1.5;
  State latest = start_state(), before = latest, first = latest;
  before.time -= 0.2;
  first.time -= 0.9;
  const std::vector<State> past{first, before, latest};
  StepRule rule;
  rule.fixed = 0.45;
  const auto allowed = [&](size_t states) {
    return allowed_step(masses(), integrator, std::span(past).last(states), rule, NAN);
  };
  CHECK(allowed(1) == 0.45);
  CHECK(allowed(2) == Approx(0.3).epsilon(1e-14));
  CHECK(allowed(3) == Approx(0.3).epsilon(1e-14));
  rule.fixed = 0.25;
  CHECK(allowed(3) == 0.25);
}

TEST_CASE("an automatic step is a part of the limit, and less where lengths change fast") {
  System system = masses();
  const State s = start_state();
  StepRule rule;
  rule.safety = 0.7;
  rule.strain_per_step = 0.03;
  const Integrator integrator = drifting(Family::mixed);
  CHECK(step_of(system, integrator, s, rule, 0.02) == Approx(0.7 * 0.02).epsilon(1e-14));
  CHECK(step_of(system, integrator, s, rule, infinite) == infinite);

  // of each list of springs another one changes fastest, relative to its rest length
  const Elements<Spring> springs{{0, 1, 3, 1, 0}, {1, 2, 0.7, 1, 0}, {2, 0, 2, 1, 0}};
  const std::vector<Elements<Spring>> lists{
      {springs[0], springs[1]}, {springs[1], springs[0]}, {springs[2]}};
  for (const auto& list : lists) {
    double fastest = 0;
    for (const Spring& spring : list) fastest = std::max(fastest, strain_rate(s, spring));
    system.forces = {CustomForce{}, StretchSprings{list}, CustomForce{}};
    CHECK(step_of(system, integrator, s, rule, infinite) == Approx(0.03 / fastest).epsilon(1e-8));
    CHECK(step_of(system, integrator, s, rule, 1e-4) == Approx(0.7e-4).epsilon(1e-14));
  }
  system.forces = {StretchSprings{{springs[1]}}, StretchSprings{{springs[2]}}};
  const double fastest = std::max(strain_rate(s, springs[1]), strain_rate(s, springs[2]));
  CHECK(step_of(system, integrator, s, rule, infinite) == Approx(0.03 / fastest).epsilon(1e-8));
  std::swap(system.forces[0], system.forces[1]);
  CHECK(step_of(system, integrator, s, rule, infinite) == Approx(0.03 / fastest).epsilon(1e-8));
  rule.fixed = 7;
  CHECK(step_of(system, integrator, s, rule, infinite) == 7);
  rule.fixed = 0;
  State still = s;
  still.v.setZero();
  CHECK(step_of(system, integrator, still, rule, infinite) == infinite);
}

TEST_CASE("threads find the fastest spring, wherever it is in the list") {
  System system = masses();
  const State s = start_state();
  const Elements<Spring> springs{
      {0, 1, 3, 1, 0}, {1, 2, 0.7, 1, 0}, {2, 0, 2, 1, 0}, {0, 2, 5, 1, 0}};
  double fastest = 0;
  for (const Spring& spring : springs) fastest = std::max(fastest, strain_rate(s, spring));
  for (int turn = 0; turn < 4; ++turn) {
    Elements<Spring> turned = springs;
    std::rotate(turned.begin(), turned.begin() + turn, turned.end());
    for (const int threads : {1, 2, 3}) {
      system.forces = {StretchSprings{turned}};
      set_team(system, threads);
      StepRule rule;
      CHECK(step_of(system, drifting(Family::mixed), s, rule, infinite) ==
            Approx(0.1 / fastest).epsilon(1e-8));
    }
  }
}

TEST_CASE("damping limits the steps of explicit methods alone") {
  System system = masses();
  const State s = start_state();
  system.forces = {StretchSprings{{{0, 2, 1e9, 0, 0.6}}}};
  StepRule rule;
  rule.safety = 0.7;
  // rows of 2 c over the masses; the lighter end is the faster
  const double limit = 2 / (2 * 0.6 / 0.4);
  const auto allowed = [&](Family family, double elastic) {
    return step_of(system, drifting(family), s, rule, elastic);
  };
  CHECK(allowed(Family::fully_explicit, infinite) == Approx(0.7 * limit).epsilon(1e-14));
  CHECK(allowed(Family::fully_explicit, 0.1) == Approx(0.07).epsilon(1e-14));
  CHECK(allowed(Family::fully_explicit, 1.1 * limit) == Approx(0.7 * limit).epsilon(1e-14));
  CHECK(allowed(Family::mixed, 9) == Approx(6.3).epsilon(1e-14));
  CHECK(allowed(Family::fully_implicit, 9) == Approx(6.3).epsilon(1e-14));
  prescribe(system, {0, s.x.col(0), {}});
  CHECK(allowed(Family::fully_explicit, infinite) ==
        Approx(0.7 * 2 / (2 * 0.6 / 0.9)).epsilon(1e-14));
}

TEST_CASE("a limit that is not a number is reported, whichever it is") {
  System system = masses();
  const State s = start_state();
  const auto refused = [&](Family family, double limit) {
    try {
      step_of(system, drifting(family), s, {}, limit);
      FAIL("a step without a limit");
    } catch (const DegenerateElement& error) {
      CHECK(error.particles == std::vector<int>{-1});
      CHECK_THAT(error.what(), Catch::Contains("the elastic limit of the step is not a number"));
    }
  };
  refused(Family::mixed, NAN);
  system.forces = {StretchSprings{{{0, 2, 1e9, 0, infinite}}}};
  CHECK(step_of(system, drifting(Family::mixed), s, {}, 0.2) == Approx(0.1));
  const double bound = step_of(system, drifting(Family::fully_explicit), s, {}, 0.2);
  CHECK(bound == 0);
  system.forces = {StretchSprings{{{0, 2, 1e9, 0, NAN}}}};
  refused(Family::fully_explicit, 0.2);
}

TEST_CASE("only a method that damping widens takes the longer steps of sticking that forecasts") {
  System system = masses();
  State s = start_state();
  StickyPatch patch;
  patch.triangles = {{0, 1, 2}};
  patch.place = [](double) {
    return (PerParticle3(3, 3) << -1, 1, 0, -1, -1, 2, 0, 0, 0).finished();
  };
  patch.velocity = [](double) { return PerParticle3(PerParticle3::Zero(3, 3)); };
  patch.particles = {0};
  patch.stiffness = 1e7;
  patch.near = patch.far = 0.1;
  patch.forecast_time = 0.04;
  s.x.col(0) = Vector3(0, 0, 0.01);
  system.forces = {Sticking{{patch}}};
  begin_step(system, s);
  REQUIRE(s.bonds.size() == 1);
  StepRule rule;
  rule.safety = 0.9;
  Integrator integrator = drifting(Family::mixed);
  CHECK(step_of(system, integrator, s, rule, 1e-4) == Approx(0.9e-4).epsilon(1e-14));
  integrator.damping_widens_limit = true;
  CHECK(step_of(system, integrator, s, rule, 1e-4) == Approx(0.9 * 0.08).epsilon(1e-14));

  // bonds form at the start of each step
  s.bonds.clear();
  Schedule schedule;
  schedule.end = schedule.frame_interval = 0.8;
  schedule.step.fixed = 1;
  const RunResult result = simulate(system, integrator, s, schedule, {});
  CHECK(result.last.bonds.size() == 1);
  CHECK(result.work.bonds == 1);
}

namespace {

Motion motion_from(double from) {
  Motion motion;
  motion.from = from;
  motion.velocity = {0.5, 0.25, -2};
  return motion;
}

struct EventRun {
  std::vector<double> steps;
  std::vector<size_t> history;
  std::vector<State> frames;
  std::vector<Checkpoint> checkpoints;
};

/// Steps of 0.1 s from 0.7 s, a frame every 0.4 s, with an event at each of the times.
EventRun run_with_events(const std::vector<double>& times) {
  System system = masses();
  for (size_t k = 0; k < times.size(); ++k)
    prescribe(system, {int(k), start_state().x.col(int(k)), motion_from(times[k])});
  State start = start_state();
  start.v.leftCols(int(times.size())).setZero();
  Schedule schedule;
  schedule.end = 1.5;
  schedule.frame_interval = 0.4;
  schedule.step.fixed = 0.1;
  EventRun run;
  steps_taken.clear();
  history_seen.clear();
  const RunResult result = simulate(system, drifting(Family::mixed), start, schedule,
                                    {[&](const State& s) { run.frames.push_back(s); },
                                     {},
                                     [&](const Checkpoint& c) { run.checkpoints.push_back(c); }});
  CHECK_FALSE(result.stop);
  run.steps = steps_taken;
  run.history = history_seen;
  REQUIRE(run.frames.size() == 3);
  CHECK(run.frames[1].time == 0.7 + 0.4);
  CHECK(run.frames[2].time == 1.5);
  return run;
}

}  // namespace

TEST_CASE("steps end at events, after which the history begins anew") {
  const EventRun run = run_with_events({0.95, 1.35});
  const std::vector<double> expected{0.25 / 3, 0.25 / 3, 0.25 / 3, 0.075, 0.075,
                                     0.25 / 3, 0.25 / 3, 0.25 / 3, 0.075, 0.075};
  REQUIRE(run.steps.size() == expected.size());
  for (size_t k = 0; k < expected.size(); ++k)
    CHECK(run.steps[k] == Approx(expected[k]).epsilon(1e-10));
  CHECK(run.history == std::vector<size_t>{1, 2, 3, 1, 2, 3, 3, 3, 1, 2});
  CHECK(run.frames[1].v.col(0) == Vector3(0.5, 0.25, -2));
  CHECK(run.frames[1].v.col(1) == Vector3::Zero());
  CHECK(run.frames[2].v.col(1) == Vector3(0.5, 0.25, -2));
  CHECK(run.checkpoints[0].event_time == 0.7);
  CHECK(run.checkpoints[1].event_time == 0.95);
  CHECK(run.checkpoints[2].event_time == 1.35);
  CHECK(run.checkpoints[1].past.size() == 3);
}

TEST_CASE("events closer than a thousand-millionth of the interval are one") {
  CHECK(run_with_events({0.95, 0.95 + 3e-10}).steps.size() == 9);
  CHECK(run_with_events({0.95, 0.95 + 1.5e-9}).steps.size() == 10);
}

TEST_CASE("events next to a frame are passed at it, others have a step of their own") {
  // closer than a thousand-millionth of the interval of 0.4 s
  for (const double near : {0.7 + 0.4 - 3e-10, 0.7 + 0.4, 0.7 + 0.4 + 3e-10}) {
    const EventRun run = run_with_events({near});
    CHECK(run.steps.size() == 8);
    CHECK(run.history == std::vector<size_t>{1, 2, 3, 3, 1, 2, 3, 3});
    CHECK(run.frames[1].v.col(0) == Vector3(0.5, 0.25, -2));
    CHECK(run.checkpoints[1].past.size() == 1);
    CHECK(run.checkpoints[1].event_time == 0.7 + 0.4);
  }
  for (const double apart : {0.7 + 0.4 - 6e-10, 0.7 + 0.4 + 6e-10}) {
    const EventRun run = run_with_events({apart});
    CHECK(run.steps.size() == 9);
    CHECK(run.frames[1].v.col(0).isZero() == (apart > 1.1));
  }
}
