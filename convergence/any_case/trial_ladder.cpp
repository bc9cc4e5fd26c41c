#include "convergence/any_case/trial_ladder.h"

#include <algorithm>

#include "convergence/any_case/distances.h"
#include "reference/dynamics/integrator.h"

namespace foldproof {

namespace {

bool is_halving(int parts) { return (parts & (parts - 1)) == 0; }

}  // namespace

bool is_whole(const TrialRun& run) { return run.stopped.empty() && !run.x.empty(); }

double frame_of(const PrecisionPlan& plan) {
  const Schedule& schedule = plan.input_case.scene.schedule;
  return std::min(schedule.frame_interval, schedule.end);
}

double frame_distance(const std::vector<PerParticle3>& a, const std::vector<PerParticle3>& b,
                      const PerParticle& mass) {
  return a.size() == b.size() && !a.empty() ? largest_difference(a, b, mass) : nan;
}

std::vector<std::pair<int, const TrialRun*>> fine_end(const TrialLevels& levels) {
  std::vector<std::pair<int, const TrialRun*>> ladder;
  for (auto level = levels.rbegin(); level != levels.rend(); ++level) {
    if (!is_halving(level->first)) continue;
    if (!is_whole(level->second)) {
      if (ladder.empty() && level->second.over_budget > 0) continue;
      break;
    }
    if (!ladder.empty() && 2 * level->first != ladder.back().first) break;
    ladder.emplace_back(level->first, &level->second);
  }
  std::ranges::reverse(ladder);
  return ladder;
}

std::pair<int, const TrialRun*> finest(const TrialLevels& levels) {
  for (auto level = levels.rbegin(); level != levels.rend(); ++level)
    if (is_halving(level->first)) return {level->first, &level->second};
  return {0, nullptr};
}

ErrorBar ladder_bar(const PrecisionPlan& plan, const std::string& method,
                    const TrialLevels& levels) {
  const auto ladder = fine_end(levels);
  ErrorBar bar;
  if (ladder.size() < 2) {
    bar.reason = "fewer than three halved steps came to an end";
    return bar;
  }
  Ladder differences;
  for (size_t k = 0; k + 1 < ladder.size(); ++k)
    differences.differences.push_back(
        frame_distance(ladder[k].second->x, ladder[k + 1].second->x, plan.mass));
  differences.formal_order = integrator_named(method).order;
  differences.floor = 1e3 * epsilon * longest_side(plan.input_case.scene.x);
  if (ladder.size() >= 3) return error_bar(differences);
  bar.reason = "fewer than three halved steps came to an end";
  bar.half_width = 3 * differences.differences.back();
  return bar;
}

Family family_of(const std::string& method) { return integrator_named(method).family; }

std::vector<std::string> all_methods(const PrecisionPlan& plan) {
  std::vector<std::string> all = plan.methods;
  all.insert(all.end(), plan.for_truth.begin(), plan.for_truth.end());
  return all;
}

}  // namespace foldproof
