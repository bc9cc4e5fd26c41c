// Runs: schedules and checkpoints, several at once, the length of a step, and how they stop.
#include <algorithm>
#include <catch2/catch.hpp>
#include <thread>

#include "verification/specimens/followed_runs.h"
#include "verification/tests/reference/dynamics/noted_run.h"

using namespace foldproof::noted_run;
using namespace foldproof;

using Catch::Matchers::Contains;

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

TEST_CASE("a single particle, of no size, may rest") {
  const State one{0.7, Vector3(0.3, 0.2, 0.9), Vector3::Zero()};
  const System system = make_system((PerParticle(1) << 0.4).finished());
  CHECK_FALSE(run(system, drifting(1), one, schedule_of(0.9, 0.9, 0.1), {}).stop);
}
