#include "scripts/program/any_case/ladder_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>
#include <utility>

#include "scripts/program/progress.h"

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

/// Runs levels as jobs and keeps what they left.
struct RunningLadder {
  const LevelRunner& by;
  std::vector<LevelRun> runs;
  std::vector<LevelCost> costs;  // of the runs

  /// The next levels, at a time. lengths: how long each takes beside the others.
  void run(const std::vector<Level>& levels, const std::vector<double>& lengths,
           const ProgressSpan& span) {
    std::vector<LevelRun> more = run_levels(levels, lengths, span, by);
    for (size_t k = 0; k < levels.size(); ++k) {
      costs.push_back(cost_of(levels[k], more[k]));
      runs.push_back(std::move(more[k]));
    }
  }

  /// The next levels, at a time, of which each takes so many seconds of the processor. The line
  /// shows the part of the clock from its beginning to their end, and `later` seconds on.
  void run_for(const std::vector<Level>& levels, std::vector<double> seconds, double later,
               ProgressLine& line) {
    for (double& one : seconds) one = std::max(one, seconds_of_stored_run);
    const double clock = clock_seconds(seconds, threads_of(by.running)), before = line.seconds(),
                 work = std::accumulate(seconds.begin(), seconds.end(), 0.0),
                 whole = before + clock + later;
    for (double& one : seconds) one *= clock / work;
    line.start_stretch(before / whole);
    run(levels, seconds, {line, before, whole});
  }

  bool is_stored(const Level& level) const {
    return by.kept.store.contains(key_of(level, by.kept.program));
  }
};

/// The levels that fit the limits (affordable_levels), three or more.
Affordable three_or_more(const std::vector<LevelCost>& costs,
                         const std::function<double(size_t)>& clock, const LadderLimits& limits) {
  Affordable affordable = affordable_levels(costs, 2, clock, limits);
  if (affordable.levels < 3)
    throw InputError("an error bar needs three levels, and " + affordable.refusal);
  return affordable;
}

/// Says what levels 3 .. levels will take, where that is long enough to be asked for.
void announce(const std::vector<LevelCost>& costs, int levels, double seconds) {
  double bytes = 0;
  for (size_t k = 0; k < size_t(levels); ++k) bytes += costs[k].bytes;
  if (seconds > seconds_worth_a_line)
    log_line(fmt::format("levels 3 to {}: about {}; all runs keep {:.2g} GB in memory", levels,
                         duration_text(seconds), bytes / 1e9));
}

/// Costs of all meshes, forecast from runs of the two coarsest ones.
std::vector<LevelCost> probed_costs(const SpaceLadder& meshes, const LevelRunner& by,
                                    ProgressLine& line) {
  const double whole = 2 * std::pow(8, meshes.levels.size());  // if each takes 8 times as long
  RunningLadder ladder{by, {}, {}};
  for (int k = 0; k < 2; ++k) {
    ladder.run({space_level(meshes, k, {})}, {1}, {line, double(k), whole});
    if (!ladder.runs.back().stopped.empty())
      throw InputError(fmt::format("level {} comes to no end: {}", k, ladder.runs.back().stopped));
  }
  return foreseen_costs(ladder.costs, int(meshes.levels.size()));
}

/// Leaves the runs of the finest mesh, of the check of its steps, and of the other meshes,
/// coarse to fine. forecast: seconds of the processor for the finest mesh; later: of the clock
/// for the others.
void run_with_finest_steps(const SpaceLadder& meshes, RunningLadder& ladder, ProgressLine& line,
                           double forecast, double later) {
  const int finest = int(meshes.levels.size()) - 1;
  const Level first = space_level(meshes, finest, {});
  ladder.run_for({first}, {ladder.is_stored(first) ? 0 : forecast}, later, line);
  if (!ladder.runs[0].stopped.empty())
    throw InputError("the finest mesh comes to no end: " + ladder.runs[0].stopped);
  const std::vector<double>& ends = ladder.runs[0].step_ends;
  std::vector<Level> others = {step_check_level(meshes, ends)};
  for (int k = 0; k < finest; ++k) others.push_back(space_level(meshes, k, ends));
  std::vector<double> seconds = parts_of_finest(finest);
  for (size_t k = 0; k < others.size(); ++k)
    seconds[k] *= ladder.is_stored(others[k]) ? 0 : ladder.costs[0].seconds;
  ladder.run_for(others, seconds, 0, line);
}

}  // namespace

