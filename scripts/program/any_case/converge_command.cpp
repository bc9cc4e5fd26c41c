// foldproof converge: the errors that a case owes to its step and to its mesh,
// quantity by quantity.

#include <nlohmann/json.hpp>
#include <optional>

#include "scripts/program/command_line/options_of_commands.h"
#include "convergence/any_case/converge.h"
#include "convergence/any_case/error_map.h"
#include "convergence/any_case/solver_ladder.h"
#include "convergence/any_case/space_ladder.h"
#include "scripts/program/command_line/input_files.h"
#include "scripts/program/command_line/out_folder.h"
#include "scripts/program/command_line/typed_words.h"
#include "scripts/program/any_case/converge_report.h"
#include "scripts/program/any_case/converge_settings.h"
#include "scripts/program/interruption.h"
#include "scripts/program/json_text.h"
#include "scripts/program/any_case/ladder_runs.h"
#include "scripts/program/program_json.h"
#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"
#include "scripts/program/run_case.h"
#include "scripts/program/typed_solver.h"
#include "verification/files/atomic_file.h"
#include "verification/files/level_set_folder.h"
#include "verification/files/results_file.h"

namespace foldproof {

namespace {

/// A ladder; of one in time how long its positions are predictable; of one in space, beside a
/// ladder in time, the map over both; of another solver, how far it ends from the reference.
struct Told {
  LadderAnswer ladder;
  std::optional<PredictabilityAnswer> twins;
  std::optional<MapAnswer> map;
  std::optional<SolverGap> gap;
  LevelRun finest = {};                                           // of a ladder in time
  std::vector<std::pair<std::string, std::string>> mapping = {};  // of another solver
};

constexpr int usual_levels = 4, most_levels = 9;

int levels_of(const Options& options) { return options.levels > 0 ? options.levels : usual_levels; }

/// How the questions of one call are answered.
struct Answering : LevelRunner {
  const Options& options;
};

void require_asked_before_end(const std::vector<Measurement>& measurements, double end) {
  for (const Measurement& m : measurements)
    if (m.when == Instant::at_time && m.time > end)
      throw InputError(fmt::format("quantity '{}' is asked at {:g} s, beyond --until {:g}", m.name,
                                   m.time, end));
}

/// The first level, disturbed; those that the store has are read from it.
std::vector<LevelRun> disturbed_runs(const Level& first, const std::vector<double>& step_ends,
                                     const std::vector<Disturbance>& disturbances,
                                     const std::string& label, const Answering& by) {
  std::vector<Level> levels;
  for (const Disturbance& one : disturbances)
    levels.push_back(disturbed_level(first, step_ends, one));
  return run_levels(levels, std::vector<double>(levels.size(), 1), label, by);
}

/// Runs the twins of the ladder's first level, and beyond a horizon the ensemble.
PredictabilityAnswer run_twins(const LadderPlan& plan, const std::vector<LevelRun>& runs,
                               const Answering& by) {
  const Scene& scene = plan.input_case.scene;
  const double fraction = by.options.fraction;
  const int members = by.options.ensemble;
  const Level first = time_level(plan, 0, {});
  const std::vector<double>& ends = runs.front().step_ends;
  const std::vector<Disturbance> two = twin_disturbances(scene, runs, fraction);
  const std::vector<LevelRun> twins = disturbed_runs(first, ends, two, "its start disturbed", by);
  PredictabilityAnswer answer{predictability(scene, runs.front(), two, twins, fraction), 0, {}};
  if (!(answer.of.horizon < answer.of.end) || members < 2) return answer;
  std::vector<Disturbance> further;
  for (int n = 2; n <= members; ++n) further.push_back({two[1].size, unsigned(n)});
  std::vector<LevelRun> ensemble =
      disturbed_runs(first, ends, further, "an ensemble of such starts", by);
  ensemble.push_back(twins[1]);
  answer.ensemble = members;
  answer.statistics = statistics_over_runs(scene, ensemble, runs, answer.of.horizon);
  return answer;
}

/// Of positions before the horizon.
LadderAnswer answer_until(const Predictability& twins, const LadderPlan& plan,
                          const std::vector<LevelRun>& runs) {
  const bool is_cut = twins.horizon < twins.end;
  return time_answer(plan, is_cut ? frames_until(runs, twins.horizon) : runs,
                     integrator_named(plan.input_case.scene.integrator).order);
}

/// Adds levels until the orders have settled, or the next one costs more than what is left of the
/// budget.
void add_levels(const LadderPlan& plan, const Predictability& twins, const Answering& by,
                std::vector<LevelRun>& runs) {
  double left = by.options.budget;
  while (int(runs.size()) < most_levels && may_settle(answer_until(twins, plan, runs))) {
    const double last = runs.back().seconds, before = runs[runs.size() - 2].seconds;
    const double next = last * std::clamp(last / before, 1.5, 3.0);
    if (next > left) {
      log_line(fmt::format("a level more would take {}; --budget leaves {}", duration_text(next),
                           duration_text(left)));
      return;
    }
    left -= next;
    const Level level = time_level(plan, int(runs.size()), runs[0].step_ends);
    runs.push_back(run_levels({level}, {1}, "another level", by).front());
  }
}

/// The first level, and the others, which divide its steps; positions before the horizon only.
Told told_in_time(const LadderPlan& plan, const Answering& by) {
  const auto level = [&](int k, const std::vector<LevelRun>& runs) {
    return time_level(plan, k, k > 0 ? runs[0].step_ends : std::vector<double>());
  };
  LadderRuns done = run_ladder({plan.levels, level}, by, limits_of(by.options.hours));
  if (!done.refused.empty()) log_line(done.refused);
  PredictabilityAnswer twins = run_twins(plan, done.runs, by);
  if (by.options.levels == 0 && by.options.solver.empty() && done.refused.empty())
    add_levels(plan, twins.of, by, done.runs);
  LadderAnswer ladder = answer_until(twins.of, plan, done.runs);
  limit_to_horizon(plan.measurements, done.runs, twins.of, ladder);
  return {std::move(ladder), std::move(twins), {}, {}, done.runs.back()};
}

/// Another solver, which has reached the end with the case's own step: what cannot be asked of it
/// is refused before the reference runs.
struct TriedSolver {
  /// Throws InputError if the solver cannot be started, does not offer what the case needs, or does
  /// not reach the end.
  TriedSolver(const LadderPlan& plan, const Options& options, const LevelSetProvider& level_sets)
      : trial(solver_command(options)), ladder(plan, trial, level_sets), first(ladder.run(0)) {
    if (!first.stopped.empty())
      throw InputError("the solver does not reach the end with the case's own step: " +
                       first.stopped);
  }

