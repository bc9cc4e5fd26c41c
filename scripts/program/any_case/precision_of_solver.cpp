#include "scripts/program/any_case/precision_of_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "convergence/any_case/distances.h"
#include "convergence/any_case/trial_ladder.h"
#include "scripts/program/progress.h"
#include "scripts/program/typed_solver.h"

namespace foldproof {

namespace {

using nlohmann::json;

constexpr double usual_seconds = 10;  // of one run, by the clock

}  // namespace

PrecisionOfSolver::PrecisionOfSolver(const Options& options, const PrecisionPlan& plan,
                                     const LevelSetProvider& level_sets)
    : most_seconds_(options.effort * usual_seconds),
      solver_(solver_command(options)),
      ladder_({plan.input_case, 0, {}}, solver_, level_sets) {}

SolverPlan PrecisionOfSolver::plan_of(const PrecisionAnswer& reference) {
  const Declaration& declared = solver_.declaration();
  const Scene& scene = reference.plan.input_case.scene;
  SolverPlan plan;
  plan.name = declared.name + (declared.version.empty() ? "" : " " + declared.version);
  plan.wanted = reference.plan.wanted;
  plan.mass = reference.plan.mass;
  plan.motion = reference.truth.motion;
  plan.end = scene.schedule.end;
  plan.frame = ladder_.steps().interval;
  plan.formal_order = std::max(1, declared.order);
  plan.floor = 1e3 * declared.rounding() * longest_side(scene.x);
  plan.first = first_parts(plan.frame, plan.frame / double(ladder_.steps().a_frame));
  plan.most_seconds = most_seconds_;
  return plan;
}

SolverPrecision PrecisionOfSolver::answer(const PrecisionAnswer& reference,
                                          const std::vector<double>& times) {
  const SolverPlan plan = plan_of(reference);
  SolverRuns runs;
  for (int parts = next_parts(plan, runs); parts > 0; parts = next_parts(plan, runs)) {
    log_line(fmt::format("{}: {} steps a frame", plan.name, parts));
    const LevelRun& run = runs[parts] = ladder_.run_with(parts);
    // a step longer than the case's own may be declined
    if (parts >= ladder_.steps().a_frame && run.stopped.starts_with("the solver declines"))
      throw InputError(run.stopped);
  }
  return solver_precision(plan, runs, reference.truth, times);
}

json to_json(const SolverPrecision& solver, const PrecisionAnswer& reference) {
  json told = {{"name", solver.plan.name},
               {"sentences", solver_sentences(solver, reference)},
               {"order", asymptotic_order(solver.bar)},
               {"reading", name_of(solver.bar.reading)},
               {"because", solver.bar.reason},
               {"error_bar", solver.bar.half_width},
               {"from_truth", solver.from_truth},
               {"explained_by_steps", solver.explained},
               {"runs", json::array()},
               {"prices", json::array()}};
  for (const SolverStep& step : solver.steps)
    told["runs"].push_back({{"steps_a_frame", step.parts},
                            {"step", step.step},
                            {"error", step.error},
                            {"processor", step.spent.processor},
                            {"clock", step.spent.clock},
                            {"stopped", step.stopped}});
  for (const SolverPrice& price : solver.prices)
    told["prices"].push_back({{"error", price.wanted},
                              {"step", price.step},
                              {"processor", price.spent.processor},
                              {"clock", price.spent.clock},
                              {"is_whole_frame", price.is_whole_frame},
                              {"unstable_step", price.unstable_step},
                              {"because", price.because}});
  return told;
}

void print(const SolverPrecision& solver, const PrecisionAnswer& reference) {
  fmt::print("\n");
  for (const std::string& sentence : solver_sentences(solver, reference))
    fmt::print("{}\n", sentence);
  fmt::print("\n{:>14} {:>12} {:>12} {:>14} {:>12}\n", "steps a frame", "step [s]", "error [%]",
             "processor [s]", "clock [s]");
  const auto number = [](double value) {
    return std::isnan(value) ? std::string("-") : fmt::format("{:.3g}", value);
  };
  for (const SolverStep& step : solver.steps)
    fmt::print("{:>14} {:>12.3g} {:>12} {:>14} {:>12}  {}\n", step.parts, step.step,
               number(100 * step.error), number(step.spent.processor), number(step.spent.clock),
               step.stopped);
}

}  // namespace foldproof
