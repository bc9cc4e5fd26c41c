#include "convergence/any_case/converge.h"

#include <algorithm>
#include <cmath>

#include "convergence/work_precision/precision_problem.h"
#include "reference/dynamics/system.h"

namespace foldproof {

namespace {

/// Whole numbers at every level are counts, which have no rounding.
double value_floor(const std::vector<double>& values) {
  const bool is_count = std::ranges::all_of(values, [](double v) { return v == std::round(v); });
  return is_count ? 0 : rounding_floor(std::abs(values.back()));
}

double sum_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += std::abs(value);
  return sum;
}

double mean_step_of(const LevelRun& run) {
  return run.step_ends.empty() ? nan : run.step_ends.back() / double(run.step_ends.size());
}

}  // namespace

QuantityOverLevels positions_over_levels(const Scene& scene, const std::vector<LevelRun>& runs,
                                         double formal_order) {
  const PerParticle mass = lumped_masses(scene.mesh, scene.density);
  QuantityOverLevels over{"positions", "m", {}, {}, {}, nan};
  for (size_t k = 0; k + 1 < runs.size(); ++k)
    over.differences.push_back(field_difference(runs[k], runs[k + 1], mass));
  over.bar =
      error_bar({{}, over.differences, 2, formal_order, rounding_floor(longest_side(scene.x))});
  over.first_error = sum_of(over.differences) + over.bar.half_width;
  return over;
}

QuantityOverLevels value_over_levels(const Measurement& of, size_t m,
                                     const std::vector<LevelRun>& runs, double formal_order) {
  QuantityOverLevels over{of.name, unit_of(of), {}, {}, {}, nan};
  for (const LevelRun& run : runs) over.values.push_back(run.stopped.empty() ? run.values[m] : nan);
  for (size_t k = 0; k + 1 < over.values.size(); ++k)
    over.differences.push_back(over.values[k + 1] - over.values[k]);
  over.bar = error_bar({over.values, {}, 2, formal_order, value_floor(over.values)});
  over.first_error = std::abs(over.values.back() - over.values.front()) + over.bar.half_width;
  return over;
}

LadderAnswer ladder_answer(const Scene& scene, const std::string& in,
                           const std::vector<Measurement>& measurements,
                           const std::vector<LevelRun>& runs, double formal_order) {
  LadderAnswer answer{scene.name, scene.integrator, in, {}, {}, {}, {}, {}};
  for (const LevelRun& run : runs) {
    answer.work.push_back(operator_applications(run.work));
    answer.seconds.push_back(run.seconds);
    answer.stopped.push_back(run.stopped);
  }
  answer.mean_step = mean_step_of(runs.back());
  answer.formal_order = formal_order;
  answer.quantities.push_back(positions_over_levels(scene, runs, formal_order));
  for (size_t m = 0; m < measurements.size(); ++m)
    answer.quantities.push_back(value_over_levels(measurements[m], m, runs, formal_order));
  return answer;
}

std::vector<Measurement> measurements_of(const Case& input_case) {
  if (!input_case.quantities.empty()) return input_case.quantities;
  std::vector<std::string> expected;
  for (const Expectation& expectation : input_case.expectations)
    expected.push_back(expectation.key);
  return usual_measurements(input_case.scene, expected);
}

std::vector<double> divide_steps(const std::vector<double>& ends, double start, int parts) {
  std::vector<double> finer;
  for (const double end : ends) {
    for (int j = 1; j < parts; ++j) finer.push_back(start + (end - start) * j / parts);
    finer.push_back(end);
    start = end;
  }
  return finer;
}

Level time_level(const LadderPlan& plan, int k, const std::vector<double>& step_ends) {
  Level level{plan.input_case.scene.name + ", steps divided by " + std::to_string(1 << k),
              plan.input_case, plan.measurements, plan.input_case.scene.mesh.particles()};
  if (k > 0) level.input_case.scene.schedule.step.ends = divide_steps(step_ends, 0, 1 << k);
  return level;
}

LadderAnswer time_answer(const LadderPlan& plan, const std::vector<LevelRun>& runs,
                         double formal_order) {
  const Scene& scene = plan.input_case.scene;
  LadderAnswer answer = ladder_answer(scene, "time", plan.measurements, runs, formal_order);
  for (const LevelRun& run : runs) answer.sizes.push_back(mean_step_of(run));
  answer.particles.assign(runs.size(), scene.mesh.particles());
  return answer;
}

}  // namespace foldproof
