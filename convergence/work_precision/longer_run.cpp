#include "convergence/work_precision/longer_run.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "convergence/work_precision/work_precision.h"

namespace foldproof {

namespace {

constexpr double same_step = 1e-9;  // steps that differ by less are the same one [1]

/// Of a run with steps of at most `step`.
LongerEnergy longer_energy(const Subject& subject, const PrecisionProblem& problem,
                           const Scene& scene, double step) {
  const PerParticle mass = build_system(scene).mass;
  const double end = longer * problem.end;
  Worst largest, added;
  // a run within the budget takes at most so much with half the step
  RunPlan plan{end, int(std::ceil(end / step * (1 - same_step))), INFINITY,
               2 * longer * problem.budget};
  plan.seen = [&](const State& s) {
    const double kinetic = 0.5 * s.v.colwise().squaredNorm().dot(mass.transpose());
    largest.observe(kinetic);
    if (s.time > problem.end * (1 + same_step)) added.observe(kinetic);
  };
  if (run_planned(subject, scene, plan).ending != Ending::reached) return {nan, nan};
  return {largest.value(), added.value()};
}

LongerRun longer_run(const Subject& subject, const PrecisionProblem& problem,
                     const Integrator& integrator, double step) {
  Scene scene = problem.scene;
  scene.integrator = std::string(integrator.name);
  return {step, longer_energy(subject, problem, scene, step),
          longer_energy(subject, problem, scene, step / 2)};
}

}  // namespace

double energy_gain(const LongerRun& run) {
  const double energy = run.with_step.added,
               allowed = run.with_half.added + small_energy * run.with_half.largest;
  if (!std::isfinite(energy) || !std::isfinite(allowed)) return INFINITY;
  return energy == 0 ? 0 : energy / allowed;
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

void ask_longer_runs(const Subject& subject, PrecisionScene& scene) {
  bool is_asked = true;
  while (is_asked) {
    is_asked = false;
    for (const double wanted : wanted_errors)
      for (const Currency& currency : currencies)
        for (const size_t k : contenders(scene, wanted, currency)) {
          PrecisionCurve& curve = scene.curves[k];
          const double step = price_at(curve, scene.problem.end, wanted).step;
          if (longer_run_of(curve.longer, step)) continue;
          curve.longer.push_back(longer_run(subject, scene.problem, curve.integrator, step));
          is_asked = true;
        }
  }
}

}  // namespace foldproof
