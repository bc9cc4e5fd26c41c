// Runs: schedules and checkpoints, several at once, the length of a step, and how they stop.
#include <algorithm>
#include <catch2/catch.hpp>
#include <thread>

#include "reference/forces/degenerate.h"
#include "verification/specimens/followed_runs.h"
#include "verification/tests/reference/dynamics/noted_run.h"

using namespace foldproof::noted_run;
using namespace foldproof;

using Catch::Matchers::Contains;

TEST_CASE("a schedule that makes no sense is refused, by a run and by its resumption") {
  const System system = masses();
  const State start = start_state();
  Checkpoint later;
  later.past = {start, start};
  later.start_time = 0.2;
  const auto refused = [&](const Schedule& schedule, const char* why) {
    CHECK_THROWS_WITH(run(system, drifting(1), start, schedule, {}), Contains(why));
    CHECK_THROWS_WITH(resume(system, drifting(1), later, schedule, {}), Contains(why));
    CHECK(steps_taken.empty());
  };
  for (const double end : {std::nextafter(0.7, 0), 0.5, double(NAN)})
    refused(schedule_of(end, 0.3, 0.1), "the end");
  for (const double wrong : {0.0, -0.3, double(NAN)}) {
    refused(schedule_of(0.9, wrong, 0.1), "frame interval");
    refused({0.9, 0.3, {0.1, wrong}}, "safety factor");
    refused({0.9, 0.3, {0.1, 0.5, wrong}}, "strain_per_step");
    if (wrong != 0) refused(schedule_of(0.9, 0.3, wrong), "the step must be");
  }
  const RunResult none = run(system, drifting(1), start, {0.7, 0.2, {0.05, 0.03, 0.02}}, {});
  CHECK(none.steps == 0);  // small numbers, and no time at all
  CHECK_FALSE(none.stop);
}

TEST_CASE("a checkpoint without a latest state, or of other cloth, is refused") {
  State other = start_state();
  other.x.conservativeResize(3, 3);
  const auto resumed = [&](const std::vector<State>& past) {
    Checkpoint from;
    from.past = past;
    from.start_time = 0.7;
    from.size = 7;
    return resume(masses(), drifting(2), from, schedule_of(0.9, 0.3, 0.1), {}).steps;
  };
  CHECK_THROWS_WITH(resumed({}), Contains("without a state"));
  CHECK_THROWS_WITH(resumed({start_state(), other}), Contains("another number of particles"));
  CHECK(resumed({other, start_state()}) == 2);
}

TEST_CASE("no step is longer than wanted by more than a part in a thousand million") {
  const double third = 0.2 / 3;
  CHECK(steps_of(schedule_of(0.9, 0.9, third * (1 - 0.9e-9))).size() == 3);
  CHECK(steps_of(schedule_of(0.9, 0.9, third * (1 - 1.2e-9))).size() == 4);
  CHECK(steps_of(schedule_of(0.9, 0.9, 0.11)).size() == 2);
  expect_steps(steps_of(schedule_of(0.9, 0.9, 5)), {0.2});
  expect_steps(steps_of(schedule_of(0.9, 0.9, 0)), {0.2});  // nothing limits an automatic step
}

TEST_CASE("a frame that only rounding puts before the end is the end") {
  for (const double interval : {0.2, 0.2 * (1 - 3e-10)}) {  // 0.7 + 0.2 rounds to less than 0.9
    Seen seen;
    const RunResult result = run(masses(), drifting(1), start_state(),
                                 schedule_of(0.9, interval, 0.15), seen.observer());
    CHECK(result.steps == 2);
    CHECK(result.last.time == 0.9);
    CHECK(seen.frames.size() == 2);
  }
  CHECK(steps_of(schedule_of(0.9, 0.2 * (1 - 3e-9), 0.15)).size() == 3);
}

