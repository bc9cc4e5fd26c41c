#include "scripts/program/any_case/ladder_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <thread>
#include <utility>

#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"

namespace foldproof {

namespace {

constexpr double seconds_worth_a_line = 20;

/// Memory available without swapping [bytes]; no limit if the system does not tell.
double available_memory() {
  std::ifstream file("/proc/meminfo");
  std::string name, rest;
  for (double kilobytes; file >> name >> kilobytes; std::getline(file, rest))
    if (name == "MemAvailable:") return 1024 * kilobytes;
  return LadderLimits().bytes;
}

int threads_of(const JobSettings& running) {
  return int(running.threads > 0 ? running.threads
                                 : std::max(1u, std::thread::hardware_concurrency()));
}

/// Runs levels as jobs and keeps what they left.
class LadderRunner {
 public:
  LadderRunner(const LevelSetProvider& level_sets, ResultStore& store, const JobSettings& running)
      : level_sets_(level_sets), store_(store), running_(running) {}

  /// The next levels, at a time. lengths: how long each takes beside the others.
  void run(const std::vector<Level>& levels, const std::vector<double>& lengths,
           const ProgressSpan& span) {
    const size_t first = runs.size();
    runs.resize(first + levels.size());
    std::vector<Job> jobs;
    for (size_t k = 0; k < levels.size(); ++k)
      jobs.push_back(
          {levels[k].label, lengths[k],
           [this, &level = levels[k], &into = runs[first + k]](const Progress& progress) {
             into = stored_level(level, level_sets_, store_, program_, progress);
             return RunRecord{};
           }});
    RunRecord failed;
    run_jobs(jobs, span, running_, failed);
    if (!failed.records.empty()) throw std::runtime_error(failed.records.front().finding.note);
    for (size_t k = 0; k < levels.size(); ++k) costs.push_back(cost_of(levels[k], runs[first + k]));
  }

  /// The last levels, at a time; costs: of all levels.
  void run_later(const std::vector<Level>& levels, const std::vector<LevelCost>& all_costs,
                 ProgressLine& line) {
    double done = 0, to_come = 0;
    for (const LevelCost& cost : costs) done += cost.seconds;
    std::vector<double> lengths;
    for (size_t k = 0; k < levels.size(); ++k) {
      lengths.push_back(std::max(all_costs[costs.size() + k].seconds, 1e-6));
      to_come += lengths.back();
    }
    run(levels, lengths, {line, done, done + to_come});
  }

  bool is_stored(const Level& level) const { return store_.contains(key_of(level, program_)); }

  std::vector<LevelRun> runs;
  std::vector<LevelCost> costs;  // of the runs

