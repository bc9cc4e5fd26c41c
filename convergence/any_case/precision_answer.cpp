// One method's error against its work, over all its runs, and prices of wanted errors.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "convergence/any_case/precision.h"
#include "convergence/work_precision/precision_problem.h"

namespace foldproof {

namespace {

/// How contact and strain limits act in the last two halvings, where it may explain why a method
/// has no order; "" where they do not act.
std::string how_filters_act(const TrialLevels& levels) {
  const auto ladder = fine_end(levels);
  if (ladder.size() < 2) return "";
  const auto rate = [&](size_t back, const auto& count) {
    const LevelRun& run = *ladder[ladder.size() - back].second;
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
  const auto energy = [](const LevelRun& run) {
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
  MethodCurve curve{{method, {}}, method_bar(plan, method, levels)};
  if (!curve.bar.reason.empty()) curve.bar.reason += how_filters_act(levels);
  const double frames = plan.input_case.scene.schedule.end / frame_of(plan);
  for (const auto& [parts, run] : levels) {
    if (run.over_budget > 0) continue;
    double error = nan;
    if (is_whole(run)) error = frame_distance(run.x, truth.first.x, plan.mass) / truth.motion;
    if (!(error <= diverged_error)) error = nan;
    curve.runs.push_back({int(std::lround(parts * frames)), error, operator_applications(run.work),
                          run.seconds, std::isnan(error) ? std::max(run.part, 1e-3) : 1, run.work,
                          parts, run.stopped});
  }
  for (size_t k = curve.runs.size(); k-- > 0;) {
    const double step = frame_of(plan) / curve.runs[k].parts;
    if (std::isnan(curve.runs[k].error)) {
      curve.unstable_step = step;
      break;
    }
    curve.stable_step = step;
  }
  return curve;
}

std::string why_not_reached(const PrecisionPlan& plan, const MethodCurve& curve, double wanted) {
  if (!curve.runs.empty() && curve.runs.back().error <= wanted)
    return fmt::format("no step that was tried is stable in a run until {:.3g} s",
                       lasting_end(plan));
  for (auto run = curve.runs.rbegin(); run != curve.runs.rend(); ++run)
    if (!std::isnan(run->error))
      return fmt::format(
          "with {} steps a frame its error is {:.2g} %; less would need more work than the budget, "
          "or {:.0f} times the cheapest method's",
          run->parts, 100 * run->error, dearest);
  if (curve.runs.empty()) return "its work exceeds the budget at every step";
  const std::string& last = curve.runs.back().stopped;
  return last.empty() ? "it is unstable at every step that was tried"
                      : "every run stops early: " + last;
}

MethodPrice price_of_error(const MethodCurve& curve, const PrecisionPlan& plan, double wanted) {
  const Bracket bracket = bracket_of(plan, curve, wanted);
  MethodPrice price{curve.method, price_at(curve, plan.input_case.scene.schedule.end, wanted),
                    bracket.few == 0 ? 1 : double(bracket.many) / bracket.few};
  if (!std::isnan(price.price.step))
    price.whole_step = frame_of(plan) / parts_of(plan, price.price.step);
  if (const LongerRun* run = longer_run_of(curve.longer, price.whole_step))
    price.energy_gain = energy_gain(*run);
  if (price.price.limit == LimitedBy::not_reached)
    price.because = why_not_reached(plan, curve, wanted);
  return price;
}

/// The price of the wanted error, or of a smaller one whose run turned out cheaper: what reaches
/// that reaches this.
MethodPrice price_of_method(const MethodCurve& curve, const PrecisionPlan& plan, double wanted,
                            double least) {
  MethodPrice best = price_of_error(curve, plan, wanted);
  for (const double smaller : plan.wanted) {
    if (!(smaller < wanted) || smaller < least) continue;
    const MethodPrice other = price_of_error(curve, plan, smaller);
    const bool is_reached = !std::isnan(other.price.applications);
    if (is_reached && !(best.price.applications <= other.price.applications)) best = other;
  }
  return best;
}

/// Of the runs that the budget ended.
EndedRun furthest_of(const TrialRuns& runs) {
  EndedRun furthest;
  for (const auto& [method, levels] : runs)
    for (const auto& [parts, run] : levels)
      if (run.over_budget > 0 && run.part > furthest.part)
        furthest = {method, parts, run.part, run.seconds};
  return furthest;
}

}  // namespace

int parts_of(const PrecisionPlan& plan, double step) {
  return int(std::ceil(frame_of(plan) / step * (1 - 1e-9)));
}

Bracket bracket_of(const PrecisionPlan& plan, const MethodCurve& curve, double wanted) {
  const double step = price_at(curve, plan.input_case.scene.schedule.end, wanted).step;
  if (std::isnan(step)) return {};
  const auto fine = std::ranges::find_if(
      curve.runs, [&](const PrecisionRun& run) { return run.parts >= parts_of(plan, step); });
  if (fine == curve.runs.begin() || fine == curve.runs.end()) return {};
  const double unstable = shortest_unstable_step(curve.longer);
  const int too_few = std::isfinite(unstable) ? int(std::lround(frame_of(plan) / unstable)) : 0;
  return {std::max(std::prev(fine)->parts, too_few), fine->parts};
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
    curves.back().longer = longer_runs_of(plan, levels_of(trials.longer, method));
  }
  return curves;
}

PriceList price_list(const PrecisionPlan& plan, const CaseTruth& truth,
                     const std::vector<MethodCurve>& curves, double wanted) {
  PriceList list{wanted, {}};
  const bool is_known = wanted >= least_error(truth);
  for (const MethodCurve& curve : curves) {
    if (!std::ranges::count(plan.methods, curve.method)) continue;
    MethodPrice price = price_of_method(curve, plan, wanted, least_error(truth));
    if (!is_known) {
      price.price = {};
      price.because = "the truth is not known to a tenth of this error";
    }
    list.prices.push_back(price);
  }
  const auto cost = [](const MethodPrice& price) {
    return std::isnan(price.price.applications) ? INFINITY : price.price.applications;
  };
  std::ranges::stable_sort(list.prices, {}, cost);
  const MethodPrice best = list.prices.front();
  for (MethodPrice& price : list.prices) {
    price.over_best = price.price.applications / best.price.applications;
    price.is_tied =
        price.method != best.method && price.over_best <= std::max(price.spacing, best.spacing);
  }
  return list;
}

std::vector<const MethodPrice*> winners(const PriceList& list) {
  std::vector<const MethodPrice*> found;
  const MethodPrice* fastest = nullptr;
  for (const MethodPrice& price : list.prices) {
    if (std::isnan(price.price.applications)) continue;
    if (found.empty() || price.is_tied) found.push_back(&price);
    if (!fastest || price.price.seconds < fastest->price.seconds) fastest = &price;
  }
  if (fastest && !std::ranges::count(found, fastest)) found.push_back(fastest);
  return found;
}

PrecisionAnswer precision_answer(const PrecisionPlan& plan, const Trials& trials) {
  PrecisionAnswer answer{plan, case_truth(plan, trials.runs), {}, {}};
  answer.curves = method_curves(plan, trials, answer.truth);
  for (const double wanted : plan.wanted)
    answer.lists.push_back(price_list(plan, answer.truth, answer.curves, wanted));
  answer.furthest = furthest_of(trials.runs);
  return answer;
}

}  // namespace foldproof
