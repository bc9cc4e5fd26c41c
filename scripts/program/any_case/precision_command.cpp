// foldproof precision: which integrator is cheapest for a case at a wanted error, and which step of
// another solver reaches it.

#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "scripts/program/command_line/options_of_commands.h"
#include "convergence/any_case/precision.h"
#include "convergence/any_case/solver_ladder.h"
#include "convergence/any_case/solver_precision.h"
#include "convergence/work_precision/precision_problem.h"
#include "scripts/program/any_case/ladder_runs.h"
#include "scripts/program/any_case/precision_output.h"
#include "scripts/program/command_line/input_files.h"
#include "scripts/program/command_line/out_folder.h"
#include "scripts/program/command_line/typed_words.h"
#include "scripts/program/interruption.h"
#include "scripts/program/json_text.h"
#include "scripts/program/program_json.h"
#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"
#include "scripts/program/run_case.h"
#include "scripts/program/typed_solver.h"
#include "verification/files/level_set_folder.h"

namespace foldproof {

namespace {

using nlohmann::json;

constexpr double usual_budget = 2.5e8;  // of one run [visits]: two to eight seconds
constexpr double usual_seconds = 10;    // of one run of another solver, by the clock

PrecisionPlan plan_of(const Options& options, const LevelSetProvider& level_sets) {
  Case input_case = read_case(case_file(options.file), options.overrides);
  Schedule& schedule = input_case.scene.schedule;
  const double end = schedule.end;
  if (options.until > 0) schedule.end = std::min(options.until, schedule.end);
  std::vector<std::string> methods = options.methods;
  if (methods.empty() || methods == std::vector<std::string>{"all"}) {
    methods.clear();
    for (const Integrator& integrator : integrators()) methods.emplace_back(integrator.name);
  }
  std::vector<double> wanted;
  for (const std::string& error : options.errors) wanted.push_back(std::stod(error));
  PrecisionPlan plan =
      precision_plan(input_case, methods, wanted, options.effort * usual_budget, level_sets);
  try_until(end, plan);
  return plan;
}

double end_of_case(const Options& options) {
  return read_case(case_file(options.file), options.overrides).scene.schedule.end;
}

/// Makes what is missing, round by round, until nothing is.
Trials all_trials(const PrecisionPlan& plan, const LevelRunner& by) {
  Trials all;
  for (int round = 1;; ++round) {
    const std::vector<PrecisionTrial> trials = next_trials(plan, all);
    if (trials.empty()) return all;
    std::vector<Level> levels;
    std::vector<double> lengths;
    for (const PrecisionTrial& trial : trials) {
      levels.push_back(trial_level(plan.input_case, trial));
      lengths.push_back(trial.parts);
    }
    std::vector<LevelRun> made =
        run_levels(levels, lengths, fmt::format("round {}: {} runs", round, trials.size()), by);
    for (size_t k = 0; k < trials.size(); ++k) run_of(all, trials[k]) = std::move(made[k]);
  }
}

/// The answer, with the program, and how the case was asked.
json to_json(const PrecisionAnswer& answer, const std::optional<SolverAnswer>& solver,
             const Options& options) {
  json all = to_json(answer, options);
  if (solver) all["solver"] = to_json(*solver, answer);
  all["end"] = end_of_case(options);
  all["tried_until"] = lasting_end(answer.plan);
  all["asked_end"] = answer.plan.input_case.scene.schedule.end;
  all["overrides"] = options.overrides;
  all["program"] = program_json(options.command);
  return all;
}

/// The solver of one call, on its case. No run of it is kept: the program behind the command may
/// change.
struct OtherSolver {
  Trial trial;
  SolverLadder ladder;

