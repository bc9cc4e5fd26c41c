#include "convergence/work_precision/work_precision.h"

#include <algorithm>
#include <cmath>

#include "convergence/work_precision/timed_run.h"

namespace foldproof {

namespace {

constexpr double coarsest = 1. / 8;  // steps of the first run over those at the elastic limit
constexpr double far_away = 20;  // displacement over the motion beyond which a run is stopped [1]

double log_between(double from, double to, double part) {
  return std::exp((1 - part) * std::log(from) + part * std::log(to));
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

constexpr Price price_of_none{LimitedBy::not_reached, nan, nan, nan, nan};

Price price_of_run(const PrecisionRun& run, double end, LimitedBy limit) {
  return {limit, end / run.steps, run.applications, run.seconds,
          double(run.work.unfinished_solves)};
}

/// The price between the first run that reaches the error and the one before it.
Price price_between(const PrecisionCurve& curve, size_t first, double end, double wanted) {
  const PrecisionRun& fine = curve.runs[first];
  if (first == 0) return price_of_run(fine, end, LimitedBy::not_tried);
  const PrecisionRun& coarse = curve.runs[first - 1];
  Price price = price_of_run(fine, end, LimitedBy::stability);
  if (std::isnan(coarse.error)) return price;
  const double part = std::log(coarse.error / wanted) / std::log(coarse.error / fine.error);
  return {LimitedBy::accuracy, log_between(end / coarse.steps, price.step, part),
          log_between(coarse.applications, fine.applications, part),
          log_between(coarse.seconds, fine.seconds, part), price.unfinished};
}

}  // namespace

Mark mark_of(const PrecisionRun& run) {
  if (std::isnan(run.error)) return Mark::diverged;
  return run.work.unfinished_solves > 0 ? Mark::unfinished : Mark::measured;
}

PrecisionCurve precision_curve(const Subject& subject, const PrecisionProblem& problem,
                               const PrecisionTruth& truth, const Integrator& integrator,
                               double finest_error) {
  PrecisionCurve curve{integrator, {}};
  Scene scene = problem.scene;
  scene.integrator = std::string(integrator.name);
  double count = std::max(2., coarsest * problem.end / truth.elastic_limit);
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

std::string_view name_of(LimitedBy limit) {
  switch (limit) {
    case LimitedBy::accuracy:
      return "accuracy";
    case LimitedBy::stability:
      return "stability";
    case LimitedBy::longer_run:
      return "stability of longer runs";
    case LimitedBy::not_tried:
      return "longer steps not tried";
    case LimitedBy::not_reached:
      return "not reached in range";
  }
  return "";
}

Price price_at(const PrecisionCurve& curve, double end, double wanted) {
  const std::vector<PrecisionRun>& runs = curve.runs;
  size_t first = runs.size();
  while (first > 0 && runs[first - 1].error <= wanted) --first;
  if (first == runs.size()) return price_of_none;
  const double unstable = shortest_unstable_step(curve.longer);
  const Price price = price_between(curve, first, end, wanted);
  if (price.step < unstable) return price;
  while (first < runs.size() && !(end / runs[first].steps < unstable * (1 - 1e-9))) ++first;
  return first == runs.size() ? price_of_none
                              : price_of_run(runs[first], end, LimitedBy::longer_run);
}

}  // namespace foldproof
