#include "convergence/work_precision/longer_run.h"

#include <algorithm>
#include <cmath>

#include "convergence/work_precision/work_precision.h"

namespace foldproof {

namespace {

constexpr double same_step = 1e-9;  // steps that differ by less are the same one [1]

/// The largest kinetic energy in a run with steps of at most `step`, `longer` times as long as the
/// problem's [J]; NaN where it comes to no end.
double largest_kinetic_energy(const Subject& subject, const PrecisionProblem& problem,
                              const Scene& scene, double step) {
  const PerParticle mass = build_system(scene).mass;
  const double end = longer * problem.end;
  Worst kinetic;
  // a run within the budget takes at most so much with half the step
  RunPlan plan{end, int(std::ceil(end / step * (1 - same_step))), INFINITY,
               2 * longer * problem.budget};
  plan.seen = [&](const State& s) {
    kinetic.observe(0.5 * s.v.colwise().squaredNorm().dot(mass.transpose()));
  };
  const PlannedRun run = run_planned(subject, scene, plan);
  return run.ending == Ending::reached ? kinetic.value() : nan;
}

LongerRun longer_run(const Subject& subject, const PrecisionProblem& problem,
                     const Integrator& integrator, double step) {
  Scene scene = problem.scene;
  scene.integrator = std::string(integrator.name);
  return {step, largest_kinetic_energy(subject, problem, scene, step),
          largest_kinetic_energy(subject, problem, scene, step / 2)};
}

}  // namespace

double energy_gain(const LongerRun& run) {
  if (!std::isfinite(run.kinetic) || !std::isfinite(run.allowed)) return INFINITY;
  return run.kinetic == run.allowed ? 1 : run.kinetic / run.allowed;
}

bool lasts(const LongerRun& run) { return energy_gain(run) <= most_energy_gain; }

double shortest_unstable_step(const std::vector<LongerRun>& runs) {
  double shortest = INFINITY;
  for (const LongerRun& run : runs)
    if (!lasts(run)) shortest = std::min(shortest, run.step);
  return shortest;
}

const LongerRun* longer_run_of(const std::vector<LongerRun>& runs, double step) {
  for (const LongerRun& run : runs)
    if (std::abs(run.step / step - 1) <= same_step) return &run;
  return nullptr;
}

void ask_longer_runs(const Subject& subject, const PrecisionProblem& problem,
                     PrecisionCurve& curve) {
  for (const double wanted : wanted_errors)
    for (;;) {
      const double step = price_at(curve, problem.end, wanted).step;
      if (std::isnan(step) || longer_run_of(curve.longer, step)) break;
      curve.longer.push_back(longer_run(subject, problem, curve.integrator, step));
    }
}

}  // namespace foldproof