std::vector<Job> level_jobs(const std::vector<Level>& levels, const std::vector<double>& lengths,
                            const KeptRuns& by, std::vector<LevelRun>& runs) {
  std::vector<Job> jobs;
  for (size_t k = 0; k < levels.size(); ++k)
    jobs.push_back({levels[k].label, lengths[k],
                    [&level = levels[k], &into = runs[k], &by](const Progress& progress) {
                      into = stored_level(level, by, progress);
                      return RunRecord{};
                    }});
  return jobs;
}

LadderLimits limits_of(double hours) {
  return {hours > 0 ? 3600 * hours : LadderLimits().seconds, available_memory()};
}

LadderRuns run_ladder(const LadderOfLevels& of, const LevelRunner& by, const LadderLimits& limits) {
  RunningLadder ladder{by, {}, {}};
  ProgressLine line("levels");
  const double doubled = std::pow(2, of.levels) - 1;  // if each takes twice the one before
  ladder.run({of.level(0, ladder.runs)}, {1}, {line, 0, doubled});
  if (!ladder.runs[0].stopped.empty())
    throw InputError("the case itself comes to no end: " + ladder.runs[0].stopped);
  ladder.run({of.level(1, ladder.runs)}, {2}, {line, 1, doubled});

  std::vector<LevelCost> costs = foreseen_costs(ladder.costs, of.levels);
  std::vector<Level> later;
  for (int k = 2; k < of.levels; ++k) {
    later.push_back(of.level(k, ladder.runs));
    if (ladder.is_stored(later.back())) costs[size_t(k)].seconds = 0;
  }
  const double spent = line.seconds();
  const auto clock = [&](size_t last) {
    return clock_seconds(seconds_of(costs, 2, last), threads_of(by.running));
  };
  const Affordable affordable = three_or_more(
      costs, [&](size_t last) { return spent + clock(last); }, limits);
  later.resize(size_t(affordable.levels) - 2, later.front());
  const size_t last = size_t(affordable.levels) - 1;
  announce(costs, affordable.levels, clock(last));
  ladder.run_for(later, seconds_of(costs, 2, last), 0, line);
  return {std::move(ladder.runs), affordable.refusal};
}

SpaceRuns run_meshes(SpaceLadder meshes, const LevelRunner& by, const LadderLimits& limits) {
  ProgressLine line("meshes");
  const std::vector<LevelCost> costs = probed_costs(meshes, by, line);
  const double spent = line.seconds();
  const auto clock = [&](size_t last) {
    return mesh_clock_seconds(costs[last].seconds, int(last), threads_of(by.running));
  };
  const Affordable affordable = three_or_more(
      costs, [&](size_t last) { return spent + clock(last); }, limits);
  meshes.levels.resize(size_t(affordable.levels));
  const size_t finest = meshes.levels.size() - 1;
  announce(costs, affordable.levels, clock(finest));

  RunningLadder ladder{by, {}, {}};
  const double forecast = costs[finest].seconds;
  run_with_finest_steps(meshes, ladder, line, forecast, clock(finest) - forecast);
  std::vector<LevelRun> runs(ladder.runs.begin() + 2, ladder.runs.end());
  runs.push_back(std::move(ladder.runs[0]));
  return {std::move(meshes), {std::move(runs), affordable.refusal}, std::move(ladder.runs[1])};
}

}  // namespace foldproof
