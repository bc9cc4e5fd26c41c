// What stops a run, where, and what it hands out then.
#include "reference/forces/degenerate.h"
#include "verification/tests/reference/dynamics/noted_run.h"

using namespace foldproof;
using namespace foldproof::noted_run;
using Catch::Matchers::Contains;

TEST_CASE("a run stops at its largest number of steps") {
  Schedule schedule = schedule_of(1.5, 0.4, 0.2);
  schedule.max_steps = 4;
  CHECK(steps_of(schedule).size() == 4);
  schedule.max_steps = 3;
  Seen seen;
  const RunResult result = run(masses(), drifting(1), start_state(), schedule, seen.observer());
  REQUIRE(result.stop);
  CHECK_THAT(result.stop->reason, Contains("cap on the number of steps"));
  CHECK(result.stop->step == 4);
  CHECK(result.stop->particle == -1);
  CHECK(result.stop->time == Approx(1.3));
  CHECK(result.steps == 3);
  CHECK(seen.frames.size() == 2);
  CHECK(seen.checkpoints.size() == 2);
}

TEST_CASE("a step that does not advance the time stops the run") {
  Seen seen;
  const RunResult result =
      run(masses(), drifting(1), start_state(), schedule_of(0.9, 0.9, 1e-30), seen.observer());
  REQUIRE(result.stop);
  CHECK_THAT(result.stop->reason, Contains("too short to advance the time"));
  CHECK(result.stop->time == 0.7);
  CHECK(result.stop->step == 1);
  CHECK(result.stop->particle == -1);
  CHECK(result.steps == 0);
  CHECK(seen.rows.size() == 1);
}

TEST_CASE("numbers that are not finite stop a run at the state before, with their particle") {
  for (const int particle : {0, 2, 3}) {
    for (const bool of_velocity : {false, true}) {
      for (const double value : {double(NAN), -infinite}) {
        next_state = [&](const State& now) {
          State next = now;
          if (now.time > 0.75) (of_velocity ? next.v : next.x)(1, particle) = value;
          return next;
        };
        Seen seen;
        const RunResult result =
            run(masses(), choosing, start_state(), schedule_of(0.9, 0.9, 0.1), seen.observer());
        REQUIRE(result.stop);
        CHECK_THAT(result.stop->reason, Contains("NaN or infinite"));
        CHECK(result.stop->particle == particle);
        CHECK(result.stop->step == 2);
        CHECK(result.stop->time == Approx(0.8));
        CHECK(result.steps == 1);
        CHECK(result.last.time == result.stop->time);
        CHECK(seen.rows.size() == 2);
        CHECK(seen.frames.size() == 1);
      }
    }
  }
}

TEST_CASE("a particle that moves more than ten times the cloth's size stops the run") {
  // the cloth is 2 m, 3 m and 6 m long: 7 m
  const auto stopped = [](const std::vector<double>& moves) {
    next_state = [&](const State& now) {
      State next = now;
      for (int i = 0; i < 4; ++i) next.x.col(i) += moves[size_t(i)] * Vector3(2, -6, 3) / 7;
      return next;
    };
    return run(masses(), choosing, start_state(), schedule_of(0.9, 0.9, 1), {}).stop;
  };
  CHECK_FALSE(stopped({-1, 69.999, 20, 69.9}));
  CHECK(stopped({70.001, 3, 4, 5})->particle == 0);
  CHECK(stopped({71, 3, -73, 72})->particle == 2);
  const auto last = stopped({1, 71, 3, 72});
  REQUIRE(last);
  CHECK(last->particle == 3);
  CHECK(last->time == 0.7);
  CHECK(last->step == 1);
  CHECK_THAT(last->reason, Contains("divergence"));
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
  const RunResult result =
      run(system, drifting(1), start, schedule_of(0.9, 0.1, 0.1), seen.observer());
  REQUIRE(result.stop);
  CHECK_THAT(result.stop->reason, Contains("a spring has no length"));
  CHECK(result.stop->particle == 2);
  CHECK(result.stop->step == 0);
  CHECK(result.stop->time == 0.7);
  CHECK(result.steps == 0);
  CHECK(seen.frames.size() == 1);
  CHECK(seen.rows.empty());
  CHECK(seen.checkpoints.empty());

  // without rows no limit is asked for where the step is fixed; an automatic one asks
  CHECK_FALSE(run(system, drifting(1), start, schedule_of(0.9, 0.1, 0.1), {}).stop);
  const RunResult automatic = run(system, drifting(1), start, schedule_of(0.9, 0.1, 0), {});
  REQUIRE(automatic.stop);
  CHECK(automatic.stop->particle == 2);
  CHECK(automatic.stop->step == 1);
  CHECK(automatic.stop->time == 0.7);
}

TEST_CASE("a step that meets a degenerate element stops the run there") {
  next_state = [](const State& now) {
    if (now.time > 0.75) throw DegenerateElement("flat", {3, 1});
    return now;
  };
  const RunResult result = run(masses(), choosing, start_state(), schedule_of(0.9, 0.9, 0.1), {});
  REQUIRE(result.stop);
  CHECK(result.stop->particle == 3);
  CHECK(result.stop->step == 2);
  CHECK(result.stop->time == Approx(0.8));
  CHECK(result.steps == 1);
}
