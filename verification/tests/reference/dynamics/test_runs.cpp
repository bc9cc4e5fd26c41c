// Runs: schedules, steps, rows and checkpoints.
#include "verification/tests/reference/dynamics/noted_run.h"

using namespace foldproof;
using namespace foldproof::noted_run;
using Catch::Matchers::Contains;

TEST_CASE("schedules, rows and checkpoints begin as their declarations say") {
  const Schedule schedule;
  CHECK(schedule.end == 1);
  CHECK(schedule.frame_interval == 1);
  CHECK(schedule.max_steps == 100'000'000);
  CHECK(schedule.step.fixed == 0);
  CHECK(schedule.step.safety == 0.5);
  CHECK(schedule.step.strain_per_step == 0.1);
  CHECK(schedule.step.ends.empty());
  const Diagnostics row;
  for (const double value : {row.time, row.step, row.damping_work, row.step_over_elastic_limit,
                             row.seconds, row.energy.total()})
    CHECK(value == 0);
  const Checkpoint c;
  CHECK(c.frame == 0);
  CHECK(c.steps == 0);
  for (const double value :
       {c.start_time, c.size, c.event_time, c.damping_work, c.damping_power, c.seconds})
    CHECK(value == 0);
  CHECK(RunResult{}.steps == 0);
}

TEST_CASE("every number of a row is visited once, in a fixed order") {
  Diagnostics row;
  double next = 10;
  for (double* value : {&row.time, &row.step, &row.damping_work, &row.step_over_elastic_limit})
    *value = ++next;
  for (const auto term : energy_terms) row.energy.*term = ++next;
  for (auto* momentum : {&row.linear_momentum, &row.angular_momentum})
    for (double& component : *momentum) component = ++next;
  row.seconds = -1;
  for (const auto count : summed_counters) row.work.*count = long(++next);
  for (const auto worst : worst_counters) row.work.*worst = ++next;
  double expected = 10;
  for_each_value(row, [&](const auto& value) { CHECK(double(value) == ++expected); });
  CHECK(expected == next);
}

TEST_CASE("a schedule that makes no sense is refused, by a run and by its resumption") {
  const System system = masses();
  const State start = start_state();
  Checkpoint at_start;
  at_start.past = {start};
  at_start.start_time = start.time;
  const auto refused = [&](const Schedule& schedule, const char* why) {
    CHECK_THROWS_AS(run(system, drifting(1), start, schedule, {}), InputError);
    CHECK_THROWS_WITH(run(system, drifting(1), start, schedule, {}), Contains(why));
    CHECK_THROWS_WITH(resume(system, drifting(1), at_start, schedule, {}), Contains(why));
    CHECK(steps_taken.empty());
  };
  for (const double end : {std::nextafter(0.7, 0), 0.5, double(NAN)})
    refused(schedule_of(end, 0.3, 0.1), "the end must not lie before the start");
  for (const double interval : {0.0, -0.3, double(NAN)})
    refused(schedule_of(0.9, interval, 0.1), "the frame interval must be > 0 s");
  for (const double fixed : {-1e-300, -0.1, double(NAN)})
    refused(schedule_of(0.9, 0.3, fixed), "the step must be > 0 s, or 0");
  for (const double wrong : {0.0, -0.2, double(NAN)}) {
    Schedule schedule = schedule_of(0.9, 0.3, 0.1);
    schedule.step.safety = wrong;
    refused(schedule, "the safety factor must be > 0");
    schedule = schedule_of(0.9, 0.3, 0.1);
    schedule.step.strain_per_step = wrong;
    refused(schedule, "strain_per_step must be > 0");
  }
}

TEST_CASE("a schedule of small numbers, or of no time at all, is run") {
  Schedule schedule = schedule_of(0.7, 0.2, 0.05);
  schedule.step.safety = 0.03;
  schedule.step.strain_per_step = 0.02;
  Seen seen;
  const RunResult result = run(masses(), drifting(1), start_state(), schedule, seen.observer());
  CHECK(result.steps == 0);
  CHECK_FALSE(result.stop);
  CHECK(seen.frames.size() == 1);
  CHECK(seen.rows.size() == 1);
  CHECK(seen.checkpoints.size() == 1);
}

TEST_CASE("frames lie an interval apart, each divided into even steps, and the last at the end") {
  Seen seen;
  const RunResult result =
      run(masses(), drifting(1), start_state(), schedule_of(1.7, 0.4, 0.15), seen.observer());
  expect_steps(steps_taken, {0.4 / 3, 0.4 / 3, 0.4 / 3, 0.4 / 3, 0.4 / 3, 0.4 / 3, 0.1, 0.1});
  std::vector<double> times;
  for (const State& frame : seen.frames) times.push_back(frame.time);
  CHECK(times == std::vector<double>{0.7, 0.7 + 0.4, 0.7 + 2 * 0.4, 1.7});
  CHECK(result.steps == 8);
  CHECK(result.work.solves == 16);
  CHECK(result.last.time == 1.7);
  CHECK(result.last.x == seen.frames.back().x);
  CHECK(seen.rows.size() == 9);
  CHECK(seen.frames.front().x == start_state().x);
}

