#include "convergence/any_case/solver_ladder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "convergence/any_case/portable_case.h"
#include "reference/dynamics/system.h"

namespace foldproof {

namespace {

/// A frame may be off by so much of the end [1].
constexpr double same_frame = 1e-9;

/// Throws InputError unless the solver declares every capability that the scene needs.
void require_offered(const PortableScene& scene, Trial& solver) {
  try {
    for (const std::string& capability : needed_by(scene)) solver.require(capability);
  } catch (const NotOffered& missing) {
    throw InputError("the solver does not offer " + missing.operation + ", which the case needs");
  } catch (const SolverFailure& failure) {
    throw InputError(failure.in_one_line());
  }
}

}  // namespace

std::vector<Measurement> shown_by_states(const std::vector<Measurement>& measurements) {
  std::vector<Measurement> shown;
  for (const Measurement& m : measurements) {
    const bool is_of_states = std::ranges::any_of(
        measurable(), [&](const Measurable& row) { return m.what == row.what; });
    if (is_of_states && m.what != "contact_points") shown.push_back(m);
  }
  return shown;
}

SolverSteps solver_steps(const Scene& scene, const BuiltScene& built) {
  const Schedule& schedule = scene.schedule;
  SolverSteps steps;
  steps.interval = std::min(schedule.frame_interval, schedule.end);
  steps.frames = std::lround(schedule.end / steps.interval);
  if (std::abs(double(steps.frames) * steps.interval - schedule.end) > same_frame * schedule.end)
    throw InputError(
        fmt::format("another solver takes equal steps from frame to frame, and the end, {:g} s, is "
                    "not a whole number of frames; try --until {:g}",
                    schedule.end, std::floor(schedule.end / steps.interval) * steps.interval));
  const double longest = schedule.step.fixed > 0
                             ? schedule.step.fixed
                             : schedule.step.safety * elastic_limit(built.system, built.start);
  steps.a_frame = std::max(1L, std::lround(std::ceil(steps.interval / longest - same_frame)));
  return steps;
}

SolverLadder::SolverLadder(LadderPlan plan, Trial& solver, const LevelSetProvider& level_sets)
    : plan_(std::move(plan)),
      solver_(solver),
      built_(build(plan_.input_case.scene, level_sets)),
      portable_(portable_case(plan_.input_case.scene)),
      steps_(solver_steps(plan_.input_case.scene, built_)) {
  plan_.measurements = shown_by_states(plan_.measurements);
  require_offered(portable_, solver_);
}

LevelRun SolverLadder::run(int k) { return run_with(steps_.a_frame << k); }

LevelRun SolverLadder::run_with(long a_frame) {
  portable_.dt = steps_.interval / double(a_frame);
  std::vector<long> at;
  for (long frame = 1; frame <= steps_.frames; ++frame) at.push_back(frame * a_frame);
  LevelRun run;
  try {
    run = measured(a_frame, solver_.motion(portable_, at));
  } catch (const SolverFailure& failure) {
    solver_.note(failure);
    run.stopped = failure.in_one_line();
  } catch (const NotOffered& declined) {
    run.stopped = "the solver declines: " + declined.operation;
  }
  run.values.resize(plan_.measurements.size(), nan);
  run.seconds = solver_.processor_seconds_of_motion();
  run.clock = solver_.seconds_of_motion();
  run.steps = steps_.frames * a_frame;
  return run;
}

LevelRun SolverLadder::measured(long a_frame, const std::vector<Snapshot>& frames) const {
  const Scene& scene = plan_.input_case.scene;
  Measurer measurer(scene, built_, plan_.measurements);
  LevelRun run;
  RunResult result;
  result.last = built_.start;
  const auto record = [&](const State& frame) {
    measurer.record(frame);
    run.times.push_back(frame.time);
    run.x.push_back(frame.x);
  };
  record(built_.start);
  for (size_t f = 0; f < frames.size(); ++f) {
    State& state = result.last;
    state.time = double(f + 1) * steps_.interval;
    state.x = frames[f].x, state.v = frames[f].v;
    record(state);
  }
  for (long n = 1; n <= steps_.frames * a_frame; ++n)
    run.step_ends.push_back(double(n) * portable_.dt);
  run.values = measurer.values(result);
  return run;
}

LadderAnswer SolverLadder::answer(const std::vector<LevelRun>& runs) {
  const Declaration& declared = solver_.declaration();
  LadderAnswer answer = time_answer(plan_, runs, std::max(1, declared.order));
  answer.method = declared.name + (declared.version.empty() ? "" : " " + declared.version);
  answer.work_name = "steps";
  answer.work.clear();
  for (const LevelRun& run : runs) {
    answer.work.push_back(double(run.steps));
    answer.clock.push_back(run.clock);
  }
  if (declared.order < 1)
    answer.warnings.emplace_back(
        "the solver claims no order; its steps are read as of first order");
  return answer;
}

SolverGap solver_gap(const LevelRun& solver, const LadderAnswer& solver_answer,
                     const LevelRun& reference, const LadderAnswer& reference_answer,
                     const PerParticle& mass) {
  const ErrorBar &ours = reference_answer.quantities.front().bar,
                 &theirs = solver_answer.quantities.front().bar;
  return {field_difference(solver, reference, mass), theirs.half_width, ours.half_width,
          ours.reading != Reading::inconclusive && theirs.reading != Reading::inconclusive};
}

std::string in_words(const SolverGap& gap, const std::string& solver) {
  const std::string apart = fmt::format(
      "the finest runs of {} and of the reference are {:.2g} m apart; the error bars of their "
      "steps are {:.2g} m and {:.2g} m: ",
      solver, gap.distance, gap.solver_bar, gap.reference_bar);
  if (!gap.are_estimates || !std::isfinite(gap.distance))
    return apart + "without an order of both, nothing can be said";
  return apart + (gap.is_beyond_steps()
                      ? "the time step does not explain the difference, so the models differ"
                      : "steps may explain it");
}

}  // namespace foldproof
