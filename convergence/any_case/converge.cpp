#include "convergence/any_case/converge.h"

#include <cmath>

#include "convergence/any_case/distances.h"
#include "reference/dynamics/system.h"

namespace foldproof {

namespace {

/// Rounding of a number of this size over a run: differences below are no discretization error.
double rounding_floor(double size) { return 1e3 * epsilon * size; }

double sum_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += std::abs(value);
  return sum;
}

QuantityOverLevels positions_over_levels(const LadderPlan& plan,
                                         const std::vector<LevelRun>& runs) {
  const Scene& scene = plan.input_case.scene;
  const PerParticle mass = lumped_masses(scene.mesh, scene.density);
  QuantityOverLevels over{"positions", "m", {}, {}, {}, nan};
  for (size_t k = 0; k + 1 < runs.size(); ++k)
    over.differences.push_back(field_difference(runs[k], runs[k + 1], mass));
  over.bar = error_bar({{},
                        over.differences,
                        2,
                        double(integrator_named(scene.integrator).order),
                        rounding_floor(longest_side(scene.x))});
  over.first_error = sum_of(over.differences) + over.bar.half_width;
  return over;
}

QuantityOverLevels value_over_levels(const LadderPlan& plan, const std::vector<LevelRun>& runs,
                                     size_t m) {
  QuantityOverLevels over{
      plan.measurements[m].name, unit_of(plan.measurements[m]), {}, {}, {}, nan};
  for (const LevelRun& run : runs) over.values.push_back(run.stopped.empty() ? run.values[m] : nan);
  for (size_t k = 0; k + 1 < over.values.size(); ++k)
    over.differences.push_back(over.values[k + 1] - over.values[k]);
  const double order = integrator_named(plan.input_case.scene.integrator).order;
  over.bar = error_bar({over.values, {}, 2, order, rounding_floor(std::abs(over.values.back()))});
  over.first_error = std::abs(over.values.back() - over.values.front()) + over.bar.half_width;
  return over;
}

}  // namespace

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

LadderAnswer time_answer(const LadderPlan& plan, const std::vector<LevelRun>& runs) {
  const Scene& scene = plan.input_case.scene;
  LadderAnswer answer{scene.name, scene.integrator, "time", {}, {}, {}, {}, {}};
  for (const LevelRun& run : runs) {
    answer.sizes.push_back(
        run.step_ends.empty() ? nan : run.step_ends.back() / double(run.step_ends.size()));
    answer.work.push_back(run.work);
    answer.seconds.push_back(run.seconds);
    answer.stopped.push_back(run.stopped);
  }
  answer.quantities.push_back(positions_over_levels(plan, runs));
  for (size_t m = 0; m < plan.measurements.size(); ++m)
    answer.quantities.push_back(value_over_levels(plan, runs, m));
  return answer;
}

}  // namespace foldproof
