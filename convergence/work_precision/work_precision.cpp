// work-precision: which integrator reaches a wanted accuracy at the least cost, scene by scene.
#include "convergence/work_precision/work_precision.h"

#include <string>

#include "convergence/study.h"

namespace foldproof {

namespace {

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
      scene.curves.push_back(precision_curve(subject, problem, scene.truth, integrator, finest));
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
    if (curve.integrator.name == method) return curve;
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
