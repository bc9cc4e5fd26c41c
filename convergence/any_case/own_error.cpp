#include "convergence/any_case/own_error.h"

#include "convergence/any_case/coarser_mesh.h"
#include "reference/dynamics/integrator.h"

namespace foldproof {

namespace {

constexpr double spread_of_two = 3;  // over their difference, as of ladders without an order [1]

LevelRun run_of(const Level& level, const KeptRuns& by) {
  return stored_level(level, by.level_sets, by.store, by.program);
}

/// The ladder that `foldproof converge` would make of the case.
LadderPlan plan_of(const CaseSource& source) {
  LadderPlan plan{case_of(source), levels_of_own_error, {}};
  plan.measurements = measurements_of(plan.input_case);
  return plan;
}

/// Of the levels before the last, which stopped: of two a spread, as of any ladder
/// without an order.
ErrorPart error_without_finest(const Scene& scene, const std::vector<LevelRun>& runs) {
  const std::string& why = runs.back().stopped;
  if (runs.size() < size_t(levels_of_own_error)) return {nan, why};
  const PerParticle mass = lumped_masses(scene.mesh, scene.density);
  return {(1 + spread_of_two) * field_difference(runs[0], runs[1], mass),
          "with a quarter of the step: " + why};
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
  const double order = integrator_named(scene.integrator).order;
  return {positions_over_levels(scene, runs, order).first_error, ""};
}

ErrorPart error_of_mesh(const CaseSource& source, const KeptRuns& by) {
  const SpaceLadder ladder = space_ladder(source, 2, ObjectsToo::no);
  const LevelRun finer = run_of(space_level(ladder, 1, {}), by);
  if (!finer.stopped.empty()) return {nan, finer.stopped};
  const LevelRun own = run_of(space_level(ladder, 0, finer.step_ends), by);
  const Scene& scene = ladder.levels[0].input_case.scene;
  return {field_difference(own, finer, lumped_masses(scene.mesh, scene.density)), own.stopped};
}

ErrorPart error_from_coarser_mesh(const CaseSource& source, const std::vector<std::string>& coarser,
                                  const KeptRuns& by) {
  CaseSource other = source;
  other.overrides.insert(other.overrides.end(), coarser.begin(), coarser.end());
  const LadderPlan plan = plan_of(source), coarser_plan = plan_of(other);
  Level coarser_level = time_level(coarser_plan, 0, {});
  coarser_level.label = plan.input_case.scene.name + ", coarser mesh";
  const LevelRun own = run_of(time_level(plan, 0, {}), by), of_coarser = run_of(coarser_level, by);
  if (const std::string why = why_stopped({&own, &of_coarser}); !why.empty()) return {nan, why};
  return {error_from_coarser(own, plan.input_case.scene.mesh, of_coarser,
                             coarser_plan.input_case.scene.mesh),
          ""};
}

}  // namespace foldproof
