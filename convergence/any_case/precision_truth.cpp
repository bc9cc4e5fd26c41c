// Where the cloth is in truth: two methods' best estimates that agree.
#include <algorithm>
#include <cmath>

#include "convergence/any_case/distances.h"
#include "convergence/any_case/precision.h"
#include "convergence/any_case/trial_ladder.h"

namespace foldproof {

namespace {

constexpr double least_motion = 1e-9;  // over the cloth's extent: less is rounding [1]

Opinion opinion_of(const PrecisionPlan& plan, const std::string& method,
                   const TrialLevels& levels) {
  Opinion opinion{method, 0, false, {}, nan};
  const auto ladder = fine_end(levels);
  if (ladder.size() < 2) return opinion;
  const ErrorBar bar = ladder_bar(plan, method, levels);
  opinion.parts = ladder.back().first;
  opinion.x = ladder.back().second->x;
  opinion.half_width = bar.half_width;
  if (bar.reading != Reading::asymptotic) return opinion;
  opinion.is_extrapolated = true;
  const double order = std::min(bar.order, double(integrator_named(method).order));
  const std::vector<PerParticle3>& coarse = ladder[ladder.size() - 2].second->x;
  for (size_t k = 0; k < opinion.x.size(); ++k)
    opinion.x[k] += (opinion.x[k] - coarse[k]) / (std::pow(2, order) - 1);
  return opinion;
}

}  // namespace

CaseTruth case_truth(const PrecisionPlan& plan, const TrialRuns& runs) {
  std::vector<Opinion> opinions;
  for (const auto& [method, levels] : runs) {
    Opinion opinion = opinion_of(plan, method, levels);
    if (std::isfinite(opinion.half_width)) opinions.push_back(std::move(opinion));
  }
  std::ranges::stable_sort(opinions, {}, &Opinion::half_width);
  CaseTruth truth;
  if (opinions.empty()) return truth;
  truth.first = opinions.front();
  truth.motion = largest_motion(truth.first.x, plan.mass);
  if (!(truth.motion > least_motion * longest_side(plan.input_case.scene.x))) return truth;
  const auto second = std::ranges::find_if(opinions, [&](const Opinion& opinion) {
    return family_of(opinion.method) != family_of(truth.first.method);
  });
  if (second == opinions.end()) return truth;
  truth.second = *second;
  truth.uncertainty = frame_distance(truth.first.x, truth.second.x, plan.mass) / truth.motion;
  return truth;
}

}  // namespace foldproof
