// foldproof converge: the errors that a case owes to its step and to its mesh,
// quantity by quantity.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "convergence/any_case/converge.h"
#include "convergence/any_case/space_ladder.h"
#include "scripts/program/command_line/input_files.h"
#include "scripts/program/command_line/out_folder.h"
#include "scripts/program/commands.h"
#include "scripts/program/converge_report.h"
#include "scripts/program/json_text.h"
#include "scripts/program/predictability_runs.h"
#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"
#include "scripts/program/run_case.h"

namespace foldproof {

namespace {

/// Runs levels, each once in the life of its store.
struct LevelRunner {
  const LevelSetProvider& level_sets;
  ResultStore& store;
  const JobSettings& running;

  /// The level's run as a job; the result is left in `into`.
  Job job_of(Level level, double length, LevelRun& into) const {
    return {level.input_case.scene.name, length,
            [level = std::move(level), &into, this, program = program_identity()](const Progress&) {
              into = stored_level(level, level_sets, store, program);
              return RunRecord{};
            }};
  }

  void run(const std::vector<Job>& jobs, const std::string& label) const {
    RunRecord unused;
    run_jobs(jobs, label, running, unused);
  }
};

void require_end(const LevelRun& run, const std::string& which) {
  if (!run.stopped.empty()) throw InputError(which + " comes to no end: " + run.stopped);
}

/// A ladder, and of one in time how long its positions are predictable.
struct Told {
  LadderAnswer ladder;
  std::optional<PredictabilityAnswer> twins;
};

/// The first level alone, since the others divide its steps; then all others at a time.
Told told_in_time(const LadderPlan& plan, const LevelRunner& runner, const Options& options) {
  std::vector<LevelRun> runs(size_t(plan.levels));
  runner.run({runner.job_of(time_level(plan, 0, {}), 1, runs[0])}, "the case as it is");
  require_end(runs[0], "the case itself");
  std::vector<Job> jobs;
  for (int k = 1; k < plan.levels; ++k)
    jobs.push_back(runner.job_of(time_level(plan, k, runs[0].step_ends), 1 << k, runs[size_t(k)]));
  runner.run(jobs, "its steps divided");
  PredictabilityAnswer twins = run_twins(plan, runs, runner.level_sets, runner.store, options);
  LadderAnswer ladder = answer_before_horizon(plan, runs, twins);
  ladder.particles.assign(runs.size(), plan.input_case.scene.mesh.particles());
  return {std::move(ladder), std::move(twins)};
}

/// The finest mesh alone, since all others take its steps; then all others at a time.
LadderAnswer answer_in_space(const SpaceLadder& ladder, const LevelRunner& runner) {
  const int finest = int(ladder.levels.size()) - 1;
  std::vector<LevelRun> runs(ladder.levels.size());
  LevelRun halved;
  runner.run({runner.job_of(space_level(ladder, finest, {}), 1, runs.back())}, "the finest mesh");
  require_end(runs.back(), "the finest mesh");
  const std::vector<double>& ends = runs.back().step_ends;
  std::vector<Job> jobs = {
      runner.job_of(step_check_level(ladder, ends), 2 << (2 * finest), halved)};
  for (int k = 0; k < finest; ++k)
    jobs.push_back(runner.job_of(space_level(ladder, k, ends), 1 << (2 * k), runs[size_t(k)]));
  runner.run(jobs, "coarser meshes, the case as it is among them");
  return space_answer(ladder, runs, halved);
}

std::vector<Told> told_for(const CaseSource& source, const Options& options,
                           const LevelRunner& runner) {
  std::vector<Told> all;
  if (options.in != "space") {
    LadderPlan plan{case_of(source), options.levels, {}};
    plan.measurements = measurements_of(plan.input_case);
    all.push_back(told_in_time(plan, runner, options));
  }
  if (options.in != "time") {
    const auto objects = options.refines_objects ? ObjectsToo::yes : ObjectsToo::no;
    all.push_back({answer_in_space(space_ladder(source, options.levels, objects), runner), {}});
  }
  return all;
}

/// Those asked for, or the case's own, "".
std::vector<std::string> methods_of(const Options& options) {
  std::vector<std::string> methods = options.methods;
  if (std::ranges::find(methods, "all") != methods.end()) {
    methods.clear();
    for (const Integrator& integrator : integrators()) methods.emplace_back(integrator.name);
  }
  for (const std::string& method : methods) integrator_named(method);
  if (methods.empty()) methods.emplace_back();
  return methods;
}

nlohmann::json to_json(const Told& told) {
  nlohmann::json all = to_json(told.ladder);
  if (told.twins) all["predictability"] = to_json(*told.twins);
  return all;
}

/// One ladder as an object; several as a list, "ladders".
nlohmann::json to_json(const std::vector<Told>& all) {
  if (all.size() == 1) return to_json(all.front());
  nlohmann::json ladders = nlohmann::json::array();
  for (const Told& told : all) ladders.push_back(to_json(told));
  return {{"ladders", ladders}};
}

int report(const std::vector<Told>& all, const Options& options) {
  bool is_conclusive = true;
  for (const Told& told : all) {
    is_conclusive &= told.ladder.quantities.front().bar.reading != Reading::inconclusive;
    if (options.json) continue;
    print(told.ladder);
    if (told.twins) print(*told.twins);
    if (&told != &all.back()) fmt::print("\n");
  }
  if (options.json) fmt::print("{}\n", json_text(to_json(all)));
  return is_conclusive ? all_hold : some_fail;
}

}  // namespace

int converge(const Options& options) {
  const LevelSetProvider level_sets = memoizing_provider(provider_for(options.cache));
  CaseSource source{case_file(options.file), options.overrides, "", options.until};
  const std::vector<std::string> methods = methods_of(options);
  build(case_of(source).scene, level_sets);  // refuses now what cannot be built
  const OutFolder folder(options.out);
  ResultStore store(options.out + "/store");
  const LevelRunner runner{level_sets, store, options.running};
  std::vector<Told> all;
  for (const std::string& method : methods) {
    source.method = method;
    for (Told& told : told_for(source, options, runner)) all.push_back(std::move(told));
  }
  return report(all, options);
}

}  // namespace foldproof
