#include "scripts/program/any_case/ladder_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"

namespace foldproof {

namespace {

constexpr double seconds_worth_a_line = 20;
constexpr double seconds_of_stored_run = 1e-6;  // of a run that the store has

/// Memory available without swapping [bytes]; no limit if the system does not tell.
double available_memory() {
  std::ifstream file("/proc/meminfo");
  std::string name, rest;
  for (double kilobytes; file >> name >> kilobytes; std::getline(file, rest))
    if (name == "MemAvailable:") return 1024 * kilobytes;
  return LadderLimits().bytes;
}

/// Of the clock, for jobs side by side that each take so many seconds.
double side_by_side(const std::vector<double>& seconds, int threads) {
  return std::max(std::ranges::max(seconds),
                  std::accumulate(seconds.begin(), seconds.end(), 0.0) / threads);
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
    std::vector<double> seconds;
    for (size_t k = 0; k < levels.size(); ++k)
      seconds.push_back(all_costs[costs.size() + k].seconds);
    run_for(levels, seconds, 0, line);
  }

  /// The next levels, at a time, of which each takes so many seconds of the processor. The line
  /// shows the part of the clock from its beginning to their end, and `later` seconds on.
  void run_for(const std::vector<Level>& levels, std::vector<double> seconds, double later,
               ProgressLine& line) {
    for (double& one : seconds) one = std::max(one, seconds_of_stored_run);
    const double clock = side_by_side(seconds, threads_of(running_)), before = line.seconds(),
                 work = std::accumulate(seconds.begin(), seconds.end(), 0.0),
                 whole = before + clock + later;
    for (double& one : seconds) one *= clock / work;
    line.start_stretch(before / whole);
    run(levels, seconds, {line, before, whole});
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
void announce(const std::vector<LevelCost>& costs, size_t levels, double seconds) {
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
/// coarse to fine. forecast: seconds of the processor for the finest mesh; later: of the clock
/// for the others.
void run_with_finest_steps(const SpaceLadder& ladder, LadderRunner& runner, ProgressLine& line,
                           double forecast, double later) {
  const int finest = int(ladder.levels.size()) - 1;
  const Level first = space_level(ladder, finest, {});
  runner.run_for({first}, {runner.is_stored(first) ? 0 : forecast}, later, line);
  if (!runner.runs[0].stopped.empty())
    throw InputError("the finest mesh comes to no end: " + runner.runs[0].stopped);
  const std::vector<double>& ends = runner.runs[0].step_ends;
  std::vector<Level> others = {step_check_level(ladder, ends)};
  for (int k = 0; k < finest; ++k) others.push_back(space_level(ladder, k, ends));
  std::vector<double> seconds = parts_of_finest(finest);
  for (size_t k = 0; k < others.size(); ++k)
    seconds[k] *= runner.is_stored(others[k]) ? 0 : runner.costs[0].seconds;
  runner.run_for(others, seconds, 0, line);
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
  const double spent = line.seconds();
  const auto clock = [&](size_t last) {
    return spent + clock_seconds(costs, 2, last, threads_of(running));
  };
  const Affordable affordable = affordable_levels(costs, 2, clock, limits);
  if (affordable.levels < 3)
    throw InputError("an error bar needs three levels, and " + affordable.refusal);
  later.resize(size_t(affordable.levels) - 2, later.front());
  const size_t levels = size_t(affordable.levels);
  announce(costs, levels, clock_seconds(costs, 2, levels - 1, threads_of(running)));
  runner.run_later(later, costs, line);
  return {std::move(runner.runs), std::move(costs), affordable.refusal};
}

SpaceRuns run_meshes(SpaceLadder ladder, const LevelSetProvider& level_sets, ResultStore& store,
                     const JobSettings& running, const LadderLimits& limits) {
  ProgressLine line("meshes");
  const double whole = 2 * std::pow(8, ladder.levels.size());  // if each takes 8 times as long
  LadderRunner probes(level_sets, store, running);
  const std::vector<LevelCost> costs = probed_costs(ladder, probes, line, whole);
  const double spent = line.seconds();
  const auto clock = [&](size_t last) {
    return spent + mesh_clock_seconds(costs[last].seconds, int(last), threads_of(running));
  };
  const Affordable affordable = affordable_levels(costs, 2, clock, limits);
  if (affordable.levels < 3)
    throw InputError("an error bar needs three levels, and " + affordable.refusal);
  ladder.levels.resize(size_t(affordable.levels));
  const size_t finest = ladder.levels.size() - 1;
  const double forecast = costs[finest].seconds,
               whole_ladder = mesh_clock_seconds(forecast, int(finest), threads_of(running));
  announce(costs, ladder.levels.size(), whole_ladder);

  LadderRunner runner(level_sets, store, running);
  run_with_finest_steps(ladder, runner, line, forecast, whole_ladder - forecast);
  std::vector<LevelRun> runs(runner.runs.begin() + 2, runner.runs.end());
  runs.push_back(std::move(runner.runs[0]));
  return {
      std::move(ladder), {std::move(runs), costs, affordable.refusal}, std::move(runner.runs[1])};
}

}  // namespace foldproof
