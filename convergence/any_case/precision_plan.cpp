// Which methods a search tries, and with which steps each begins.
#include <algorithm>
#include <functional>

#include "convergence/any_case/precision.h"
#include "convergence/any_case/trial_ladder.h"
#include "reference/forces/force.h"

namespace foldproof {

namespace {

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

}  // namespace foldproof
