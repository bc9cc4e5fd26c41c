// The length of a step: limits that are no number, and where events end it.
#include "reference/forces/degenerate.h"
#include "verification/tests/reference/dynamics/noted_run.h"

using namespace foldproof;
using namespace foldproof::noted_run;

namespace {

double step_of(const System& system, Family family, const StepRule& rule, double limit) {
  const State s = start_state();
  return allowed_step(system, drifting(1, family), {&s, 1}, rule, limit);
}

}  // namespace

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
