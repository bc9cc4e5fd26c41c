// work-precision: which integrator reaches a wanted accuracy at the least cost, scene by scene.
#include "convergence/work_precision/work_precision.h"

#include "convergence/study.h"
#include "reference/dynamics/integrator.h"

namespace foldproof {

namespace {

constexpr double first_steps = 1. / 8;  // steps of the first run over those at the elastic limit
constexpr double far_away = 20;  // displacement over the motion beyond which a run is stopped [1]
constexpr double same_step = 1e-9;  // steps that differ by less are the same one [1]

Scene with_method(Scene scene, const std::string& method) {
  scene.integrator = method;
  return scene;
}

int measured_runs(const PrecisionCurve& curve) {
  return int(std::ranges::count_if(curve.runs,
                                   [](const PrecisionRun& run) { return !std::isnan(run.error); }));
}

/// The work of a run with so many steps: that of the two runs before it, continued linearly; 0 if
/// they do not tell.
double expected_work(const PrecisionCurve& curve, int steps) {
  if (curve.runs.size() < 2) return 0;
  const PrecisionRun &last = curve.runs.back(), &before = curve.runs[curve.runs.size() - 2];
  if (last.part < 1 || before.part < 1) return 0;
  return last.applications + (last.applications - before.applications) /
                                 (last.steps - before.steps) * (steps - last.steps);
}

/// The runs of one method: from an eighth of the steps at the elastic limit on, finer by
/// problem.ratio, until the error is `finest_error` [1] and problem.min_points runs were
/// measured, or until a run with a step below the elastic limit exceeds the problem's budget, or
/// would if work went on to grow as between the two before. Runs with longer steps that exceed
/// it are left out.
PrecisionCurve precision_curve(const Subject& subject, const PrecisionScene& of,
                               const std::string& method, double finest_error) {
  const PrecisionProblem& problem = of.problem;
  const PrecisionTruth& truth = of.truth;
  PrecisionCurve curve{method, {}};
  const Scene scene = with_method(problem.scene, method);
  double count = std::max(2., first_steps * problem.end / truth.elastic_limit);
  for (bool again = true; again; count *= problem.ratio) {
    const RunPlan plan{problem.end, int(std::lround(count)), far_away * truth.motion,
                       problem.budget};
    const bool is_short = plan.steps > problem.end / truth.elastic_limit;
    if (is_short && expected_work(curve, plan.steps) > problem.budget) break;
    const auto [run, seconds] = timed_run([&] { return run_planned(subject, scene, plan); });
    if (run.ending == Ending::over_budget) {
      if (is_short) break;
      continue;  // long steps can be dearer than short ones, for Newton's method
    }
    const double error =
        run.ending == Ending::reached ? largest_distance(run.last.x, truth.x) / truth.motion : nan;
    curve.runs.push_back({plan.steps, error <= diverged_error ? error : nan,
                          operator_applications(run.work), seconds, double(run.steps) / plan.steps,
                          run.work});
    again = !(error <= finest_error) || measured_runs(curve) < problem.min_points;
  }
  return curve;
}

/// Of a run `longer` times as long, with steps of at most `step`.
LongerEnergy longer_energy(const Subject& subject, const PrecisionProblem& problem,
                           const Scene& scene, double step) {
  const double end = longer * problem.end;
  // a run within the budget takes at most so much with half the step
  const RunPlan plan{end, int(std::ceil(end / step * (1 - same_step))), INFINITY,
                     2 * longer * problem.budget};
  return run_with_energy(subject, scene, plan, problem.end * (1 + same_step)).energy;
}

/// Asks whether the steps last with which the contenders reach each wanted error; where one does
/// not, a shorter one, or another method, is asked in its place.
void ask_longer_runs(const Subject& subject, PrecisionScene& scene) {
  bool is_asked = true;
  while (is_asked) {
    is_asked = false;
    for (const double wanted : wanted_errors)
      for (const Currency& currency : currencies)
        for (const size_t k : podium(scene, wanted, currency).contenders) {
          PrecisionCurve& curve = scene.curves[k];
          const double step = price_of(scene, curve, wanted).step;
          if (longer_run_of(curve.longer, step)) continue;
          const Scene tried = with_method(scene.problem.scene, curve.method);
          curve.longer.push_back({step, longer_energy(subject, scene.problem, tried, step),
                                  longer_energy(subject, scene.problem, tried, step / 2)});
          is_asked = true;
        }
  }
}

StudyResult run_work_precision(const Subject& subject, Tier tier, const Progress& progress) {
  const std::vector<PrecisionProblem> problems = precision_problems(tier);
  const double parts = double(problems.size()) * double(integrators().size() + 1);
  // the full tier's figures show how curves go on below the least error that is asked for
  const double finest = tier == Tier::quick ? wanted_errors.back() : wanted_errors.back() / 3;
  double done = 0;
  std::vector<PrecisionScene> scenes;
  for (const PrecisionProblem& problem : problems) {
    PrecisionScene scene{problem, truth_of(subject, problem), {}};
    progress(++done / parts);
    for (const Integrator& integrator : integrators()) {
      scene.curves.push_back(precision_curve(subject, scene, std::string(integrator.name), finest));
      progress(++done / parts);
    }
    ask_longer_runs(subject, scene);
    scenes.push_back(std::move(scene));
  }
  StudyResult result;
  result.findings = precision_findings(scenes);
  for (const PrecisionScene& scene : scenes)
    for (Figure& figure : precision_figures(scene)) result.figures.push_back(std::move(figure));
  result.tables = precision_tables(scenes);
  add_slow_motion(subject, result);
  return result;
}

}  // namespace

const PrecisionCurve& curve_of(const PrecisionScene& scene, std::string_view method) {
  for (const PrecisionCurve& curve : scene.curves)
    if (curve.method == method) return curve;
  throw InputError("work-precision: no runs of '" + std::string(method) + "' on " +
                   scene.problem.description);
}

Study work_precision_study() {
  return {
      "work-precision",
      "At one percent of error on a heavily damped sheet, the steps of schemes A and B exceed "
      "those of explicit methods by the ratio of the elastic limit to the damping limit, within a "
      "factor of two; C needs shorter steps to be as accurate.",
      {"mixed-steps-are-larger", "C-needs-shorter-steps", "cheapest-steps-last"},
      "BMF03 section 3",
      "Which integrator should I use for my scene, at which step, and at what cost? Every method "
      "of the table runs four motions over a range of constant steps. The error is the largest "
      "position error at the end, divided by the scene's own motion, which is the largest distance "
      "of any particle from its start. The truth is from GSL or an extrapolated RK4, and must "
      "agree with an extrapolated scheme C (on the heavily damped sheet B, which keeps its order "
      "there). Work is counted in applications of force operators: evaluations of the elastic "
      "forces, preparations of the damping and of the elastic derivative, and products with either "
      "of them. One application visits every spring and hinge once. Applications differ in cost, "
      "so processor seconds stand beside them, the least of a few runs. Seconds scatter with the "
      "load of the machine: where they rank methods of similar work differently, trust the work. "
      "Solves stop at 1e-8. The elastic limit is the solver's bound, computed from row sums of the "
      "stiffness matrix, and is at most 2/omega. A step beyond it can be cheap on a short, damped "
      "motion, in which an instability has no time to grow. So the steps of the cheapest methods "
      "must also last a run three times as long: the kinetic energy of the added time may be at "
      "most twice that with half the step. A step that does not last has no price, and the next "
      "shorter one is tried in its place. Dearer methods are not tried.",
      run_work_precision};
}

}  // namespace foldproof
