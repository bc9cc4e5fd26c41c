#include "scripts/program/any_case/converge_settings.h"

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>

#include "convergence/any_case/portable_case.h"
#include "convergence/any_case/settings_material.h"
#include "convergence/any_case/settings_report.h"
#include "convergence/any_case/solver_ladder.h"
#include "convergence/any_case/space_ladder.h"
#include "convergence/work_precision/precision_problem.h"
#include "scripts/program/any_case/ladder_runs.h"
#include "scripts/program/any_case/settings_table.h"
#include "scripts/program/command_line/input_files.h"
#include "scripts/program/command_line/options_of_commands.h"
#include "scripts/program/command_line/out_folder.h"
#include "scripts/program/command_line/typed_words.h"
#include "scripts/program/interruption.h"
#include "scripts/program/json_text.h"
#include "scripts/program/program_json.h"
#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"
#include "scripts/program/run_case.h"
#include "scripts/program/typed_solver.h"
#include "verification/files/atomic_file.h"
#include "verification/cases/quantities.h"
#include "verification/files/level_set_folder.h"
#include "verification/files/results_file.h"

namespace foldproof {

namespace {

constexpr double usual_hours = 5.0 / 60;

/// The tunables of --over as axes; `known`: those that there are. Iterations and tolerances last.
std::vector<SettingsAxis> axes_of(const ConvergeOptions& options,
                                  const std::vector<Tunable>& known) {
  if (options.over.size() > 2) throw InputError("--over takes one tunable, or two");
  if (!options.at.empty() && options.at.size() != options.over.size())
    throw InputError("--at needs a value for each tunable of --over");
  std::vector<SettingsAxis> axes;
  for (size_t k = 0; k < options.over.size(); ++k) {
    const auto found = std::ranges::find(known, options.over[k], &Tunable::name);
    if (found == known.end()) {
      std::string names;
      for (const Tunable& one : known) names += (names.empty() ? "" : ", ") + one.name;
      throw InputError(
          fmt::format("--over {}: no tunable of the solver; it has {}", options.over[k], names));
    }
    if (found->kind == TunableKind::relaxation)
      throw InputError("--over " + found->name + ": a relaxation has no finer values");
    SettingsAxis axis{found->name,  found->kind, found->value,
                      found->least, found->most, found->is_proportional};
    if (!options.at.empty()) axis.first = options.at[k];
    if (!axis.has(axis.first))
      throw InputError(fmt::format("--at {:g}: {} is from {:g} to {:g}", axis.first, axis.name,
                                   axis.least, axis.most));
    axes.push_back(axis);
  }
  std::ranges::stable_partition(axes, [](const SettingsAxis& axis) {
    return !axis.falls() && axis.kind != TunableKind::iterations;
  });
  return axes;
}

SettingsPair pair_in_use(const SettingsMap& map) {
  return {map.axes[0].first, map.axes.size() > 1 ? map.axes[1].first : 1};
}

SettingsCloth cloth_of(const Scene& scene) {
  return {masses_of(scene), scene.mesh.edges, rest_lengths(scene.mesh), up_in(scene)};
}

SettingsRun run_of(const SettingsMap& map, const SettingsPair& at, const LevelRun& level,
                   const SettingsCloth& cloth, double counted) {
  SettingsRun run = level.stopped.empty() ? measured_run(at, level.x, cloth) : SettingsRun{at};
  if (!level.stopped.empty()) run.stopped = level.stopped;
  run.seconds = std::isnan(level.seconds) ? level.clock : level.seconds;
  const bool counts = std::ranges::all_of(map.axes, &SettingsAxis::is_proportional);
  run.cost = !std::isnan(counted) ? counted : counts ? at[0] * at[1] : run.seconds;
  return run;
}

std::vector<double> wanted_of(const Options& options) {
  std::vector<double> wanted;
  for (const std::string& error : options.errors) wanted.push_back(std::stod(error));
  std::ranges::sort(wanted, std::greater());
  return wanted;
}

/// The cost that fits the time of the clock: by that of the pair in use, which is run first.
double cost_within(SettingsMap& map, const RunSettings& run, double hours) {
  const auto start = std::chrono::steady_clock::now();
  map.runs.push_back(run(pair_in_use(map)));
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  return map.cost() * 3600 * (hours > 0 ? hours : usual_hours) / took.count();
}

/// Makes the runs: the column of the pair in use, then what each quantity's pairs need.
SettingsAnswer searched(SettingsMap map, const ConvergeOptions& options, const RunSettings& run) {
  ProgressLine line("runs of the map");
  const double most = cost_within(map, run, options.hours);
  const RunSettings told = [&](const SettingsPair& at) {
    line.show(std::min(0.99, map.cost() / most));
    return run(at);
  };
  const SettingsPair in_use = pair_in_use(map);
  run_column(map, in_use, most, told);
  find_pairs(map, 0, wanted_of(options), most, told);
  const double more = std::min(most, 1.5 * map.cost());  // the others may cost half as much again
  for (size_t q = 1; q < map.quantities.size(); ++q)
    find_pairs(map, q, wanted_of(options), more, told);
  return settings_answer(std::move(map), in_use, wanted_of(options));
}

/// The reference's converged answer, from a ladder of its steps.
void add_truth(const LadderPlan& plan, const SettingsCloth& cloth, const LevelRunner& by,
               SettingsMap& map) {
  const auto level = [&](int k, const std::vector<LevelRun>& runs) {
    return time_level(plan, k, k > 0 ? runs[0].step_ends : std::vector<double>());
  };
  const LadderRuns done = run_ladder({plan.levels, level}, by, limits_of(0));
  SettingsMap reference{{{"steps"}}, map.quantities};
  for (size_t k = 0; k < done.runs.size(); ++k)
    reference.runs.push_back(
        run_of(reference, {std::exp2(k), 1}, done.runs[k], cloth, std::exp2(k)));
  for (size_t q = 0; q < map.quantities.size(); ++q) {
    const OwnLimit limit = own_limit(reference, q);
    if (!limit.unknown.empty()) continue;
    map.quantities[q].truth = limit.value, map.quantities[q].truth_bar = limit.bar;
  }
}

std::vector<Tunable> tunables_of(Trial& trial, long a_frame) {
  std::vector<Tunable> known = trial.declaration().tunables;
  known.push_back({"step", TunableKind::step, 1, 1 << 20, double(a_frame), true});
  return known;
}

/// Another solver's runs on a case, its tunables set from scene to scene.
struct TunedSolver {
  Trial trial;
  SolverLadder ladder;
  long a_frame;  // steps of a frame, where they are no tunable of the map

