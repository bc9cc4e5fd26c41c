#include "convergence/any_case/ladder_cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "convergence/work_precision/precision_problem.h"

namespace foldproof {

namespace {

/// By how much more from one level to the next; 1 where it says nothing.
double growth(double before, double last) { return before > 0 && last > 0 ? last / before : 1; }

}  // namespace

LevelCost cost_of(const Level& level, const LevelRun& run) {
  double numbers = double(run.step_ends.size() + run.times.size());
  for (const PerParticle3& x : run.x) numbers += double(x.size());
  return {operator_applications(run.work) * level.input_case.scene.mesh.particles(), run.seconds,
          2 * sizeof(double) * numbers};
}

std::vector<LevelCost> foreseen_costs(const std::vector<LevelCost>& measured, int levels) {
  std::vector<LevelCost> all = measured;
  const LevelCost &before = measured.at(measured.size() - 2), &last = measured.back();
  const double work = growth(before.work, last.work);
  const double bytes = std::max(1.0, growth(before.bytes, last.bytes));
  while (all.size() < size_t(levels))
    all.push_back({all.back().work * work, all.back().seconds * work, all.back().bytes * bytes});
  return all;
}

std::vector<double> seconds_of(const std::vector<LevelCost>& costs, size_t first, size_t last) {
  std::vector<double> seconds;
  for (size_t k = first; k <= last; ++k) seconds.push_back(costs[k].seconds);
  return seconds;
}

double clock_seconds(const std::vector<double>& seconds, int threads) {
  return std::max(std::ranges::max(seconds),
                  std::accumulate(seconds.begin(), seconds.end(), 0.0) / threads);
}

std::vector<double> parts_of_finest(int finest) {
  std::vector<double> parts = {0.5};
  for (int k = 0; k < finest; ++k) parts.push_back(std::pow(4, k - finest));
  return parts;
}

double mesh_clock_seconds(double seconds, int finest, int threads) {
  std::vector<double> others = parts_of_finest(finest);
  for (double& other : others) other *= seconds;
  return seconds + clock_seconds(others, threads);
}

Affordable affordable_levels(const std::vector<LevelCost>& costs, size_t measured,
                             const std::function<double(size_t)>& clock,
                             const LadderLimits& limits) {
  double bytes = 0;
  for (size_t k = 0; k < measured; ++k) bytes += costs[k].bytes;
  for (size_t k = measured; k < costs.size(); ++k) {
    const double seconds = clock(k);
    bytes += costs[k].bytes;
    const std::string level = fmt::format("level {} of {}", k + 1, costs.size());
    if (seconds > limits.seconds)
      return {int(k), fmt::format("{} would take {}, the ladder up to it {}; --hours allows {}",
                                  level, duration_text(costs[k].seconds), duration_text(seconds),
                                  duration_text(limits.seconds))};
    if (bytes > limits.bytes)
      return {int(k), fmt::format("{} would keep {:.3g} GB, the ladder up to it {:.3g} GB; {:.3g} "
                                  "GB of memory are available",
                                  level, costs[k].bytes / 1e9, bytes / 1e9, limits.bytes / 1e9)};
  }
  return {int(costs.size()), ""};
}

std::string duration_text(double seconds) {
  if (seconds < 90) return fmt::format("{:.2g} s", seconds);
  return seconds < 5400 ? fmt::format("{:.3g} min", seconds / 60)
                        : fmt::format("{:.3g} h", seconds / 3600);
}

}  // namespace foldproof
