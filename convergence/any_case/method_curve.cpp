// One method's error against its work, over all its runs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "convergence/any_case/precision.h"
#include "convergence/any_case/trial_ladder.h"

namespace foldproof {

namespace {

/// How contact and strain limits act in the last two halvings, where it may explain why a method
/// has no order; "" where they do not act.
std::string how_filters_act(const TrialLevels& levels) {
  const auto ladder = fine_end(levels);
  if (ladder.size() < 2) return "";
  const auto rate = [&](size_t back, const auto& count) {
    const TrialRun& run = *ladder[ladder.size() - back].second;
    return double(count(run.work)) / std::max(1., double(run.steps));
  };
  std::string words;
  const auto add = [&](const char* name, const auto& count) {
    if (rate(1, count) > 0 || rate(2, count) > 0)
      words +=
          fmt::format("; {} a step: {:.3g}, then {:.3g}", name, rate(2, count), rate(1, count));
  };
  add("contacts with objects", [](const Work& w) { return w.object_contacts; });
  add("close pairs of cloth", [](const Work& w) { return w.close_pairs + w.crossings; });
  add("strain sweeps", [](const Work& w) { return w.strain_sweeps; });
  add("bonds", [](const Work& w) { return w.bonds; });
  return words;
}

/// Of each step that was tried, with half of it, where neither run exceeded its budget.
std::vector<LongerRun> longer_runs_of(const PrecisionPlan& plan, const TrialLevels& levels) {
  std::vector<LongerRun> asked;
  const auto energy = [](const TrialRun& run) {
    return is_whole(run) ? run.energy : LongerEnergy{nan, nan};
  };
  for (const auto& [parts, run] : levels)
    if (const auto half = levels.find(2 * parts); half != levels.end() && run.over_budget == 0 &&
                                                  !(is_whole(run) && half->second.over_budget > 0))
      asked.push_back({frame_of(plan) / parts, energy(run), energy(half->second)});
  return asked;
}

MethodCurve method_curve(const PrecisionPlan& plan, const std::string& method,
                         const TrialLevels& levels, const CaseTruth& truth) {
  MethodCurve curve{
      method, {integrator_named(method), {}}, {}, {}, ladder_bar(plan, method, levels)};
  if (!curve.bar.reason.empty()) curve.bar.reason += how_filters_act(levels);
  const double frames = plan.input_case.scene.schedule.end / frame_of(plan);
  for (const auto& [parts, run] : levels) {
    if (run.over_budget > 0) continue;
    double error = nan;
    if (is_whole(run)) error = frame_distance(run.x, truth.first.x, plan.mass) / truth.motion;
    if (!(error <= diverged_error)) error = nan;
    curve.curve.runs.push_back({int(std::lround(parts * frames)), error,
                                operator_applications(run.work), run.seconds,
                                std::isnan(error) ? std::max(run.part, 1e-3) : 1, run.work});
    curve.parts.push_back(parts);
    curve.stopped.push_back(run.stopped);
  }
  for (size_t k = curve.parts.size(); k-- > 0;) {
    const double step = frame_of(plan) / curve.parts[k];
    if (std::isnan(curve.curve.runs[k].error)) {
      curve.unstable_step = step;
      break;
    }
    curve.stable_step = step;
  }
  return curve;
}

}  // namespace

TrialRun& run_of(Trials& trials, const PrecisionTrial& trial) {
  return (trial.times > 1 ? trials.longer : trials.runs)[trial.method][trial.parts];
}

int parts_of(const PrecisionPlan& plan, double step) {
  return int(std::ceil(frame_of(plan) / step * (1 - 1e-9)));
}

Bracket bracket_of(const PrecisionPlan& plan, const MethodCurve& curve, double wanted) {
  const double step = price_at(curve.curve, plan.input_case.scene.schedule.end, wanted).step;
  if (std::isnan(step)) return {};
  const auto fine =
      std::ranges::find_if(curve.parts, [&](int parts) { return parts >= parts_of(plan, step); });
  if (fine == curve.parts.begin() || fine == curve.parts.end()) return {};
  const double unstable = shortest_unstable_step(curve.curve.longer);
  const int too_few = std::isfinite(unstable) ? int(std::lround(frame_of(plan) / unstable)) : 0;
  return {std::max(*std::prev(fine), too_few), *fine};
}

std::vector<MethodCurve> method_curves(const PrecisionPlan& plan, const Trials& trials,
                                       const CaseTruth& truth) {
  const auto levels_of = [](const TrialRuns& runs, const std::string& method) {
    const auto levels = runs.find(method);
    return levels == runs.end() ? TrialLevels() : levels->second;
  };
  std::vector<MethodCurve> curves;
  for (const std::string& method : all_methods(plan)) {
    curves.push_back(method_curve(plan, method, levels_of(trials.runs, method), truth));
    curves.back().curve.longer = longer_runs_of(plan, levels_of(trials.longer, method));
  }
  return curves;
}

}  // namespace foldproof
