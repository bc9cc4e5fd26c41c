// Which methods a search tries, with which steps each begins, its ladder of halved steps, and where
// the cloth is in truth: two methods' best estimates that agree.
#include <algorithm>
#include <cmath>
#include <functional>

#include "convergence/any_case/precision.h"
#include "reference/forces/force.h"

namespace foldproof {

namespace {

constexpr double least_motion = 1e-9;  // over the cloth's extent: less is rounding [1]

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
                  2 / damping_rate_bound(*damping_at(built.system.forces, built.start, uncounted),
                                         built.system.inverse_mass));
}

/// Whether so many steps a frame belong to the ladder of halved steps: a power of two.
bool is_halving(int parts) { return (parts & (parts - 1)) == 0; }

Opinion opinion_of(const PrecisionPlan& plan, const std::string& method,
                   const TrialLevels& levels) {
  Opinion opinion{method, 0, false, {}, nan};
  const auto ladder = fine_end(levels);
  if (ladder.size() < 2) return opinion;
  const ErrorBar bar = method_bar(plan, method, levels);
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

PrecisionPlan precision_plan(const Case& input_case, std::vector<std::string> methods,
                             std::vector<double> wanted, double budget,
                             const LevelSetProvider& level_sets) {
  PrecisionPlan plan{input_case, in_order(methods), {}, std::move(wanted), budget, {}, {}, {}};
  std::ranges::sort(plan.wanted, std::greater<>());
  plan.for_truth = methods_for_truth(plan.methods);
  const BuiltScene built = build(input_case.scene, level_sets);
  plan.mass = (built.system.inverse_mass.array() > 0).select(built.system.mass.array(), 0.0);
  if (!(plan.mass.sum() > 0))
    throw InputError(input_case.scene.name +
                     ": the motion of every particle is prescribed; no method has an error");
  for (const std::string& method : all_methods(plan)) {
    const Integrator& integrator = integrator_named(method);
    const double limit = limit_of(built, integrator);
    plan.first[method] = first_parts(frame_of(plan), limit);
    plan.limits[method] = integrator.family == Family::fully_implicit ? INFINITY : limit;
  }
  return plan;
}

void try_until(double end, PrecisionPlan& plan) {
  const double times = end / plan.input_case.scene.schedule.end;
  plan.lasting_times = std::max(longer, int(std::ceil(times * (1 - 1e-9))));
}

Family family_of(const std::string& method) { return integrator_named(method).family; }

std::vector<std::string> all_methods(const PrecisionPlan& plan) {
  std::vector<std::string> all = plan.methods;
  all.insert(all.end(), plan.for_truth.begin(), plan.for_truth.end());
  return all;
}

double frame_of(const PrecisionPlan& plan) {
  const Schedule& schedule = plan.input_case.scene.schedule;
  return std::min(schedule.frame_interval, schedule.end);
}

Level trial_level(const Case& input_case, const PrecisionTrial& trial) {
  const Scene& scene = input_case.scene;
  Level level{scene.name + ", " + trial.method + ", " + std::to_string(trial.parts) +
                  " steps a frame" + (trial.times > 1 ? ", longer" : ""),
              input_case,
              {},
              scene.mesh.particles()};
  level.budget = trial.budget;
  level.times = trial.times;
  Scene& tried = level.input_case.scene;
  tried.integrator = trial.method;
  StepRule& step = tried.schedule.step;
  step.ends.clear();
  step.fixed = std::min(scene.schedule.frame_interval, scene.schedule.end) / trial.parts;
  tried.schedule.end *= trial.times;
  tried.schedule.max_steps *= trial.times;
  return level;
}

LevelRun& run_of(Trials& trials, const PrecisionTrial& trial) {
  return (trial.times > 1 ? trials.longer : trials.runs)[trial.method][trial.parts];
}

int first_parts(double frame, double limit) {
  int parts = 1;
  while (parts < most_parts && frame / parts > beyond_limit * limit) parts *= 2;
  return parts;
}

std::pair<int, const LevelRun*> finest(const TrialLevels& levels) {
  for (auto level = levels.rbegin(); level != levels.rend(); ++level)
    if (is_halving(level->first)) return {level->first, &level->second};
  return {0, nullptr};
}

std::vector<std::pair<int, const LevelRun*>> fine_end(const TrialLevels& levels) {
  std::vector<std::pair<int, const LevelRun*>> ladder;
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

ErrorBar ladder_bar(const TrialLevels& levels, const PerParticle& mass, double formal_order,
                    double floor) {
  const auto runs = fine_end(levels);
  Ladder ladder{{}, {}, 2, formal_order, floor};
  for (size_t k = 1; k < runs.size(); ++k)
    ladder.differences.push_back(frame_distance(runs[k - 1].second->x, runs[k].second->x, mass));
  if (runs.size() >= 3) return error_bar(ladder);
  ErrorBar bar;
  bar.reason = "fewer than three halved steps came to an end";
  if (runs.size() == 2) bar.half_width = 3 * ladder.differences.back();
  return bar;
}

ErrorBar method_bar(const PrecisionPlan& plan, const std::string& method,
                    const TrialLevels& levels) {
  return ladder_bar(levels, plan.mass, integrator_named(method).order,
                    rounding_floor(longest_side(plan.input_case.scene.x)));
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
  // one whose steps are all too long to be stable knows nothing of the motion
  std::erase_if(opinions, [&](const Opinion& one) { return !(one.half_width <= truth.motion); });
  auto second = std::ranges::find_if(opinions, [&](const Opinion& opinion) {
    return family_of(opinion.method) != family_of(truth.first.method);
  });
  if (second == opinions.end())
    second = std::ranges::find_if(
        opinions, [&](const Opinion& one) { return one.method != truth.first.method; });
  if (second == opinions.end()) return truth;
  truth.second = *second;
  truth.uncertainty = frame_distance(truth.first.x, truth.second.x, plan.mass) / truth.motion;
  return truth;
}

}  // namespace foldproof