 private:
  const LevelSetProvider& level_sets_;
  ResultStore& store_;
  const JobSettings& running_;
  const std::string program_ = program_identity();
};

/// Says what levels 3 .. levels will take, where that is long enough to be asked for.
void announce(const std::vector<LevelCost>& costs, size_t levels, int threads) {
  const double seconds = clock_seconds(costs, 2, levels - 1, threads);
  double bytes = 0;
  for (size_t k = 0; k < levels; ++k) bytes += costs[k].bytes;
  if (seconds > seconds_worth_a_line)
    log_line(fmt::format("levels 3 to {}: about {}; all runs keep {:.2g} GB in memory", levels,
                         duration_text(seconds), bytes / 1e9));
}

/// Costs of all meshes, forecast from runs of the two coarsest ones.
std::vector<LevelCost> probed_costs(const SpaceLadder& ladder, LadderRunner& runner,
                                    ProgressLine& line, double whole) {
  for (int k = 0; k < 2; ++k) {
    runner.run({space_level(ladder, k, {})}, {1}, {line, double(k), whole});
    if (!runner.runs.back().stopped.empty())
      throw InputError(fmt::format("level {} comes to no end: {}", k, runner.runs.back().stopped));
  }
  return foreseen_costs(runner.costs, int(ladder.levels.size()));
}

/// Leaves the runs of the finest mesh, of the check of its steps, and of the other meshes,
/// coarse to fine.
void run_with_finest_steps(const SpaceLadder& ladder, LadderRunner& runner, ProgressLine& line,
                           double whole) {
  const int finest = int(ladder.levels.size()) - 1;
  runner.run({space_level(ladder, finest, {})}, {1}, {line, 0.02 * whole, whole});
  if (!runner.runs[0].stopped.empty())
    throw InputError("the finest mesh comes to no end: " + runner.runs[0].stopped);
  const std::vector<double>& ends = runner.runs[0].step_ends;
  std::vector<Level> others = {step_check_level(ladder, ends)};
  std::vector<double> lengths = {2};  // twice the steps of the second-finest
  for (int k = 0; k < finest; ++k) {
    others.push_back(space_level(ladder, k, ends));
    lengths.push_back(std::pow(4, k - finest + 1));
  }
  runner.run(others, lengths, {line, 0.55 * whole, whole});
}

}  // namespace

LadderLimits limits_of(double hours) {
  return {hours > 0 ? 3600 * hours : LadderLimits().seconds, available_memory()};
}

LadderRuns run_ladder(const LadderOfLevels& ladder, const LevelSetProvider& level_sets,
                      ResultStore& store, const JobSettings& running, const LadderLimits& limits) {
  LadderRunner runner(level_sets, store, running);
  ProgressLine line("levels");
  const double doubled = std::pow(2, ladder.levels) - 1;  // if each takes twice the one before
  runner.run({ladder.level(0, runner.runs)}, {1}, {line, 0, doubled});
  if (!runner.runs[0].stopped.empty())
    throw InputError("the case itself comes to no end: " + runner.runs[0].stopped);
  runner.run({ladder.level(1, runner.runs)}, {2}, {line, 1, doubled});

  std::vector<LevelCost> costs = foreseen_costs(runner.costs, ladder.levels);
  std::vector<Level> later;
  for (int k = 2; k < ladder.levels; ++k) {
    later.push_back(ladder.level(k, runner.runs));
    if (runner.is_stored(later.back())) costs[size_t(k)].seconds = 0;
  }
  const Affordable affordable =
      affordable_levels(costs, 2, line.seconds(), limits, threads_of(running));
  if (affordable.levels < 3)
    throw InputError("an error bar needs three levels, and " + affordable.refusal);
  later.resize(size_t(affordable.levels) - 2, later.front());
  announce(costs, size_t(affordable.levels), threads_of(running));
  runner.run_later(later, costs, line);
  return {std::move(runner.runs), std::move(costs), affordable.refusal};
}

SpaceRuns run_meshes(SpaceLadder ladder, const LevelSetProvider& level_sets, ResultStore& store,
                     const JobSettings& running, const LadderLimits& limits) {
  ProgressLine line("meshes");
  const double whole = 2 * std::pow(8, ladder.levels.size());  // if each takes 8 times as long
  LadderRunner probes(level_sets, store, running);
  const std::vector<LevelCost> costs = probed_costs(ladder, probes, line, whole);
  const Affordable affordable =
      affordable_levels(costs, 2, line.seconds(), limits, threads_of(running));
  if (affordable.levels < 3)
    throw InputError("an error bar needs three levels, and " + affordable.refusal);
  ladder.levels.resize(size_t(affordable.levels));
  announce(costs, ladder.levels.size(), threads_of(running));

  LadderRunner runner(level_sets, store, running);
  run_with_finest_steps(ladder, runner, line, whole);
  std::vector<LevelRun> runs(runner.runs.begin() + 2, runner.runs.end());
  runs.push_back(std::move(runner.runs[0]));
  return {
      std::move(ladder), {std::move(runs), costs, affordable.refusal}, std::move(runner.runs[1])};
}

}  // namespace foldproof
