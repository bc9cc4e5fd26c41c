// Runs: schedules, steps, and where frames and steps end.
#include "verification/tests/reference/dynamics/noted_run.h"

using namespace foldproof;
using namespace foldproof::noted_run;
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