  /// Starts it. Throws InputError for a case that the protocol cannot say, or that the solver does
  /// not offer.
  OtherSolver(const Options& options, const PrecisionPlan& plan, const LevelSetProvider& level_sets)
      : trial(solver_command(options)), ladder({plan.input_case, 0, {}}, trial, level_sets) {}
};

SolverPlan plan_of(OtherSolver& solver, const PrecisionAnswer& reference, double effort) {
  const Declaration& declared = solver.trial.declaration();
  const Scene& scene = reference.plan.input_case.scene;
  SolverPlan plan;
  plan.name = declared.name + (declared.version.empty() ? "" : " " + declared.version);
  plan.wanted = reference.plan.wanted;
  plan.mass = reference.plan.mass;
  plan.motion = reference.truth.motion;
  plan.end = scene.schedule.end;
  plan.frame = solver.ladder.steps().interval;
  plan.formal_order = std::max(1, declared.order);
  plan.floor = 1e3 * declared.rounding() * longest_side(scene.x);
  plan.first = first_parts(plan.frame, plan.frame / double(solver.ladder.steps().a_frame));
  plan.most_seconds = effort * usual_seconds;
  return plan;
}

/// Runs it with steps that are halved. times: of the frames of the reference's truth. Throws
/// InputError if it declines the case.
SolverAnswer solver_answer(OtherSolver& solver, const PrecisionAnswer& reference,
                           const std::vector<double>& times, double effort) {
  const SolverPlan plan = plan_of(solver, reference, effort);
  TrialLevels runs;
  for (int parts = next_parts(plan, runs); parts > 0; parts = next_parts(plan, runs)) {
    log_line(fmt::format("{}: {} steps a frame", plan.name, parts));
    const LevelRun& run = runs[parts] = solver.ladder.run_with(parts);
    // a step longer than the case's own may be declined
    if (parts >= solver.ladder.steps().a_frame && run.stopped.starts_with("the solver declines"))
      throw InputError(run.stopped);
  }
  return {solver_precision(plan, runs, reference.truth, times), solver.trial.mapping()};
}

/// Frames of the run that the truth is made of [s].
std::vector<double> times_of_truth(const PrecisionAnswer& answer, const Trials& trials) {
  const auto runs = trials.runs.find(answer.truth.first.method);
  if (runs == trials.runs.end()) return {};
  const auto run = runs->second.find(answer.truth.first.parts);
  return run == runs->second.end() ? std::vector<double>() : run->second.times;
}

bool is_answered(const PrecisionAnswer& answer) {
  return std::ranges::all_of(answer.lists,
                             [](const PriceList& list) { return is_priced(list.prices.front()); });
}

}  // namespace

int precision(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  const LevelSetProvider level_sets =
      memoizing_provider(provider_for(options.cache, threads_of(options.running)));
  const PrecisionPlan plan = plan_of(options, level_sets);
  std::optional<OtherSolver> other;  // refuses now what it cannot run
  if (!options.solver.empty()) other.emplace(options, plan, level_sets);
  const OutFolder folder(options.out);
  log_warnings(plan.input_case.scene);
  ResultStore store(options.out + "/store");
  const InterruptionNotice notice("finished runs are kept in " + options.out + "/store",
                                  typed_again(options.words));
  const Trials trials =
      all_trials(plan, {{level_sets, store, program_identity()}, options.running});
  const PrecisionAnswer answer = precision_answer(plan, trials);
  std::optional<SolverAnswer> solver;
  if (other) solver = solver_answer(*other, answer, times_of_truth(answer, trials), options.effort);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  RunRecord run;
  run.provenance = provenance(options.command);
  run.seconds = seconds;
  run.studies = {precision_record(answer, seconds)};
  if (solver) run.studies.push_back(solver_precision_record(solver->precision, answer));
  write_run(options.out + "/precision.h5", run);
  if (options.json) {
    fmt::print("{}\n", json_text(to_json(answer, solver, options)));
  } else {
    print(answer, trials, options);
    if (solver) print(*solver, answer, end_of_case(options));
  }
  return is_answered(answer) && (!solver || solver->precision.is_answered()) ? all_hold : some_fail;
}

namespace {

constexpr const char* below_precision =
    R"(Runs the case with every integrator, at constant steps that are halved from run to run. Prints for
each wanted error the cheapest method and its step, and the price of each other method as a multiple
of the cheapest. A price counts applications of force operators.

error   distance from the truth, divided by the motion. The distance is the root mean square over
        the free particles, weighted by mass, in the worst frame; the motion is the largest such
        distance from the start.
truth   two methods, of different families if they know the motion at all, each extrapolated where
        its order has settled. An error less than ten times their distance gets no price.
price   interpolated between the two runs that bracket the error. Methods are tied if their prices
        are closer than the steps tried. The steps of the cheapest methods must also last: in a run
        at least three times as long, and at least to the end of the case (--until shortens it),
        the kinetic energy is at most twice that with half the step. If such a run costs more than
        20 times the budget, the answer is the automatic step.

--solver CMD also finds step and price of another solver (verification/subjects/PROTOCOL.md).
Its steps are equal from frame to frame, and halved until the error bar of the finest run is a tenth
of the least wanted error, or a run would take 10 s (times --effort) by the clock. Longer steps are
tried, up to a frame, until they miss the largest wanted error or are unstable; if a whole frame
reaches an error, its step is a lower bound, printed as >=. The error is the distance from the
finest run, and that run's error bar, over the reference's motion. Says how far the solver's limit
is from the reference's truth, and whether steps explain it. Its runs are not kept.

Examples:
  foldproof precision hanging_sheet --until 0.2 --solver ./adapter --settings iterations=20
  foldproof precision hanging_sheet --method A,C,RK4 --errors 1e-2 --out mine

Exit codes:
  0    every wanted error is reached by some method, and by the solver; the truth is good for it
  1    no method, or not the solver, reaches an error; or the truth is not known well enough
  2    bad input, or a file that cannot be written)";

}  // namespace

void add_precision_command(CLI::App& app, Program& program) {
  auto [command, options] =
      add_command(app, program,
                  {"precision",
                   "Which integrator is cheapest for a case at a wanted error? Writes precision.h5",
                   below_precision},
                  precision);
  add_input(command, "CASE", options.file, case_words);
  add_method(command, options, "all");
  add_errors(command, options, "Wanted errors, as shares of the motion (default: 1e-2,1e-3)");
  add_value(command, "--until TIME", options.until,
            "Use only the beginning of the run, up to this time [s]", positive_number());
  add_value(command, "--effort TIMES", options.effort,
            "Let each run take this many times the usual work, for shorter steps",
            positive_number())
      ->capture_default_str();
  add_overrides(command, options);
  add_other_solver(command, options,
                   "Also find the steps of another solver, started by this command");
  add_folder(command, options,
             "Folder for precision.h5; its store/ keeps every run, and a second call makes only "
             "what is missing")
      ->capture_default_str();
  add_cache(command, options);
  add_threads(command, options);
  add_json(command, options);
}

}  // namespace foldproof