  Trial trial;
  SolverLadder ladder;
  LevelRun first;
};

/// The runs of another solver, coarse to fine, one after the other. None is kept in a store: the
/// program behind the command may change.
std::vector<LevelRun> solver_runs(TriedSolver& other, int levels) {
  std::vector<LevelRun> runs{std::move(other.first)};
  ProgressLine line("levels of the solver");
  const double all = std::exp2(levels) - 1;  // if each takes twice the one before
  for (int k = 1; k < levels; ++k) {
    runs.push_back(other.ladder.run(k));
    line.show((std::exp2(k + 1) - 1) / all);
  }
  return runs;
}

/// Of another solver, asked before the reference's horizon only.
Told told_of_solver(const LadderPlan& plan, const Told& reference, TriedSolver& other) {
  std::vector<LevelRun> runs = solver_runs(other, plan.levels);
  const double horizon = reference.twins->of.horizon;
  LevelRun finest = reference.finest;
  if (horizon < reference.twins->of.end) {
    runs = frames_until(std::move(runs), horizon);
    finest = frames_until({finest}, horizon).front();
  }
  Told told{other.ladder.answer(runs), {}, {}, {}, {}, other.trial.mapping()};
  const Scene& scene = plan.input_case.scene;
  told.gap = solver_gap(runs.back(), told.ladder, finest, reference.ladder, masses_of(scene));
  return told;
}

Told told_in_space(const CaseSource& source, const Answering& by) {
  const auto objects = by.options.refines_objects ? ObjectsToo::yes : ObjectsToo::no;
  const SpaceRuns done = run_meshes(space_ladder(source, levels_of(by.options), objects), by,
                                    limits_of(by.options.hours));
  if (!done.levels.refused.empty()) log_line(done.levels.refused);
  return {space_answer(done.ladder, done.levels.runs, done.halved), {}, {}, {}};
}

/// motion: of the case as it is [m].
MapAnswer map_answer(const LadderAnswer& in_time, const LadderAnswer& in_space, double motion,
                     const Options& options) {
  MapAnswer answer{error_map(in_time, in_space, motion), {}};
  if (answer.map.reason.empty())
    for (const std::string& error : options.errors)
      answer.pairs.push_back(cheapest_pair(answer.map, std::stod(error)));
  return answer;
}

LadderPlan plan_of(const CaseSource& source, const Options& options) {
  LadderPlan plan{case_of(source), levels_of(options), {}};
  plan.measurements = measurements_of(plan.input_case);
  require_asked_before_end(plan.measurements, plan.input_case.scene.schedule.end);
  return plan;
}

/// other: null without --solver.
std::vector<Told> told_for(const CaseSource& source, TriedSolver* other, const Answering& by) {
  const LadderPlan plan = plan_of(source, by.options);
  std::vector<Told> all;
  if (by.options.in != "space") all.push_back(told_in_time(plan, by));
  if (other) all.push_back(told_of_solver(plan, all[0], *other));
  if (by.options.in != "time") all.push_back(told_in_space(source, by));
  if (by.options.in == "both")
    all[1].map = map_answer(all[0].ladder, all[1].ladder, all[0].twins->of.motion, by.options);
  return all;
}

/// Those asked for, or the case's own, "".
std::vector<std::string> methods_of(const Options& options) {
  std::vector<std::string> methods = options.methods;
  if (std::ranges::find(methods, "all") != methods.end()) {
    methods.clear();
    for (const Integrator& integrator : integrators()) methods.emplace_back(integrator.name);
  }
  for (const std::string& method : methods) integrator_named(method);
  if (methods.empty()) methods.emplace_back();
  return methods;
}

nlohmann::json to_json(const Told& told) {
  nlohmann::json all = to_json(told.ladder);
  if (told.twins) all["predictability"] = to_json(*told.twins);
  if (told.map) all["map"] = to_json(*told.map);
  if (told.gap) {
    all["solver"] = true;
    all["from_reference"] = told.gap->distance;
    all["beyond_steps"] = told.gap->is_beyond_steps();
    all["in_words"] = in_words(*told.gap, told.ladder.method);
    for (const auto& [key, value] : told.mapping) all["mapping"][key] = value;
  }
  return all;
}

void print(const SolverGap& gap, const std::string& solver,
           const std::vector<std::pair<std::string, std::string>>& mapping) {
  fmt::print("\n{}\n", in_words(gap, solver));
  for (const auto& [key, value] : mapping) fmt::print("mapping of {}: {}\n", key, value);
}

/// One ladder as an object; several as a list, "ladders". Beside them the program, and how the
/// case was asked.
nlohmann::json to_json(const std::vector<Told>& all, const Options& options) {
  nlohmann::json answer;
  if (all.size() == 1) {
    answer = to_json(all.front());
  } else {
    answer["ladders"] = nlohmann::json::array();
    for (const Told& told : all) answer["ladders"].push_back(to_json(told));
  }
  const double end = read_case(case_file(options.file), options.overrides).scene.schedule.end;
  answer["end"] = end;
  answer["asked_end"] = options.until > 0 ? std::min(options.until, end) : end;
  answer["overrides"] = options.overrides;
  answer["program"] = program_json(options.command);
  return answer;
}

int report(const std::vector<Told>& all, const Options& options) {
  bool is_conclusive = true;
  for (const Told& told : all) {
    is_conclusive &= told.ladder.quantities.front().bar.reading != Reading::inconclusive;
    if (options.json) continue;
    print(told.ladder);
    if (told.twins) print(*told.twins);
    if (told.map) print(*told.map);
    if (told.gap) print(*told.gap, told.ladder.method, told.mapping);
    if (&told != &all.back()) fmt::print("\n");
  }
  if (options.json) fmt::print("{}\n", json_text(to_json(all, options)));
  return is_conclusive ? all_hold : some_fail;
}

}  // namespace

int converge(const ConvergeOptions& options) {
  if (options.over.empty() && options.runs.empty() && !options.at.empty())
    throw InputError("--at needs --over, or --runs");
  if (options.file.empty() == options.runs.empty())
    throw InputError("converge takes a CASE, or --runs TABLE.csv");
  if (!options.over.empty() || !options.runs.empty()) return converge_settings(options);
  const LevelSetProvider level_sets =
      memoizing_provider(provider_for(options.cache, threads_of(options.running)));
  CaseSource source{case_file(options.file), options.overrides, "", options.until};
  const std::vector<std::string> methods = methods_of(options);
  if (!options.solver.empty() && methods.size() > 1)
    throw InputError("--solver is held against one method of the reference");
  const Scene scene = case_of(source).scene;
  build(scene, level_sets);  // refuses now what cannot be built
  source.method = methods.front();
  std::optional<TriedSolver> other;
  if (!options.solver.empty()) other.emplace(plan_of(source, options), options, level_sets);
  const OutFolder folder(options.out);
  require_replaceable(options.out + "/converge.h5");
  log_warnings(scene);
  ResultStore store(options.out + "/store");
  const InterruptionNotice notice("finished runs are kept in " + options.out + "/store",
                                  typed_again(options.words));
  std::vector<Told> all;
  std::vector<StudyRecord> studies;
  const Answering by{{{level_sets, store, program_identity()}, options.running}, options};
  for (const std::string& method : methods) {
    source.method = method;
    for (Told& told : told_for(source, other ? &*other : nullptr, by)) {
      const std::string further = told.twins ? in_words(told.twins->of)
                                  : told.gap ? in_words(*told.gap, told.ladder.method)
                                             : "";
      studies.push_back(study_of(told.ladder, further));
      if (told.map) studies.push_back(map_study(told.map->map, told.map->pairs));
      all.push_back(std::move(told));
    }
  }
  RunRecord run;
  run.provenance = provenance(options.command);
  for (const StudyRecord& study : studies) run.seconds += study.seconds;
  run.studies = std::move(studies);
  write_run(options.out + "/converge.h5", run);
  return report(all, options);
}

namespace {

/// Options of the ladder: its direction, levels, methods and limits.
void add_ladder(CLI::App* converge, Options& options) {
  add_value(converge, "--in WHAT", options.in,
            "Refine time (the steps), space (the mesh), or both, one after the other",
            one_of({"time", "space", "both"}))
      ->capture_default_str();
  add_value(converge, "--levels N", options.levels,
            "Runs, 3 to 12, each with half the steps, or edges half as long (default: 4; "
            "in time more, until the orders have settled or --budget is spent)",
            whole_number(3, 12));
  add_value(converge, "--budget S", options.budget,
            "Without --levels: time for levels beyond the fourth [s]; 0: none",
            CLI::NonNegativeNumber)
      ->capture_default_str();
  add_method(converge, options, "case's own");
  converge->add_flag("--refine-objects", options.refines_objects,
                     "In space: also refine the level sets of objects, by the same factor");
  add_value(converge, "--until TIME", options.until,
            "Use only the beginning of the run, up to this time [s]", positive_number());
  add_value(converge, "--hours H", options.hours,
            "Refuse levels that would make the whole call take longer than this [h]",
            positive_number());
}

/// Options of the map over settings.
void add_settings_map(CLI::App* converge, ConvergeOptions& options) {
  CLI::Option* over =
      add_value(converge, "--over NAMES", options.over,
                "Map the error over one or two tunables that the solver declares, and `step`; of "
                "the reference over step, tolerance, or both");
  over->delimiter(',')->excludes("--in")->excludes("--levels");
  add_value(converge, "--runs TABLE", options.runs,
            "The same, of runs that were made elsewhere: a CSV file, without a CASE")
      ->excludes(over);
  add_value(converge, "--at VALUES", options.at,
            "The settings in use, such as 4,8 (default: the solver's own, or the first row)",
            positive_number())
      ->delimiter(',');
}

/// Options of the disturbed runs.
void add_twins(CLI::App* converge, Options& options) {
  add_value(
      converge, "--fraction SHARE", options.fraction,
      "Positions count as unpredictable once disturbed runs differ by this share of the motion",
      share())
      ->capture_default_str();
  add_value(converge, "--ensemble N", options.ensemble,
            "Runs with disturbed starts, whose statistics are compared once positions are "
            "not predictable; below 2: none",
            whole_number(0, 1000))
      ->capture_default_str();
}

constexpr const char* below_converge =
    R"(Runs the case as it is, then refined level by level. Prints for each quantity the order at which
differences between levels fall, Richardson's limit, and the grid convergence index as error bar
(safety factor 1.25 where the order has settled at the method's, else 3). Quantities are those of
the case's [[quantity]] tables; without any: positions, energies, heights, quantities in [expect].

--in time    halves every step at each level.
--in space   halves every edge at each level: shapes by their counts, such as columns and rows;
             other meshes are split at the middles of edges. Positions are compared at the case's
             own particles. In [[hold]], a box holds a region, a list of particles holds points.
             All meshes take the steps that the finest one needs; one more run, with half the
             step, measures their error.
--in both    does both, and maps the error over step and mesh: names the cheapest pair for each of
             --errors, forecasts its cost, and says what half the error costs.

Two more runs start disturbed: by 1e-12 of the cloth's extent, and by the size of the step's error.
When they differ from the undisturbed run by --fraction of its motion, positions are no longer
predictable. Orders and error bars use only the time before that. For the time after it, --ensemble
disturbed runs give means over time of height, energies, contacts and fold angles, and their spread.

--solver CMD also runs another solver (verification/subjects/PROTOCOL.md), with equal steps from
frame to frame that are halved in the same way. Says how far its finest run is from the reference's,
and whether both error bars explain that. A case can have what the protocol can say: particles held
still, self-collision, and planes, boxes, spheres and capsules at rest. The solver's runs are not
kept.

--over NAMES maps the error over the settings that a solver declares (`tunables` in PROTOCOL.md), as
substeps and iterations, or over step and tolerance of the reference. Says how far positions, sag,
height and largest strain are from the solver's own limit, and from the reference's; whether that is
discretisation, an unconverged solve or rounding; whether there is a limit at all; and the cheapest
pair for each of --errors, which was run. Rows of one iteration count are refined in turn, so that
it costs at most a third of a grid; --hours limits it (default: 5 min).
--runs TABLE.csv does so with runs that were made elsewhere: columns of one or two tunables,
`frames` (a folder or a cache), and, if you like, `seconds`; a row "truth" has the converged frames.

The folder keeps every run: an interrupted call resumes; a second call runs only what is missing.
The two coarsest levels run alone first and show what the others will cost. A level that exceeds the
memory or --hours is refused; the other levels still give a result. Seconds are processor time of a
run's own thread. DIR/converge.h5 is for `foldproof report DIR`.

Examples:
  foldproof converge hanging_sheet --solver ./adapter --settings iterations=20
  foldproof converge hanging_sheet --solver ./adapter --over substeps,iterations --at 4,8

Exit codes:
  0    the positions have an order, or at least an error bar
  1    the order of the positions is inconclusive
  2    bad input, or a file that cannot be written)";

}  // namespace

void add_converge_command(CLI::App& app, Program& program) {
  auto [command, options] = add_command(
      app, program,
      {"converge",
       "How large are the errors of a case's step and mesh? Orders, limits and error bars",
       below_converge},
      converge);
  add_input(command, "CASE", options.file, case_words)->required(false);
  add_ladder(command, options);
  add_settings_map(command, options);
  add_twins(command, options);
  add_errors(command, options,
             "In both: errors to find the cheapest step and mesh for, as shares of the motion "
             "(default: 1e-2,1e-3)");
  add_overrides(command, options);
  add_other_solver(command, options,
                   "Also halve the steps of another solver, started by this command")
      ->excludes("--in")
      ->excludes("--refine-objects");
  add_folder(command, options,
             "Folder whose store/ keeps every run; a second call runs only missing ones")
      ->capture_default_str();
  add_cache(command, options);
  add_threads(command, options);
  add_json(command, options);
}

}  // namespace foldproof
