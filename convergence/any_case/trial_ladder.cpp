#include "convergence/any_case/trial_ladder.h"

#include <algorithm>

#include "convergence/any_case/distances.h"
#include "reference/dynamics/integrator.h"

namespace foldproof {

int first_parts(double frame, double limit) {
  int parts = 1;
  while (parts < most_parts && frame / parts > beyond_limit * limit) parts *= 2;
  return parts;
}

bool is_halving(int parts) { return (parts & (parts - 1)) == 0; }

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

ErrorBar halved_steps_bar(const std::vector<const std::vector<PerParticle3>*>& runs,
                          const PerParticle& mass, double formal_order, double floor) {
  Ladder ladder;
  for (size_t k = 1; k < runs.size(); ++k)
    ladder.differences.push_back(frame_distance(*runs[k - 1], *runs[k], mass));
  ladder.formal_order = formal_order;
  ladder.floor = floor;
  if (runs.size() >= 3) return error_bar(ladder);
  ErrorBar bar;
  bar.reason = "fewer than three halved steps came to an end";
  if (runs.size() == 2) bar.half_width = 3 * ladder.differences.back();
  return bar;
}

ErrorBar ladder_bar(const PrecisionPlan& plan, const std::string& method,
                    const TrialLevels& levels) {
  std::vector<const std::vector<PerParticle3>*> runs;
  for (const auto& [parts, run] : fine_end(levels)) runs.push_back(&run->x);
  return halved_steps_bar(runs, plan.mass, integrator_named(method).order,
                          1e3 * epsilon * longest_side(plan.input_case.scene.x));
}

Family family_of(const std::string& method) { return integrator_named(method).family; }

std::vector<std::string> all_methods(const PrecisionPlan& plan) {
  std::vector<std::string> all = plan.methods;
  all.insert(all.end(), plan.for_truth.begin(), plan.for_truth.end());
  return all;
}

}  // namespace foldproof