  TunedSolver(const LadderPlan& plan, const ConvergeOptions& options,
              const LevelSetProvider& level_sets)
      : trial(solver_command(options)), ladder(plan, trial, level_sets) {
    // substeps divide a frame; where none are asked, steps are the case's own
    const bool divides = std::ranges::any_of(trial.declaration().tunables, [&](const Tunable& t) {
      return t.kind == TunableKind::substeps && std::ranges::count(options.over, t.name);
    });
    a_frame = divides ? 1 : ladder.steps().a_frame;
  }

  /// Sets the tunables; returns the steps of a frame, `steps` where they are none of them.
  long tune(const SettingsMap& map, const SettingsPair& at, long steps) {
    std::map<std::string, double> values;
    for (size_t axis = 0; axis < map.axes.size(); ++axis)
      if (map.axes[axis].kind == TunableKind::step)
        steps = std::lround(at[axis]);
      else
        values[map.axes[axis].name] = at[axis];
    trial.tune(values);
    return steps;
  }

  LevelRun run(const SettingsMap& map, const SettingsPair& at, long steps) {
    return ladder.run_with(tune(map, at, steps));
  }
};

/// Whether half the substeps in half the step give the same: else something is done once a step.
std::string step_check(const SettingsAnswer& answer, TunedSolver& solver,
                       const SettingsCloth& cloth) {
  const SettingsMap& map = answer.map;
  const OwnLimit& limit = answer.quantities[0].limit;
  if (map.axes[0].kind != TunableKind::substeps || limit.value.size() == 0) return "";
  const SettingsRun* finest = nullptr;
  for (const SettingsRun& run : map.runs)
    if (run.stopped.empty() && std::lround(run.at[0]) % 2 == 0 &&
        (!finest || error_of(run, 0, limit) < error_of(*finest, 0, limit)))
      finest = &run;
  if (!finest) return "";
  const SettingsPair half{finest->at[0] / 2, finest->at[1]};
  const SettingsRun other = run_of(map, half, solver.run(map, half, 2 * solver.a_frame), cloth, 0);
  if (!other.stopped.empty()) return "";
  const double moved = size_of(other.seen[0] - finest->seen[0]) / limit.scale;
  const std::string head = fmt::format("half the step with half the {} moves positions by {:.2g} %",
                                       map.axes[0].name, 100 * moved);
  const double known = 3 * (error_of(*finest, 0, limit) + limit.bar / limit.scale);
  return moved > std::max(known, 1e-3)
             ? fmt::format("{}: {} do not refine all that a step does, such as contact", head,
                           map.axes[0].name)
             : head + ": they refine what a step does";
}

constexpr double seconds_to_rest = 10;       // of motion, about
constexpr double seconds_for_material = 10;  // of the processor

/// At the pair in use and at the finest pair that is named and can be asked in that time; none
/// where a cloth finds no rest.
std::vector<ApparentMaterial> material_of(const SettingsAnswer& answer, TunedSolver& solver,
                                          const Scene& scene) {
  const PricedPair* fine = nullptr;
  for (const PricedPair& pair : answer.quantities[0].pairs)
    if (const SettingsRun* run = answer.map.find(pair.at);
        run && run->seconds * seconds_to_rest < seconds_for_material * scene.schedule.end)
      fine = &pair;
  if (!fine) return {};
  const auto young = [&](const SettingsPair& at) {
    const long steps = solver.tune(answer.map, at, solver.a_frame);
    return apparent_young(solver.trial, portable_case(scene),
                          solver.ladder.steps().interval / double(steps));
  };
  try {
    return {{"membrane stiffness", young(answer.in_use), young(fine->at), "N/m"}};
  } catch (const NotOffered&) {
  } catch (const FailedWithoutNumber&) {
  } catch (const SolverFailure& failure) {
    solver.trial.note(failure);
  }
  return {};
}

SettingsAnswer answer_of_solver(const LadderPlan& plan, const ConvergeOptions& options,
                                const LevelRunner& by) {
  TunedSolver solver(plan, options, by.kept.level_sets);
  const Scene& scene = plan.input_case.scene;
  const SettingsCloth cloth = cloth_of(scene);
  const Declaration& declared = solver.trial.declaration();
  SettingsMap map{axes_of(options, tunables_of(solver.trial, solver.a_frame)),
                  settings_quantities(cloth, 1e3 * declared.rounding() * longest_side(scene.x))};
  add_truth(plan, cloth, by, map);
  const RunSettings run = [&](const SettingsPair& at) {
    return run_of(map, at, solver.run(map, at, solver.a_frame), cloth, nan);
  };
  SettingsAnswer answer = searched(map, options, run);
  answer.scene = scene.name;
  answer.solver = declared.name + (declared.version.empty() ? "" : " " + declared.version);
  answer.step_check = step_check(answer, solver, cloth);
  answer.material = material_of(answer, solver, scene);
  return answer;
}

/// The reference's steps, whole multiples of those that the case takes, and its CG tolerance. Costs
/// are applications of force operators.
SettingsAnswer answer_of_reference(const CaseSource& source, const LadderPlan& plan,
                                   const ConvergeOptions& options, const LevelRunner& by) {
  const Scene& scene = plan.input_case.scene;
  const SettingsCloth cloth = cloth_of(scene);
  const std::vector<double> ends = stored_level(time_level(plan, 0, {}), by.kept).step_ends;
  const double count = double(ends.size()), tolerance = scene.solver.tolerance;
  SettingsMap map{axes_of(options, {{"step", TunableKind::step, count, 1e9, count, true},
                                    {"tolerance", TunableKind::tolerance, 1e-15, 0.5, tolerance}}),
                  settings_quantities(cloth, rounding_floor(longest_side(scene.x)))};
  for (SettingsAxis& axis : map.axes)
    if (axis.kind == TunableKind::step) axis.unit = count, axis.is_proportional = false;
  const RunSettings run = [&](const SettingsPair& at) {
    CaseSource tuned = source;
    int parts = 1;
    for (size_t axis = 0; axis < map.axes.size(); ++axis)
      if (map.axes[axis].falls())
        tuned.overrides.push_back(fmt::format("solver.tolerance={:.17g}", at[axis]));
      else
        parts = int(std::lround(at[axis] / count));
    Level level = time_level({case_of(tuned), 3, {}}, 0, {});
    level.input_case.scene.schedule.step.ends = divide_steps(ends, 0, parts);
    level.label = fmt::format("{}, {} steps", scene.name, parts * ends.size());
    const LevelRun made = stored_level(level, by.kept);
    return run_of(map, at, made, cloth, operator_applications(made.work));
  };
  SettingsAnswer answer = searched(map, options, run);
  answer.scene = scene.name, answer.solver = "foldproof " + scene.integrator;
  return answer;
}

std::string percent_text(double fraction) {
  return std::isfinite(fraction) ? fmt::format("{:.2g} %", 100 * fraction) : "-";
}

void print(const SettingsAnswer& answer) {
  const SettingsMap& map = answer.map;
  fmt::print("{}, {}: {} runs{}\n\n", answer.scene, answer.solver, map.runs.size(),
             cost_in_words(map));
  fmt::print("{:<16} {:<5} {:>12} {:>9} {:>9} {:>9} {:>9} {:>6} {:>9}  {}\n", "quantity", "unit",
             "own limit", "+-", "in use", "by first", "by second", "order", "truth", "made of");
  for (size_t q = 0; q < answer.quantities.size(); ++q) {
    const auto& [limit, pairs, in_use, ends, gap, gap_bar] = answer.quantities[q];
    fmt::print("{:<16} {:<5} {:>12} {:>9.2g} {:>9} {:>9} {:>9} {:>6.2f} {:>9}  {}\n",
               map.quantities[q].name, map.quantities[q].unit,
               limit.value.size() == 1 ? fmt::format("{:.6g}", limit.value(0, 0)) : "-", limit.bar,
               percent_text(in_use.all), percent_text(in_use.of_first),
               percent_text(in_use.of_second), limit.order, percent_text(in_use.from_truth),
               name_of(in_use.regime));
  }
  fmt::print(
      "\nin use: error of {} from the own limit; by first: what is left with {} converged; "
      "order: in {}\n\n",
      pair_text(map, answer.in_use), map.axes.size() > 1 ? map.axes[1].name : "it",
      map.axes[0].name);
  for (const std::string& sentence : settings_sentences(answer)) fmt::print("{}\n", sentence);
}

nlohmann::json to_json(const SettingsAnswer& answer, const Options& options) {
  const SettingsMap& map = answer.map;
  nlohmann::json told = {{"case", answer.scene},
                         {"solver", answer.solver},
                         {"cost", map.cost()},
                         {"cost_of_grid", map.cost_of_grid()},
                         {"in_use", answer.in_use},
                         {"sentences", settings_sentences(answer)},
                         {"step_check", answer.step_check},
                         {"program", program_json(options.command)}};
  for (const SettingsAxis& axis : map.axes) told["over"].push_back(axis.name);
  for (const SettingsRun& run : map.runs) {
    told["runs"].push_back({{"at", run.at},
                            {"cost", run.cost},
                            {"seconds", run.seconds},
                            {"error", error_of(run, 0, answer.quantities[0].limit)},
                            {"stopped", run.stopped}});
    for (size_t q = 0; q < run.seen.size(); ++q)
      if (run.seen[q].size() == 1)
        told["runs"].back()["values"][map.quantities[q].name] = run.seen[q](0, 0);
  }
  for (size_t q = 0; q < answer.quantities.size(); ++q) {
    const auto& [limit, pairs, in_use, ends, gap, gap_bar] = answer.quantities[q];
    nlohmann::json one = {{"name", map.quantities[q].name},
                          {"unit", map.quantities[q].unit},
                          {"limit", limit.value.size() == 1 ? limit.value(0, 0) : nan},
                          {"error_bar", limit.bar},
                          {"scale", limit.scale},
                          {"order", limit.order},
                          {"no_limit", limit.none},
                          {"unknown", limit.unknown},
                          {"error", in_use.all},
                          {"left_by_first", in_use.of_first},
                          {"left_by_second", in_use.of_second},
                          {"order_in_second", in_use.order_second},
                          {"from_truth", in_use.from_truth},
                          {"regime", name_of(in_use.regime)},
                          {"ends", ends},
                          {"limit_from_truth", gap},
                          {"bars", gap_bar},
                          {"pairs", nlohmann::json::array()}};
    for (const PricedPair& pair : pairs)
      one["pairs"].push_back({{"wanted", pair.wanted},
                              {"at", pair.at},
                              {"cost", pair.cost},
                              {"error", pair.error},
                              {"was_run", pair.was_run},
                              {"because", pair.because}});
    told["quantities"].push_back(std::move(one));
  }
  for (const ApparentMaterial& m : answer.material)
    told["material"].push_back(
        {{"name", m.name}, {"unit", m.unit}, {"in_use", m.in_use}, {"converged", m.converged}});
  return told;
}

int finish(const SettingsAnswer& answer, const ConvergeOptions& options) {
  RunRecord run;
  run.provenance = provenance(options.command);
  run.studies = {settings_study(answer)};
  run.seconds = run.studies[0].seconds;
  write_run(options.out + "/converge.h5", run);
  if (options.json)
    fmt::print("{}\n", json_text(to_json(answer, options)));
  else
    print(answer);
  const OwnLimit& limit = answer.quantities[0].limit;
  return limit.none.empty() && limit.unknown.empty() ? all_hold : some_fail;
}

}  // namespace

int converge_settings(const ConvergeOptions& options) {
  const OutFolder folder(options.out);
  require_replaceable(options.out + "/converge.h5");
  if (!options.runs.empty())
    return finish(settings_answer_of_table(options.runs, options.at, wanted_of(options)), options);
  const LevelSetProvider level_sets =
      memoizing_provider(provider_for(options.cache, threads_of(options.running)));
  const CaseSource source{case_file(options.file), options.overrides,
                          options.methods.empty() ? "" : options.methods.front(), options.until};
  const LadderPlan plan{case_of(source), 4, {}};
  log_warnings(plan.input_case.scene);
  ResultStore store(options.out + "/store");
  const InterruptionNotice notice(
      "finished runs of the reference are kept in " + options.out + "/store",
      typed_again(options.words));
  const LevelRunner by{{level_sets, store, program_identity()}, options.running};
  return finish(options.solver.empty() ? answer_of_reference(source, plan, options, by)
                                       : answer_of_solver(plan, options, by),
                options);
}

}  // namespace foldproof
