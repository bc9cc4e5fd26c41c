#include "convergence/any_case/precision.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "convergence/any_case/distances.h"
#include "reference/forces/force.h"

namespace foldproof {

namespace {

constexpr double beyond_limit = 4;  // of the first step over the elastic limit at the start [1]
constexpr double hopeless_step = 1. / 16;  // of the step over that limit: if it fails, shorter do
constexpr double truth_budget = 2.5;       // of a run for the truth over that of others [1]
constexpr int most_parts = 1 << 20;        // steps a frame
constexpr double least_solve = 8;          // applications of an implicit step, at least [1]
constexpr int levels_wanted = 3;           // of a method that come to an end
constexpr double least_motion = 1e-9;      // over the cloth's extent: less is rounding [1]
constexpr double narrow = 1.3;             // of steps between which a price lies
constexpr double contender = 2.5;          // of a price over the cheapest whose bracket is narrowed

using Levels = std::map<int, TrialRun>;

bool is_whole(const TrialRun& run) { return run.stopped.empty() && !run.x.empty(); }

bool is_halving(int parts) { return (parts & (parts - 1)) == 0; }

double frame_of(const PrecisionPlan& plan) {
  const Schedule& schedule = plan.input_case.scene.schedule;
  return std::min(schedule.frame_interval, schedule.end);
}

/// The largest over frames [m]; NaN where they are not the same frames.
double distance(const std::vector<PerParticle3>& a, const std::vector<PerParticle3>& b,
                const PerParticle& mass) {
  return a.size() == b.size() && !a.empty() ? largest_difference(a, b, mass) : nan;
}

/// The whole runs at the fine end of the ladder of halved steps, each with twice as many steps as
/// the one before, coarse to fine.
std::vector<std::pair<int, const TrialRun*>> fine_end(const Levels& levels) {
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

ErrorBar bar_of(const PrecisionPlan& plan, const std::string& method, const Levels& levels) {
  const auto ladder = fine_end(levels);
  ErrorBar bar;
  if (ladder.size() < 2) {
    bar.reason = "fewer than three halved steps came to an end";
    return bar;
  }
  Ladder differences;
  for (size_t k = 0; k + 1 < ladder.size(); ++k)
    differences.differences.push_back(
        distance(ladder[k].second->x, ladder[k + 1].second->x, plan.mass));
  differences.formal_order = integrator_named(method).order;
  differences.floor = 1e3 * epsilon * longest_side(plan.input_case.scene.x);
  if (ladder.size() >= 3) return error_bar(differences);
  bar.reason = "fewer than three halved steps came to an end";
  bar.half_width = 3 * differences.differences.back();
  return bar;
}

Opinion opinion_of(const PrecisionPlan& plan, const std::string& method, const Levels& levels) {
  Opinion opinion{method, 0, false, {}, nan};
  const auto ladder = fine_end(levels);
  if (ladder.size() < 2) return opinion;
  const ErrorBar bar = bar_of(plan, method, levels);
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

Family family_of(const std::string& method) { return integrator_named(method).family; }

std::vector<std::string> all_methods(const PrecisionPlan& plan) {
  std::vector<std::string> all = plan.methods;
  all.insert(all.end(), plan.for_truth.begin(), plan.for_truth.end());
  return all;
}

/// Of the order of the table of integrators, each once.
std::vector<std::string> in_order(const std::vector<std::string>& methods) {
  for (const std::string& method : methods) integrator_named(method);
  std::vector<std::string> ordered;
  for (const Integrator& integrator : integrators())
    if (std::ranges::count(methods, integrator.name)) ordered.emplace_back(integrator.name);
  return ordered;
}

/// One method of each family that is missed.
std::vector<std::string> methods_for_truth(const std::vector<std::string>& methods) {
  std::vector<std::string> added;
  for (const char* candidate : {"B", "RK4", "implicit-midpoint"})
    if (std::ranges::none_of(methods, [&](const std::string& method) {
          return family_of(method) == family_of(candidate);
        }))
      added.emplace_back(candidate);
  return added;
}

/// The limit that the automatic step of a method is taken from, at the start [s].
double limit_of(const BuiltScene& built, const Integrator& integrator) {
  double limit = elastic_limit(built.system, built.start);
  if (integrator.damping_widens_limit) limit = widened_limit(built.system, built.start, limit);
  if (integrator.family != Family::fully_explicit) return limit;
  Work uncounted;
  return std::min(limit,
                  2 / damping_rate_bound(damping_at(built.system.forces, built.start, uncounted),
                                         built.system.inverse_mass));
}

int first_parts(double frame, double limit) {
  int parts = 1;
  while (parts < most_parts && frame / parts > beyond_limit * limit) parts *= 2;
  return parts;
}

/// The input of next_trials.
struct Survey {
  const PrecisionPlan& plan;
  const TrialRuns& runs;
  CaseTruth truth;
  std::vector<MethodCurve> curves;
};

const MethodCurve& curve_of(const Survey& survey, const std::string& method) {
  return *std::ranges::find(survey.curves, method, &MethodCurve::method);
}

Price price_of(const Survey& survey, const MethodCurve& curve, double wanted) {
  return price_at(curve.curve, survey.plan.input_case.scene.schedule.end, wanted);
}

/// The least work that any method pays for the smallest error that one
/// reaches; infinite if none does.
double cheapest_work(const Survey& survey) {
  for (auto wanted = survey.plan.wanted.rbegin(); wanted != survey.plan.wanted.rend(); ++wanted) {
    double least = INFINITY;
    for (const MethodCurve& curve : survey.curves) {
      const double work = price_of(survey, curve, *wanted).applications;
      if (work < least) least = work;
    }
    if (std::isfinite(least)) return least;
  }
  return INFINITY;
}

/// The finest of the halved steps.
std::pair<int, const TrialRun*> finest(const Levels& levels) {
  for (auto level = levels.rbegin(); level != levels.rend(); ++level)
    if (is_halving(level->first)) return {level->first, &level->second};
  return {0, nullptr};
}

using Cost = std::function<double(const TrialRun&)>;

/// Predicted cost of a run with so many steps a frame: the last two halvings continued linearly, or
/// one alone in proportion. Work of implicit solves hardly grows before steps are short: theirs is
/// that of the last run and, for each step more, at least least_solve.
double expected_cost(const Levels& levels, Family family, double parts, const Cost& cost) {
  const int last = finest(levels).first;
  const TrialRun& run = levels.at(last);
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
  const Levels& levels = survey.runs.at(method);
  const Family family = family_of(method);
  const auto whole = [](const TrialRun& run) { return std::max(run.part, 1e-3); };
  return expected_cost(levels, family, parts,
                       [&](const TrialRun& run) { return visits(scene, run.work) / whole(run); }) <=
             budget &&
         expected_cost(levels, family, parts, [&](const TrialRun& run) {
           return operator_applications(run.work) / whole(run);
         }) <= most_work;
}

/// The method's order as far as it showed in its last two halvings, at most its formal one.
double seen_order(const MethodCurve& curve, const std::string& method) {
  const double formal = integrator_named(method).order;
  const auto last = std::ranges::find(curve.parts, curve.parts.back() / 2);
  if (last == curve.parts.end()) return formal;
  const double before = curve.curve.runs[size_t(last - curve.parts.begin())].error;
  const double order = std::log2(before / curve.curve.runs.back().error);
  return std::isnan(order) ? formal : std::clamp(order, 0.01, formal);
}

/// Steps a frame with which the method would reach the largest wanted error that it has not, by the
/// order that it showed; 0 if it has reached them all.
double parts_needed(const Survey& survey, const std::string& method, int parts, double error) {
  const double order = seen_order(curve_of(survey, method), method);
  for (const double wanted : survey.plan.wanted)
    if (std::isnan(error) || error > wanted) return parts * std::pow(error / wanted, 1 / order);
  return 0;
}

bool needs_halving(const Survey& survey, const std::string& method, double most_work) {
  const Levels& levels = survey.runs.at(method);
  const auto [parts, run] = finest(levels);
  const int first = survey.plan.first.at(method);
  if (2 * parts > most_parts) return false;
  if (run->over_budget > 0)  // long steps can be dearer than short ones, for Newton's method
    return family_of(method) == Family::fully_implicit && parts < beyond_limit * first;
  const auto affordable = [&](double steps) {
    return steps < most_parts &&
           is_affordable(survey, method, steps, most_work, survey.plan.budget);
  };
  if (!is_whole(*run))
    return parts * hopeless_step < beyond_limit * first && affordable(2. * parts);
  const size_t whole = fine_end(levels).size();
  const double error = curve_of(survey, method).curve.runs.back().error;
  const double needed = parts_needed(survey, method, parts, error);
  if (needed > parts && !affordable(needed)) return false;
  if (whole < 2 && family_of(method) == Family::fully_implicit) return true;
  return affordable(2. * parts) && (needed > 0 || whole < levels_wanted);
}

/// The longest step that came to an end is not known to be the longest: for a fully implicit method
/// that matters only where it is exact enough.
bool needs_coarser(const Survey& survey, const std::string& method) {
  const auto& [coarsest, run] = *survey.runs.at(method).begin();
  if (!is_whole(run) || coarsest % 2 != 0) return false;
  const double error = curve_of(survey, method).curve.runs.front().error;
  return error <= (family_of(method) == Family::fully_implicit ? survey.plan.wanted.front()
                                                               : diverged_error);
}

/// The method's next run on its ladder of halved steps; parts 0: none.
PrecisionTrial next_on_ladder(const Survey& survey, const std::string& method, double most_work) {
  const auto found = survey.runs.find(method);
  if (found == survey.runs.end()) return {method, survey.plan.first.at(method), survey.plan.budget};
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
    const Levels& levels = survey.runs.at(opinion->method);
    const auto [parts, run] = finest(levels);
    const double budget = truth_budget * survey.plan.budget;
    if (is_whole(*run) && is_affordable(survey, opinion->method, 2. * parts, INFINITY, budget))
      trials.push_back({opinion->method, 2 * parts, budget});
  }
  return trials;
}

/// The runs between which a wanted error's price lies: the index of the finer
/// one; 0: there are no two.
size_t bracket(const MethodCurve& curve, double wanted) {
  const std::vector<PrecisionRun>& runs = curve.curve.runs;
  size_t first = runs.size();
  while (first > 0 && runs[first - 1].error <= wanted) --first;
  return first == runs.size() ? 0 : first;
}

std::vector<PrecisionTrial> narrowed_brackets(const Survey& survey) {
  std::vector<PrecisionTrial> trials;
  for (const double wanted : survey.plan.wanted) {
    if (!(wanted >= least_error(survey.truth))) continue;
    double least = INFINITY;
    for (const MethodCurve& curve : survey.curves) {
      const double work = price_of(survey, curve, wanted).applications;
      if (work < least) least = work;
    }
    for (const MethodCurve& curve : survey.curves) {
      const size_t fine = bracket(curve, wanted);
      if (fine == 0 || !(price_of(survey, curve, wanted).applications <= contender * least))
        continue;
      const int few = curve.parts[fine - 1], many = curve.parts[fine];
      const PrecisionTrial middle{curve.method, (few + many) / 2, survey.plan.budget};
      if (many > narrow * few && many - few > 1 &&
          std::ranges::none_of(trials, [&](const PrecisionTrial& t) {
            return t.method == middle.method && t.parts == middle.parts;
          }))
        trials.push_back(middle);
    }
  }
  return trials;
}

/// How contact and strain limits act in the last two halvings, where it may explain why a method
/// has no order; "" where they do not act.
std::string how_filters_act(const Levels& levels) {
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

MethodCurve method_curve(const PrecisionPlan& plan, const std::string& method, const Levels& levels,
                         const CaseTruth& truth) {
  MethodCurve curve{method, {integrator_named(method), {}}, {}, {}, bar_of(plan, method, levels)};
  if (!curve.bar.reason.empty()) curve.bar.reason += how_filters_act(levels);
  const double frames = plan.input_case.scene.schedule.end / frame_of(plan);
  for (const auto& [parts, run] : levels) {
    if (run.over_budget > 0) continue;
    double error = nan;
    if (is_whole(run)) error = distance(run.x, truth.first.x, plan.mass) / truth.motion;
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

PrecisionPlan precision_plan(const Case& input_case, std::vector<std::string> methods,
                             std::vector<double> wanted, double budget,
                             const LevelSetProvider& level_sets) {
  PrecisionPlan plan{input_case, in_order(methods), {}, std::move(wanted), budget, {}, {}};
  std::ranges::sort(plan.wanted, std::greater<>());
  plan.for_truth = methods_for_truth(plan.methods);
  const BuiltScene built = build(input_case.scene, level_sets);
  plan.mass = (built.system.inverse_mass.array() > 0).select(built.system.mass.array(), 0.0);
  if (!(plan.mass.sum() > 0))
    throw InputError(input_case.scene.name +
                     ": the motion of every particle is prescribed; no method has an error");
  for (const std::string& method : all_methods(plan)) {
    const Integrator& integrator = integrator_named(method);
    plan.first[method] = first_parts(frame_of(plan), limit_of(built, integrator));
  }
  return plan;
}

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
  truth.uncertainty = distance(truth.first.x, truth.second.x, plan.mass) / truth.motion;
  return truth;
}

std::vector<MethodCurve> method_curves(const PrecisionPlan& plan, const TrialRuns& runs,
                                       const CaseTruth& truth) {
  std::vector<MethodCurve> curves;
  for (const std::string& method : all_methods(plan)) {
    const auto levels = runs.find(method);
    curves.push_back(
        method_curve(plan, method, levels == runs.end() ? Levels() : levels->second, truth));
  }
  return curves;
}

std::vector<PrecisionTrial> next_trials(const PrecisionPlan& plan, const TrialRuns& runs) {
  const CaseTruth truth = case_truth(plan, runs);
  const Survey survey{plan, runs, truth, method_curves(plan, runs, truth)};
  const double most_work = dearest * cheapest_work(survey);
  std::vector<PrecisionTrial> trials;
  // whose steps are dear; by then it is known how dear
  for (const bool is_implicit : {false, true}) {
    if (!trials.empty()) break;
    for (const std::string& method : all_methods(plan)) {
      if ((family_of(method) == Family::fully_implicit) != is_implicit) continue;
      const PrecisionTrial trial = next_on_ladder(survey, method, most_work);
      if (trial.parts > 0) trials.push_back(trial);
    }
  }
  if (trials.empty()) trials = refined_truth(survey);
  if (trials.empty()) trials = narrowed_brackets(survey);
  return trials;
}

}  // namespace foldproof
