#include "convergence/any_case/precision_run.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>

#include "convergence/any_case/level_run.h"
#include "convergence/work_precision/timed_run.h"
#include "verification/cases/judge.h"

namespace foldproof {

namespace {

constexpr double most_numbers = 1e6;  // that a run keeps

struct OverBudget {};

/// Every so many frames one is kept.
long stride_of(const Scene& scene, int times) {
  if (times > 1) return std::numeric_limits<long>::max();
  const double frames = scene.schedule.end / scene.schedule.frame_interval + 1;
  return std::max(1L, std::lround(std::ceil(3 * frames * scene.mesh.particles() / most_numbers)));
}

double elements(const Scene& scene) {
  return double((scene.stretch ? scene.mesh.edges.size() : 0) +
                (scene.bending ? scene.mesh.hinges.size() : 0) + 1);
}

/// The run, not timed.
TrialRun watched_trial(const Scene& scene, const PrecisionTrial& trial, const BuiltScene& built) {
  const double budget = trial.budget;
  const PerParticle free_mass =
      (built.system.inverse_mass.array() > 0).select(built.system.mass.array(), 0.0);
  TrialRun run;
  Schedule schedule = scene.schedule;
  schedule.max_steps =
      std::min(schedule.max_steps, std::lround(std::ceil(budget / elements(scene))));
  const double case_end = scene.schedule.end / trial.times;
  const long stride = stride_of(scene, trial.times);
  long frame = 0;
  double reached = 0;
  Observer observer;
  observer.frame = [&](const State& s) {
    reached = s.time;
    const double kinetic = 0.5 * s.v.colwise().squaredNorm().dot(free_mass.transpose());
    run.energy.largest = std::max(run.energy.largest, kinetic);
    if (s.time > case_end * (1 + 1e-9)) run.energy.added = std::max(run.energy.added, kinetic);
    if (frame++ % stride != 0 && s.time < schedule.end) return;
    run.times.push_back(s.time);
    run.x.push_back(s.x);
  };
  observer.checkpoint = [&](const Checkpoint& at) {
    run.work = at.work;
    run.steps = at.steps;
    if (visits(scene, at.work) > budget) throw OverBudget{};
  };
  try {
    const RunResult result =
        simulate(built.system, integrator_named(scene.integrator), built.start, schedule, observer);
    run.work = result.work;
    run.steps = result.steps;
    reached = result.last.time;
    if (result.stop) run.stopped = describe(*result.stop);
    if (result.stop && schedule.max_steps < scene.schedule.max_steps &&
        result.steps >= schedule.max_steps)
      throw OverBudget{};
  } catch (const OverBudget&) {
    run.over_budget = budget;
    run.stopped = "its work exceeds the budget";
  }
  run.part = reached / schedule.end;
  return run;
}

TrialRun timed_trial(const Scene& scene, const PrecisionTrial& trial, const BuiltScene& built) {
  auto [run, seconds] = timed_run([&] { return watched_trial(scene, trial, built); });
  run.seconds = seconds;
  return run;
}

StoredResult packed_trial(const TrialRun& run) {
  StoredResult kept = packed_frames(run);
  std::vector<double> work;
  for_each_counter(run.work, [&](auto value) { work.push_back(double(value)); });
  kept.arrays.insert(
      {{"work", work},
       {"end",
        {double(run.steps), run.part, run.over_budget, run.energy.largest, run.energy.added}}});
  return kept;
}

/// The run; none where something is missing of it, and where a smaller budget ended it.
std::optional<TrialRun> unpacked_trial(const StoredResult& kept, double budget) {
  TrialRun run;
  const size_t numbers = array_of(kept, "positions").size(),
               frames = array_of(kept, "times").size();
  const Eigen::Index particles = frames > 0 ? Eigen::Index(numbers / frames / 3) : 0;
  const std::vector<double> work = array_of(kept, "work"), end = array_of(kept, "end");
  size_t counters = 0;
  for_each_counter(run.work, [&](auto&) { ++counters; });
  if (!unpack_frames(kept, particles, run) || work.size() != counters || end.size() != 5) return {};
  size_t next = 0;
  for_each_counter(run.work, [&](auto& value) {
    value = std::remove_reference_t<decltype(value)>(work[next++]);
  });
  run.steps = long(end[0]);
  run.part = end[1];
  run.over_budget = end[2];
  run.energy = {end[3], end[4]};
  if (run.over_budget > 0 && run.over_budget < budget) return {};
  return run;
}

}  // namespace

double visits(const Scene& scene, const Work& w) {
  const double applications =
      double(w.elastic_evaluations + w.damping_preparations + w.damping_products +
             w.stiffness_preparations + w.stiffness_products);
  return applications * elements(scene) +
         double(w.strain_sweeps) * double(scene.mesh.edges.size()) + double(w.object_queries) +
         double(w.close_pairs + w.crossing_queries);
}

Scene scene_of(const Scene& scene, const PrecisionTrial& trial) {
  Scene tried = scene;
  tried.integrator = trial.method;
  StepRule& step = tried.schedule.step;
  step.ends.clear();
  step.fixed = std::min(scene.schedule.frame_interval, scene.schedule.end) / trial.parts;
  tried.schedule.end *= trial.times;
  tried.schedule.max_steps *= trial.times;
  return tried;
}

TrialRun run_trial(const Case& input_case, const PrecisionTrial& trial,
                   const LevelSetProvider& level_sets) {
  const Scene scene = scene_of(input_case.scene, trial);
  try {
    return timed_trial(scene, trial, build(scene, level_sets));
  } catch (const std::exception& error) {
    TrialRun none;
    none.stopped = error.what();
    return none;
  }
}

TrialRun stored_trial(const Case& input_case, const PrecisionTrial& trial,
                      const LevelSetProvider& level_sets, ResultStore& store,
                      const std::string& program) {
  Level level{input_case.scene.name + ", " + trial.method + ", " + std::to_string(trial.parts) +
                  " steps a frame" + (trial.times > 1 ? ", longer" : ""),
              input_case,
              {},
              input_case.scene.mesh.particles()};
  level.input_case.scene = scene_of(input_case.scene, trial);
  const RunKeeper<TrialRun> keeper{
      [&] { return run_trial(input_case, trial, level_sets); }, packed_trial,
      [&](const StoredResult& kept) { return unpacked_trial(kept, trial.budget); }};
  return stored_or_made(store, key_of(level, program + "; precision"), level.label, keeper);
}

}  // namespace foldproof