TEST_CASE("no step is longer than wanted by more than a part in a thousand million") {
  const double third = 0.2 / 3;
  CHECK(steps_of(schedule_of(0.9, 0.9, third * (1 - 0.9e-9))).size() == 3);
  CHECK(steps_of(schedule_of(0.9, 0.9, third * (1 - 1.2e-9))).size() == 4);
  CHECK(steps_of(schedule_of(0.9, 0.9, 0.11)).size() == 2);
  expect_steps(steps_of(schedule_of(0.9, 0.9, 5)), {0.2});
  expect_steps(steps_of(schedule_of(0.9, 0.9, 0)), {0.2});  // nothing limits an automatic step
}

TEST_CASE("frames and prescribed ends of steps have their times to the bit") {
  Seen seen;
  run(masses(), drifting(2), start_state(), schedule_of(3.7, 0.1, 0.03), seen.observer());
  REQUIRE(seen.frames.size() == 31);
  for (size_t k = 0; k < 31; ++k) {
    const double interval = 0.1, time = 0.7 + double(k) * interval;
    CHECK(seen.frames[k].time == (k < 30 ? time : 3.7));
  }
  Schedule schedule = schedule_of(1.7, 1, 0.03);
  for (int k = 1; k < 30; ++k) schedule.step.ends.push_back(0.7 + std::sqrt(k / 31.0));
  Seen given;
  run(masses(), drifting(2), start_state(), schedule, given.observer());
  REQUIRE(given.rows.size() > 30);
  for (size_t k = 1; k < 30; ++k) CHECK(given.rows[k].time == schedule.step.ends[k - 1]);
}

