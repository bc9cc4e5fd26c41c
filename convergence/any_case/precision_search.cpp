// Which runs to make next, until all is answered or exceeds the budget.
#include <algorithm>
#include <cmath>
#include <functional>
#include <ranges>
#include <set>

#include "convergence/any_case/precision.h"
#include "convergence/work_precision/precision_problem.h"

namespace foldproof {

namespace {

// of the step over the elastic limit at the start: if it fails, shorter do
constexpr double hopeless_step = 1. / 16;
constexpr double truth_budget = 2.5;  // of a run for the truth over that of others [1]
constexpr double least_solve = 8;     // applications of an implicit step, at least [1]
constexpr int levels_wanted = 3;      // of a method that finish
constexpr double contender = 2.5;     // of a price over the cheapest whose bracket is narrowed

/// The input of next_trials.
struct Survey {
  const PrecisionPlan& plan;
  const Trials& trials;
  CaseTruth truth;
  std::vector<MethodCurve> curves;
};

const MethodCurve& curve_of(const Survey& survey, const std::string& method) {
  return *std::ranges::find(survey.curves, method, &MethodCurve::method);
}

Price price_of(const Survey& survey, const MethodCurve& curve, double wanted) {
  return price_at(curve, survey.plan.input_case.scene.schedule.end, wanted);
}

/// The least work that any method pays for the error; infinite if none reaches it.
double least_work(const Survey& survey, double wanted) {
  double least = INFINITY;
  for (const MethodCurve& curve : survey.curves)
    if (const double work = price_of(survey, curve, wanted).applications; work < least)
      least = work;
  return least;
}

/// The least work for the smallest error that a method reaches; infinite if none does.
double cheapest_work(const Survey& survey) {
  for (const double wanted : survey.plan.wanted | std::views::reverse)
    if (const double least = least_work(survey, wanted); std::isfinite(least)) return least;
  return INFINITY;
}

using Cost = std::function<double(const LevelRun&)>;

/// Predicted cost of a run with so many steps a frame: the last two halvings continued linearly, or
/// one alone in proportion. Work of implicit solves hardly grows before steps are short: theirs is
/// that of the last run and, for each step more, at least least_solve.
double expected_cost(const TrialLevels& levels, Family family, double parts, const Cost& cost) {
  const int last = finest(levels).first;
  const LevelRun& run = levels.at(last);
  const double now = cost(run);
  double each = now / last;
  const auto before = levels.find(last / 2);
  const bool has_two = before != levels.end() && is_whole(before->second) && is_whole(run);
  if (has_two) each = std::max(0., now - cost(before->second)) / (last - before->first);
  if (family == Family::fully_implicit) {
    const double least = least_solve * double(run.steps) / last * now /
                         std::max(1., operator_applications(run.work));
    each = has_two ? std::max(each, least) : least;
  }
  return now + each * (parts - last);
}

bool is_affordable(const Survey& survey, const std::string& method, double parts, double most_work,
                   double budget) {
  const Scene& scene = survey.plan.input_case.scene;
  const TrialLevels& levels = survey.trials.runs.at(method);
  const Family family = family_of(method);
  const auto whole = [](const LevelRun& run) { return std::max(run.part, 1e-3); };
  return expected_cost(levels, family, parts,
                       [&](const LevelRun& run) { return visits(scene, run.work) / whole(run); }) <=
             budget &&
         expected_cost(levels, family, parts, [&](const LevelRun& run) {
           return operator_applications(run.work) / whole(run);
         }) <= most_work;
}

/// The method's order as far as it showed in its last two halvings, at most its formal one.
double seen_order(const MethodCurve& curve, const std::string& method) {
  const double formal = integrator_named(method).order;
  const PrecisionRun& last = curve.runs.back();
  const auto before = std::ranges::find(curve.runs, last.parts / 2, &PrecisionRun::parts);
  if (before == curve.runs.end()) return formal;
  const double order = std::log2(before->error / last.error);
  return std::isnan(order) ? formal : std::clamp(order, 0.01, formal);
}

/// Steps a frame with which the method would reach the largest wanted error that it has not, by the
/// order that it showed; 0 if it has reached them all, with a step that lasts as far as is known.
double parts_needed(const Survey& survey, const std::string& method, int parts, double error) {
  const double order = seen_order(curve_of(survey, method), method);
  for (const double wanted : survey.plan.wanted)
    if (std::isnan(error) || error > wanted) return parts * std::pow(error / wanted, 1 / order);
  const double unstable = shortest_unstable_step(curve_of(survey, method).longer);
  return frame_of(survey.plan) / parts < unstable * (1 - 1e-9) ? 0 : 2. * parts;
}

bool needs_halving(const Survey& survey, const std::string& method, double most_work) {
  const TrialLevels& levels = survey.trials.runs.at(method);
  const auto [parts, run] = finest(levels);
  const int first = survey.plan.first.at(method);
  if (2 * parts > most_parts) return false;
  if (run->over_budget > 0)  // long steps can be dearer than short ones, for Newton's method
    return family_of(method) == Family::fully_implicit && parts < beyond_limit * first;
  const auto affordable = [&](double steps) {
    return steps < most_parts &&
           is_affordable(survey, method, steps, most_work, survey.plan.budget);
  };
  if (!is_whole(*run)) {
    // a diverging run's solves end at their cap: its cost does not predict that of shorter steps
    const bool is_predicted = family_of(method) != Family::mixed;
    return parts * hopeless_step < beyond_limit * first &&
           (!is_predicted || affordable(2. * parts));
  }
  const size_t whole = fine_end(levels).size();
  const double error = curve_of(survey, method).runs.back().error;
  const double needed = parts_needed(survey, method, parts, error);
  if (needed > parts && !affordable(needed)) return false;
  if (whole < 2 && family_of(method) == Family::fully_implicit) return true;
  return affordable(2. * parts) && (needed > 0 || whole < levels_wanted);
}

/// The longest step that came to an end is not known to be the longest: for a fully implicit method
/// that matters only where it is exact enough.
bool needs_coarser(const Survey& survey, const std::string& method) {
  const auto& [coarsest, run] = *survey.trials.runs.at(method).begin();
  if (!is_whole(run) || coarsest % 2 != 0) return false;
  const double error = curve_of(survey, method).runs.front().error;
  return error <= (family_of(method) == Family::fully_implicit ? survey.plan.wanted.front()
                                                               : diverged_error);
}

/// The method's next run on its ladder of halved steps; parts 0: none.
PrecisionTrial next_on_ladder(const Survey& survey, const std::string& method, double most_work) {
  const auto found = survey.trials.runs.find(method);
  if (found == survey.trials.runs.end())
    return {method, survey.plan.first.at(method), survey.plan.budget};
  if (needs_coarser(survey, method))
    return {method, found->second.begin()->first / 2, survey.plan.budget};
  if (needs_halving(survey, method, most_work))
    return {method, 2 * finest(found->second).first, survey.plan.budget};
  return {method, 0, 0};
}

std::vector<PrecisionTrial> refined_truth(const Survey& survey) {
  std::vector<PrecisionTrial> trials;
  if (survey.truth.uncertainty <= truth_part * survey.plan.wanted.back()) return trials;
  for (const Opinion* opinion : {&survey.truth.first, &survey.truth.second}) {
    if (opinion->parts == 0) continue;
    const TrialLevels& levels = survey.trials.runs.at(opinion->method);
    const auto [parts, run] = finest(levels);
    const double budget = truth_budget * survey.plan.budget;
    if (is_whole(*run) && is_affordable(survey, opinion->method, 2. * parts, INFINITY, budget))
      trials.push_back({opinion->method, 2 * parts, budget});
  }
  return trials;
}

std::vector<PrecisionTrial> narrowed_brackets(const Survey& survey) {
  std::vector<PrecisionTrial> trials;
  for (const double wanted : survey.plan.wanted) {
    if (!(wanted >= least_error(survey.truth))) continue;
    const double least = least_work(survey, wanted);
    for (const MethodCurve& curve : survey.curves) {
      const auto [few, many] = bracket_of(survey.plan, curve, wanted);
      if (few == 0 || !(price_of(survey, curve, wanted).applications <= contender * least))
        continue;
      const PrecisionTrial middle{curve.method, (few + many) / 2, survey.plan.budget};
      if (many > narrow * few && many - few > 1 && !std::ranges::count(trials, middle))
        trials.push_back(middle);
    }
  }
  return trials;
}

/// Runs until lasting_end of the steps that win or tie, and of half of them.
std::vector<PrecisionTrial> longer_trials(const Survey& survey) {
  std::map<std::string, std::set<int>> asked;
  for (const auto& [method, levels] : survey.trials.longer)
    for (const auto& [parts, run] : levels) asked[method].insert(parts);
  std::vector<PrecisionTrial> trials;
  for (const double wanted : survey.plan.wanted) {
    const PriceList list = price_list(survey.plan, survey.truth, survey.curves, wanted);
    for (const MethodPrice* price : winners(list))
      for (const int halves : {1, 2}) {
        const int parts = halves * parts_of(survey.plan, price->price.step);
        const double budget = halves * dearest_trial * survey.plan.budget;
        if (asked[price->method].insert(parts).second)
          trials.push_back({price->method, parts, budget, survey.plan.lasting_times});
      }
  }
  return trials;
}

}  // namespace

std::vector<PrecisionTrial> next_trials(const PrecisionPlan& plan, const Trials& trials) {
  const CaseTruth truth = case_truth(plan, trials.runs);
  const Survey survey{plan, trials, truth, method_curves(plan, trials, truth)};
  const double most_work = dearest * cheapest_work(survey);
  std::vector<PrecisionTrial> next;
  // whose steps are dear; by then it is known how dear
  for (const bool is_implicit : {false, true}) {
    if (!next.empty()) break;
    for (const std::string& method : all_methods(plan)) {
      if ((family_of(method) == Family::fully_implicit) != is_implicit) continue;
      const PrecisionTrial trial = next_on_ladder(survey, method, most_work);
      if (trial.parts > 0) next.push_back(trial);
    }
  }
  if (next.empty()) next = refined_truth(survey);
  if (next.empty()) next = narrowed_brackets(survey);
  if (next.empty()) next = longer_trials(survey);
  return next;
}

}  // namespace foldproof