TEST_CASE("ends of steps that are prescribed are met, then the rule goes on") {
  Schedule schedule = schedule_of(1.5, 0.4, 0.25);
  schedule.step.ends = {0.3, 0.7, 0.73, 0.9, 1.3};  // the frame at 1.1 is not among them
  expect_steps(steps_of(schedule), {0.03, 0.17, 0.2, 0.2, 0.2});
  schedule.step.ends = {0.71};
  expect_steps(steps_of(schedule), {0.01, 0.195, 0.195, 0.2, 0.2});
}

TEST_CASE("two runs of one system at once have the bits of a run alone") {
  const std::vector<NamedRun> runs = runs_of_all_parts();
  for (const char* name : {"layers", "sticking"}) {
    const NamedRun& of = *std::ranges::find(runs, std::string(name), &NamedRun::name);
    System system = build_system(of.scene);
    set_team(system, 2);
    const auto run = [&] {
      return numbers_after(followed_run(of, system, integrator_named(of.integrator)), 0, 0, 0);
    };
    const Numbers alone = run();
    Numbers first, second;
    {
      const std::jthread one([&] { first = run(); }), other([&] { second = run(); });
    }
    for (const Numbers& numbers : {first, second}) CHECK(bits_that_differ(alone, numbers) == 0);
  }
}

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

namespace {

void expect_stop(const RunResult& result, const char* reason, long step, int particle,
                 double time) {
  REQUIRE(result.stop);
  CHECK_THAT(result.stop->reason, Catch::Contains(reason));
  CHECK(result.stop->step == step);
  CHECK(result.stop->particle == particle);
  CHECK(result.stop->time == Approx(time));
  CHECK(result.last.time == result.stop->time);
  CHECK(result.steps == std::max(step - 1, 0L));
}

}  // namespace

TEST_CASE("a particle that moves more than ten times the cloth's size stops the run") {
  // the cloth is 2 m, 3 m and 6 m long: 7 m
  const auto stopped = [](const std::vector<double>& moves) {
    next_state = [&](const State& now) {
      State next = now;
      for (int i = 0; i < 4; ++i) next.x.col(i) += moves[size_t(i)] * Vector3(2, -6, 3) / 7;
      return next;
    };
    return run(masses(), choosing, start_state(), schedule_of(0.9, 0.9, 1), {});
  };
  CHECK_FALSE(stopped({-1, 69.999, 20, 69.9}).stop);
  expect_stop(stopped({70.001, 3, 4, 5}), "divergence", 1, 0, 0.7);
  expect_stop(stopped({71, 3, -73, 72}), "divergence", 1, 2, 0.7);
  expect_stop(stopped({1, 71, 3, 72}), "divergence", 1, 3, 0.7);
}

TEST_CASE("a single particle, of no size, may rest") {
  const State one{0.7, Vector3(0.3, 0.2, 0.9), Vector3::Zero()};
  const System system = make_system((PerParticle(1) << 0.4).finished());
  CHECK_FALSE(run(system, drifting(1), one, schedule_of(0.9, 0.9, 0.1), {}).stop);
}

TEST_CASE("a degenerate start is handed out, then the run stops") {
  System system = masses();
  system.forces.emplace_back(StretchSprings{{{2, 1, 0.3, 5, 0.1}}});
  State start = start_state();
  start.x.col(1) = start.x.col(2);
  Seen seen;
  expect_stop(run(system, drifting(1), start, schedule_of(0.9, 0.1, 0.1), seen.observer()),
              "a spring has no length", 0, 2, 0.7);
  CHECK(seen.frames.size() == 1);
  CHECK(seen.rows.empty());
  CHECK(seen.checkpoints.empty());

  // without rows no limit is needed where the step is fixed, but an automatic one needs it
  CHECK_FALSE(run(system, drifting(1), start, schedule_of(0.9, 0.1, 0.1), {}).stop);
  expect_stop(run(system, drifting(1), start, schedule_of(0.9, 0.1, 0), {}), "no length", 1, 2,
              0.7);
}