TEST_CASE("a step that ends at a frame, or where it is told, ends there to the bit") {
  State start = start_state();
  start.time = -3.3;  // a step longer than the time it ends at rounds more coarsely
  int rounded = 0;
  for (int k = 0; k < 100; ++k) {
    const double end = 0.5 + 0.0137 * k;
    rounded += start.time + (end - start.time) != end;
    CHECK(run(masses(), drifting(1), start, schedule_of(end, 9, 9), {}).last.time == end);
    Schedule schedule = schedule_of(2, 9, 9);
    schedule.step.ends = {end};
    Seen seen;
    run(masses(), drifting(1), start, schedule, seen.observer());
    REQUIRE(seen.rows.size() == 3);
    CHECK(seen.rows[1].time == end);
  }
  CHECK(rounded > 5);
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

TEST_CASE("ends of steps that are prescribed are met to the bit, then the rule goes on") {
  Schedule schedule = schedule_of(1.5, 0.4, 0.25);
  schedule.step.ends = {0.3, 0.7, 0.73, 0.9, 1.3};  // the frame at 1.1 is not among them
  Seen seen;
  run(masses(), drifting(1), start_state(), schedule, seen.observer());
  expect_steps(steps_taken, {0.03, 0.17, 0.2, 0.2, 0.2});
  CHECK(seen.rows[1].time == 0.73);
  CHECK(seen.rows[2].time == 0.9);
  CHECK(seen.rows[3].time == 0.7 + 0.4);
  CHECK(seen.rows[4].time == 1.3);
  CHECK(seen.rows[5].time == 1.5);
  schedule.step.ends = {0.71};
  expect_steps(steps_of(schedule), {0.01, 0.195, 0.195, 0.2, 0.2});
}

TEST_CASE("rows hold the state's energies and momenta, the damping's work and the step's own") {
  System system = masses();
  system.forces.emplace_back(StretchSprings{{{0, 1, 2.9, 8, 0}}});
  CustomForce force;
  force.damping = [](const State&, const PerParticle3& v, PerParticle3& f) { f -= 0.3 * v; };
  system.forces.emplace_back(force);
  State start = start_state();
  start.bonds = {{0, 0, 1, Vector3::Zero()}, {0, 1, 1, Vector3::Zero()}};
  Seen seen;
  const RunResult result =
      run(system, drifting(1), start, schedule_of(1.1, 0.2, 0.1), seen.observer());
  REQUIRE(seen.rows.size() == 5);
  State s = start;
  double work = 0, power = -0.3 * s.v.squaredNorm();
  for (size_t k = 0; k < 5; ++k) {
    const Diagnostics& row = seen.rows[k];
    if (k > 0) {
      const double limit = elastic_limit(system, s);
      CHECK(row.step_over_elastic_limit == Approx(0.1 / limit).epsilon(1e-10));
      s.x += 0.1 * s.v;
      s.v *= 0.9;
      const double next = -0.3 * s.v.squaredNorm();
      work += 0.1 * (power + next) / 2;
      power = next;
    } else {
      CHECK(row.step_over_elastic_limit == 0);
    }
    CHECK(row.time == Approx(0.7 + 0.1 * double(k)).epsilon(1e-13));
    CHECK(row.step == Approx(k > 0 ? 0.1 : 0).margin(1e-13));
    CHECK(row.damping_work == Approx(work).epsilon(1e-12).margin(1e-15));
    CHECK(row.energy.total() == Approx(energies(system, s).total()).epsilon(1e-12));
    CHECK(row.energy.stretch > 0);
    CHECK((row.linear_momentum - linear_momentum(system, s)).norm() < 1e-12);
    CHECK((row.angular_momentum - angular_momentum(system, s)).norm() < 1e-12);
    CHECK(row.work.solves == (k > 0 ? 2 : 0));
    CHECK(row.work.bonds == (k > 0 ? 2 : 0));
    CHECK(row.seconds >= (k > 0 ? seen.rows[k - 1].seconds : 0));
    CHECK(row.seconds < 10);
  }
  CHECK(result.work.solves == 8);
  CHECK(result.work.bonds == 8);

  // checkpoints at 0.7, 0.9 and 1.1
  REQUIRE(seen.checkpoints.size() == 3);
  for (size_t k = 0; k < 3; ++k) {
    const Checkpoint& c = seen.checkpoints[k];
    CHECK(c.frame == long(k));
    CHECK(c.steps == long(2 * k));
    CHECK(c.work.solves == long(4 * k));
    CHECK(c.start_time == 0.7);
    CHECK(c.size == Approx(7).epsilon(1e-14));
    CHECK(c.event_time == 0.7);
    CHECK(c.damping_work == seen.rows[2 * k].damping_work);
    CHECK(c.damping_power == Approx(-0.3 * seen.frames[k].v.squaredNorm()).epsilon(1e-13));
    CHECK(c.seconds >= seen.rows[2 * k].seconds);
    REQUIRE(c.past.size() == 1);
    CHECK(c.past[0].x == seen.frames[k].x);
  }
}

TEST_CASE("a resumed run goes on as the whole one did, and its clock goes on") {
  System system = masses();
  CustomForce force;
  force.damping = [](const State&, const PerParticle3& v, PerParticle3& f) { f -= 0.3 * v; };
  system.forces.emplace_back(force);
  const Schedule schedule = schedule_of(1.3, 0.2, 0.1);
  Seen whole;
  run(system, drifting(2), start_state(), schedule, whole.observer());
  Checkpoint from = whole.checkpoints[1];
  CHECK(from.past.size() == 2);
  from.seconds = 5000;
  Seen rest;
  const RunResult result = resume(system, drifting(2), from, schedule, rest.observer());
  CHECK(result.steps == 6);
  CHECK(result.work.solves == 12);
  CHECK(result.last.x == whole.frames.back().x);
  REQUIRE(rest.frames.size() == 2);
  REQUIRE(rest.rows.size() == 4);
  for (size_t k = 0; k < 4; ++k) {
    CHECK(rest.rows[k].damping_work == whole.rows[k + 3].damping_work);
    CHECK(rest.rows[k].time == whole.rows[k + 3].time);
    CHECK(rest.rows[k].seconds >= 5000);
    CHECK(rest.rows[k].seconds < 5010);
  }
  CHECK(rest.checkpoints.back().frame == 3);
  CHECK(rest.checkpoints.back().seconds >= 5000);
  CHECK(rest.checkpoints.back().size == whole.checkpoints.back().size);
}

TEST_CASE("a checkpoint without a state, or of other cloth, is refused") {
  const Schedule schedule = schedule_of(0.9, 0.2, 0.1);
  Checkpoint from;
  const auto refused = [&] {
    CHECK_THROWS_WITH(resume(masses(), drifting(1), from, schedule, {}),
                      Contains("a checkpoint without a state, or of another number"));
  };
  refused();
  State other = start_state();
  other.x.conservativeResize(3, 3);
  from.past = {start_state(), other};
  refused();
  from.past = {other, start_state()};
  from.start_time = 0.7;
  from.size = 7;
  CHECK(resume(masses(), drifting(2), from, schedule_of(0.9, 0.3, 0.1), {}).steps == 2);
}

TEST_CASE("resumed schedules are checked at the checkpoint's latest state") {
  Checkpoint from;
  from.past = {start_state(), start_state()};
  from.past[1].time = 0.8;
  from.start_time = 0.7;
  from.size = 7;
  CHECK_THROWS_WITH(resume(masses(), drifting(2), from, schedule_of(0.75, 0.2, 0.1), {}),
                    Contains("the end must not lie before the start"));
  CHECK(resume(masses(), drifting(2), from, schedule_of(0.8, 0.2, 0.1), {}).steps == 0);
}
