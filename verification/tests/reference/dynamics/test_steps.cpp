// The length of a step: what limits it, how it may grow, and where events end it.
#include "reference/forces/degenerate.h"
#include "verification/tests/reference/dynamics/noted_run.h"

using namespace foldproof;
using namespace foldproof::noted_run;

namespace {

double step_of(const System& system, Family family, const StepRule& rule, double limit) {
  const State s = start_state();
  return allowed_step(system, drifting(1, family), {&s, 1}, rule, limit);
}

/// The largest rate at which a spring's length changes, over its rest length [1/s].
double fastest_of(const Elements<Spring>& springs) {
  double fastest = 0;
  for (const Spring& spring : springs) {
    const State s = start_state();
    const Vector3 d = s.x.col(spring.b) - s.x.col(spring.a),
                  dv = s.v.col(spring.b) - s.v.col(spring.a);
    const double dt = 1e-6, change = (d + dt * dv).norm() - (d - dt * dv).norm();
    fastest = std::max(fastest, std::abs(change) / (2 * dt) / spring.rest_length);
  }
  return fastest;
}

// of each list of springs another one changes fastest, relative to its rest length
const Elements<Spring> changing{{0, 1, 3, 1, 0}, {1, 2, 0.7, 1, 0}, {2, 0, 2, 1, 0}};

}  // namespace

TEST_CASE("an automatic step is a part of the limit, and less where lengths change fast") {
  System system = masses();
  StepRule rule{0, 0.7, 0.03};
  const auto allowed = [&](double limit) { return step_of(system, Family::mixed, rule, limit); };
  CHECK(allowed(0.02) == Approx(0.7 * 0.02).epsilon(1e-14));
  CHECK(allowed(infinite) == infinite);

  const std::vector<Elements<Spring>> lists{
      {changing[0], changing[1]}, {changing[1], changing[0]}, {changing[2]}};
  for (const auto& list : lists) {
    system.forces = {CustomForce{}, StretchSprings{list}, CustomForce{}};
    CHECK(allowed(infinite) == Approx(0.03 / fastest_of(list)).epsilon(1e-8));
    CHECK(allowed(1e-4) == Approx(0.7e-4).epsilon(1e-14));
  }
  system.forces = {StretchSprings{{changing[1]}}, StretchSprings{{changing[2]}}};
  for (int order = 0; order < 2; ++order) {
    CHECK(allowed(infinite) == Approx(0.03 / fastest_of({changing[1], changing[2]})).epsilon(1e-8));
    std::swap(system.forces[0], system.forces[1]);
  }
  State still = start_state();
  still.v.setZero();
  CHECK(allowed_step(system, drifting(1), {&still, 1}, rule, infinite) == infinite);
  rule.fixed = 7;
  CHECK(allowed(infinite) == 7);
}

TEST_CASE("damping limits the steps of explicit methods alone") {
  System system = masses();
  system.forces = {StretchSprings{{{0, 2, 1e9, 0, 0.6}}}};
  // rows of 2 c over the masses; the lighter end is the faster
  const double limit = 2 / (2 * 0.6 / 0.4);
  const auto allowed = [&](Family family, double elastic) {
    return step_of(system, family, {0, 0.7}, elastic);
  };
  CHECK(allowed(Family::fully_explicit, infinite) == Approx(0.7 * limit).epsilon(1e-14));
  CHECK(allowed(Family::fully_explicit, 0.1) == Approx(0.07).epsilon(1e-14));
  CHECK(allowed(Family::fully_explicit, 1.1 * limit) == Approx(0.7 * limit).epsilon(1e-14));
  CHECK(allowed(Family::mixed, 9) == Approx(6.3).epsilon(1e-14));
  CHECK(allowed(Family::fully_implicit, 9) == Approx(6.3).epsilon(1e-14));
  prescribe(system, {0, start_state().x.col(0), {}});
  CHECK(allowed(Family::fully_explicit, infinite) ==
        Approx(0.7 * 2 / (2 * 0.6 / 0.9)).epsilon(1e-14));
}

TEST_CASE("a limit that is not a number is reported, of elasticity or of damping") {
  System system = masses();
  const auto refused = [&](Family family, double limit) {
    CHECK_THROWS_WITH(step_of(system, family, {}, limit), Catch::Contains("not a number"));
  };
  refused(Family::mixed, NAN);
  system.forces = {StretchSprings{{{0, 2, 1e9, 0, infinite}}}};
  CHECK(step_of(system, Family::mixed, {}, 0.2) == Approx(0.1));
  CHECK(step_of(system, Family::fully_explicit, {}, 0.2) == 0);
  system.forces = {StretchSprings{{{0, 2, 1e9, 0, NAN}}}};
  refused(Family::fully_explicit, 0.2);
}

namespace {

/// Steps of 0.1 s from 0.7 s, a frame every 0.4 s, with an event at each of the times.
Seen run_with_events(const std::vector<double>& times) {
  System system = masses();
  State start = start_state();
  for (size_t k = 0; k < times.size(); ++k) {
    Motion motion;
    motion.from = times[k];
    motion.velocity = {0.5, 0.25, -2};
    prescribe(system, {int(k), start.x.col(int(k)), motion});
    start.v.col(int(k)).setZero();
  }
  Seen seen;
  CHECK_FALSE(run(system, drifting(3), start, schedule_of(1.5, 0.4, 0.1), seen.observer()).stop);
  REQUIRE(seen.frames.size() == 3);
  CHECK(seen.frames[1].time == 0.7 + 0.4);
  CHECK(seen.frames[2].time == 1.5);
  return seen;
}

}  // namespace

TEST_CASE("events closer than a thousand-millionth of the interval are one") {
  run_with_events({0.95, 0.95 + 3e-10});
  CHECK(steps_taken.size() == 9);
  run_with_events({0.95, 0.95 + 1.5e-9});
  CHECK(steps_taken.size() == 10);
}

TEST_CASE("events next to a frame are passed at it, others have a step of their own") {
  // closer than a thousand-millionth of the interval of 0.4 s
  for (const double near : {0.7 + 0.4 - 3e-10, 0.7 + 0.4, 0.7 + 0.4 + 3e-10}) {
    const Seen seen = run_with_events({near});
    CHECK(steps_taken.size() == 8);
    CHECK(history_seen == std::vector<size_t>{1, 2, 3, 3, 1, 2, 3, 3});
    CHECK(seen.frames[1].v.col(0) == Vector3(0.5, 0.25, -2));
    CHECK(seen.checkpoints[1].past.size() == 1);
    CHECK(seen.checkpoints[1].event_time == 0.7 + 0.4);
  }
  for (const double apart : {0.7 + 0.4 - 6e-10, 0.7 + 0.4 + 6e-10}) {
    const Seen seen = run_with_events({apart});
    CHECK(steps_taken.size() == 9);
    CHECK(seen.frames[1].v.col(0).isZero() == (apart > 1.1));
  }
}
