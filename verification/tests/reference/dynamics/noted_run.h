// A method made for tests of runs, which notes its steps.
#pragma once

#include <catch2/catch.hpp>

#include "reference/dynamics/simulate.h"

namespace foldproof::noted_run {

inline constexpr double infinite = std::numeric_limits<double>::infinity();

inline std::vector<double> steps_taken;

/// Moves with the velocities, which lose a tenth a step; every step costs two solves.
inline State drift(const System& system, std::span<const State> past, double h, Work& work) {
  steps_taken.push_back(h);
  State next = past.back();
  next.time += h;
  next.x += h * next.v;
  next.v *= 0.9;
  impose(velocities_at(system.prescribed, next.time), next.v);
  work.solves = 2;
  return next;
}

inline Integrator drifting(int history, Family family = Family::mixed) {
  return {"", "", "", 1, history, drift, family};
}

/// Four particles of which none moves as the others do, 2 m, 3 m and 6 m apart along the axes.
inline State start_state() {
  return {0.7, PerParticle3{{0.5, 2.5, 0.7, 1.1}, {-1, 0.4, 2, 1.7}, {0.3, -2.2, 1.4, 3.8}},
          PerParticle3{{0.2, -0.1, 0.3, 0.4}, {0.1, 0.5, -0.2, 0.3}, {0.6, 0.2, 0.1, -0.4}}};
}

inline System masses() { return make_system((PerParticle(4) << 0.4, 0.7, 0.9, 0.3).finished()); }

inline Schedule schedule_of(double end, double interval, double fixed) {
  return {end, interval, {fixed}};
}

struct Seen {
  std::vector<State> frames;
  std::vector<Diagnostics> rows;
  std::vector<Checkpoint> checkpoints;
  Observer observer() {
    return {[this](const State& s) { frames.push_back(s); },
            [this](const Diagnostics& row) { rows.push_back(row); },
            [this](const Checkpoint& c) { checkpoints.push_back(c); }};
  }
};

inline RunResult run(const System& system, const Integrator& integrator, const State& start,
                     const Schedule& schedule, const Observer& observer) {
  steps_taken.clear();
  return simulate(system, integrator, start, schedule, observer);
}

inline std::vector<double> steps_of(const Schedule& schedule) {
  const RunResult result = run(masses(), drifting(1), start_state(), schedule, {});
  CHECK(result.steps == long(steps_taken.size()));
  CHECK_FALSE(result.stop);
  CHECK(result.last.time == schedule.end);
  return steps_taken;
}

inline void expect_steps(const std::vector<double>& taken, const std::vector<double>& expected) {
  REQUIRE(taken.size() == expected.size());
  for (size_t k = 0; k < taken.size(); ++k) CHECK(taken[k] == Approx(expected[k]).epsilon(1e-11));
}

}  // namespace foldproof::noted_run
