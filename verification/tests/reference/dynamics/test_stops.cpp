// Stops of a run: where they happen, and what it hands out then.
#include "verification/tests/reference/dynamics/noted_run.h"

using namespace foldproof;
using namespace foldproof::noted_run;

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
