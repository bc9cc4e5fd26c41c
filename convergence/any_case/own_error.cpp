#include "convergence/any_case/own_error.h"

#include "convergence/any_case/coarser_mesh.h"
#include "reference/dynamics/integrator.h"

namespace foldproof {

namespace {

constexpr double spread_of_two = 3;  // over their difference, as of ladders without an order [1]

/// Of the distance to the next finer level.
ErrorPart error_of_two(double difference, std::string unknown) {
  return {difference, (1 + spread_of_two) * difference, std::move(unknown)};
}

ErrorPart not_known(const std::string& why) { return {nan, nan, why}; }

/// Of three levels or more; formal_order: of the method, or the mesh.
ErrorPart error_of_ladder(const Scene& scene, const std::vector<LevelRun>& runs,
                          double formal_order) {
  const QuantityOverLevels positions = positions_over_levels(scene, runs, formal_order);
  return {positions.first_error - positions.bar.half_width, positions.first_error, ""};
}

LevelRun run_of(const Level& level, const KeptRuns& by) {
  return stored_level(level, by.level_sets, by.store, by.program);
}

/// The ladder that `foldproof converge` would make of the case.
LadderPlan plan_of(const CaseSource& source) {
  LadderPlan plan{case_of(source), levels_of_own_error, {}};
  plan.measurements = measurements_of(plan.input_case);
  return plan;
}

/// The error from the levels before the last one, which stopped.
ErrorPart error_without_finest(const Scene& scene, const std::vector<LevelRun>& runs) {
  const std::string& why = runs.back().stopped;
  if (runs.size() < size_t(levels_of_own_error)) return not_known(why);
  const PerParticle mass = lumped_masses(scene.mesh, scene.density);
  return error_of_two(field_difference(runs[0], runs[1], mass),
                      "with a quarter of the step: " + why);
}

std::string why_stopped(const std::vector<const LevelRun*>& runs) {
  for (const LevelRun* run : runs)
    if (!run->stopped.empty()) return run->stopped;
  return "";
}

}  // namespace

ErrorPart error_of_steps(const CaseSource& source, const KeptRuns& by) {
  const LadderPlan plan = plan_of(source);
  const Scene& scene = plan.input_case.scene;
  std::vector<LevelRun> runs;
  for (int k = 0; k < plan.levels; ++k) {
    const std::vector<double> ends = k > 0 ? runs[0].step_ends : std::vector<double>();
    runs.push_back(run_of(time_level(plan, k, ends), by));
    if (!runs.back().stopped.empty()) return error_without_finest(scene, runs);
  }
  return error_of_ladder(scene, runs, integrator_named(scene.integrator).order);
}

ErrorPart error_of_mesh(const CaseSource& source, int levels, const KeptRuns& by) {
  const SpaceLadder ladder = space_ladder(source, levels, ObjectsToo::no);
  std::vector<LevelRun> runs{size_t(levels)};
  for (int k = levels - 1; k >= 0; --k) {
    const bool is_finest = k == levels - 1;
    const std::vector<double> ends = is_finest ? std::vector<double>() : runs.back().step_ends;
    runs[size_t(k)] = run_of(space_level(ladder, k, ends), by);
    if (const std::string& why = runs[size_t(k)].stopped; !why.empty()) return not_known(why);
  }
  const Scene& scene = ladder.levels[0].input_case.scene;
  if (levels > 2) return error_of_ladder(scene, runs, order_in_space);
  return error_of_two(field_difference(runs[0], runs[1], lumped_masses(scene.mesh, scene.density)),
                      "");
}

ErrorPart error_from_coarser_mesh(const CaseSource& source, const std::vector<std::string>& coarser,
                                  const KeptRuns& by) {
  CaseSource other = source;
  other.overrides.insert(other.overrides.end(), coarser.begin(), coarser.end());
  const LadderPlan plan = plan_of(source), coarser_plan = plan_of(other);
  Level coarser_level = time_level(coarser_plan, 0, {});
  coarser_level.label = plan.input_case.scene.name + ", coarser mesh";
  const LevelRun own = run_of(time_level(plan, 0, {}), by), of_coarser = run_of(coarser_level, by);
  if (const std::string why = why_stopped({&own, &of_coarser}); !why.empty()) return not_known(why);
  const TriangleMesh &mesh = plan.input_case.scene.mesh,
                     &coarser_mesh = coarser_plan.input_case.scene.mesh;
  const double first_order = error_from_coarser(own, mesh, of_coarser, coarser_mesh);
  return {first_order / (coarseness(mesh, coarser_mesh) + 1), spread_of_two * first_order, ""};
}

}  // namespace foldproof
