// Determinism, state, observed order, the error of the step and its cost, precision.
#include <algorithm>
#include <cmath>
#include <limits>

#include "verification/subjects/suite/laws.h"
#include "verification/subjects/suite/scenes.h"

namespace foldproof {

namespace {

using namespace suite;

constexpr long steps = 20;

long differing(const Snapshot& a, const Snapshot& b) {
  return (a.x.array() != b.x.array()).count() + (a.v.array() != b.v.array()).count();
}

Finding count_differences(const Snapshot& a, const Snapshot& b, const char* why) {
  Table measured{{"numbers", "1"}, {"numbers that differ", "1"}};
  measured.row(2 * a.x.size(), differing(a, b));
  return judge_worst(measured, 0, why);
}

Finding same_in_a_fresh_process(Trial& trial) {
  trial.restart();
  const Snapshot first = trial.after(moving_sheet(), steps);
  trial.restart();
  return count_differences(first, trial.after(moving_sheet(), steps),
                           "the same program, input and machine: the same bits");
}

Finding second_scene_starts_afresh(Trial& trial) {
  trial.restart();
  const Snapshot first = trial.after(moving_sheet(), steps);
  trial.after(falling_sheet(), steps);
  return count_differences(first, trial.after(moving_sheet(), steps),
                           "nothing of an earlier scene may be left");
}

Finding step_depends_on_its_state_alone(Trial& trial) {
  trial.require_level(1);
  trial.require("set_state");
  const PortableScene scene = moving_sheet();
  trial.prepare(scene);
  const std::vector<Snapshot> start{{scene.x, scene.v}};
  const Snapshot first = trial.solver().step(start, {0}, scene.dt);
  trial.solver().advance(scene.dt, steps);
  return count_differences(first, trial.solver().step(start, {0}, scene.dt),
                           "the state that was set is all that a step depends on");
}

/// The moving sheet, which takes so many steps to 0.04 s.
PortableScene moving_sheet_in(long count) {
  PortableScene scene = moving_sheet();
  scene.dt *= double(steps) / double(count);
  return scene;
}

PerParticle3 positions_after(Trial& trial, long count) {
  return trial.after(moving_sheet_in(count), count).x;
}

Finding order_is_as_claimed(Trial& trial) {
  const int claimed = trial.declaration().order;
  if (claimed == 0) throw NotOffered{"a claimed order"};
  std::vector<PerParticle3> runs;
  for (const long count : {steps, 2 * steps, 4 * steps, 8 * steps})
    runs.push_back(positions_after(trial, count));
  std::vector<double> differences;
  for (size_t k = 1; k < runs.size(); ++k) differences.push_back((runs[k] - runs[k - 1]).norm());
  // a difference of runs that is mostly rounding, which grows like a random walk, shows no order;
  // a scheme of less order than it claims leaves larger ones
  const double rounding =
      trial.declaration().rounding() * std::sqrt(8.0 * steps) * runs.back().norm();
  if (differences[1] <= rounding)
    throw NotOffered{"enough digits: its errors in these steps are rounding"};
  const double coarse = std::log2(differences[0] / differences[1]);
  const double fine =
      differences[2] > rounding ? std::log2(differences[1] / differences[2]) : coarse;
  Table measured{{"observed", "1"},
                 {"observed on coarser steps", "1"},
                 {"claimed", "1"},
                 {"short of the claim", "1"}};
  measured.row(fine, coarse, claimed, double(claimed) - fine);
  return judge_worst(measured, "short of the claim", 0.35,
                     "halved steps see the next term of the series as a third of an order at most");
}

/// A run to 0.04 s: its end, and the least of several readings of the clock.
struct TimedRun {
  long count;
  PerParticle3 x;
  double seconds;
};

constexpr int most_readings = 5;
constexpr double enough_seconds = 0.2;  // of readings; slow solvers are read once

TimedRun timed_run(Trial& trial, long count) {
  TimedRun run{count, {}, std::numeric_limits<double>::infinity()};
  double spent = 0;
  for (int k = 0; k < most_readings && spent < enough_seconds; ++k) {
    run.x = positions_after(trial, count);
    spent += trial.seconds_of_motion();
    run.seconds = std::min(run.seconds, trial.seconds_of_motion());
  }
  return run;
}

/// The solver's own limit, as the step goes to 0, by the claimed order, or by 1. It is extrapolated
/// from the two neighbours that differ least: at steps below theirs, rounding has taken over.
PerParticle3 limit_of(const std::vector<TimedRun>& runs, const Declaration& declared) {
  const auto change = [&](size_t k) { return (runs[k].x - runs[k - 1].x).norm(); };
  size_t least = 1;
  for (size_t k = 2; k < runs.size(); ++k)
    if (change(k) <= change(least)) least = k;
  const PerParticle3 &fine = runs[least].x, &coarse = runs[least - 1].x;
  return fine + (fine - coarse) / (std::pow(2.0, std::max(1, declared.order)) - 1);
}

/// A row for each step: what it costs, what halving it changed, and its error.
Table errors_and_costs(const std::vector<TimedRun>& runs, const Declaration& declared) {
  const PerParticle3 limit = limit_of(runs, declared);
  const double motion = (limit - moving_sheet().x).norm();
  Table table{{"steps", "1"},
              {"step", "s"},
              {"seconds by the clock", "s"},
              {"change from twice the step", "motion"},
              {"error", "motion"}};
  for (size_t k = 0; k < runs.size(); ++k)
    table.row(runs[k].count, moving_sheet_in(runs[k].count).dt, runs[k].seconds,
              k == 0 ? nan : (runs[k].x - runs[k - 1].x).norm() / motion,
              (runs[k].x - limit).norm() / motion);
  return table;
}

/// The largest factor by which a change grows from one halving to the next. Changes that rounding
/// explains are no growth.
double growth_of_changes(const std::vector<TimedRun>& runs, const Declaration& declared) {
  Worst growth;
  for (size_t k = 2; k < runs.size(); ++k) {
    const PerParticle3 &coarse = runs[k - 2].x, &middle = runs[k - 1].x, &fine = runs[k].x;
    const PortableScene scene = moving_sheet_in(runs[k].count);
    const double rounding = rounding_error(scene, runs[k].count, declared) * fine.norm();
    const double change = (fine - middle).norm();
    growth.observe(change <= rounding ? 0 : change / (middle - coarse).norm());
  }
  return growth.value();
}

Finding halved_steps_approach_a_limit(Trial& trial) {
  std::vector<TimedRun> runs;
  for (const long count : {steps, 2 * steps, 4 * steps, 8 * steps})
    runs.push_back(timed_run(trial, count));
  const Declaration& declared = trial.declaration();
  Table growth{{"change over the change before", "1"}};
  growth.row(growth_of_changes(runs, declared));
  Finding finding = judge_worst(
      std::move(growth), 1,
      "an error that falls as any power of the step changes less at each halving; 0: rounding");
  finding.evidence = errors_and_costs(runs, declared);
  return finding;
}

bool is_float(double number) { return double(float(number)) == number; }

Finding results_need_their_digits(Trial& trial) {
  if (trial.declaration().is_single) throw NotOffered{"double precision"};
  const Snapshot end = trial.after(moving_sheet(), steps);
  const long floats = std::count_if(end.x.data(), end.x.data() + end.x.size(), is_float);
  Table measured{{"numbers", "1"}, {"share that single precision holds", "1"}};
  measured.row(end.x.size(), double(floats) / double(end.x.size()));
  return judge_worst(measured, 0.1, "a number in double precision is one of single with 2^-29");
}

}  // namespace

std::vector<Law> repeat_laws() {
  return {
      {"repeat.fresh-process-gives-the-same-bits", "The same scene gives the same bits again.",
       "determinism", same_in_a_fresh_process},
      {"repeat.second-scene-starts-afresh", "A scene gives the same bits after another one.",
       "determinism", second_scene_starts_afresh},
      {"repeat.step-depends-on-its-state-alone", "A state that is set again gives the same step.",
       "determinism", step_depends_on_its_state_alone},
      {"order.observed-is-as-claimed", "Halving the step reduces the error as claimed.",
       "Richardson", order_is_as_claimed},
      {"order.halved-steps-approach-a-limit",
       "Each halving of the step changes the motion less than the one before.", "Cauchy",
       halved_steps_approach_a_limit},
      {"precision.results-need-the-declared-digits",
       "Positions declared double are not all single precision numbers.", "IEEE 754",
       results_need_their_digits},
  };
}

}  // namespace foldproof
