// foldproof ablate: runs a case without each of its parts, and with those that it lacks and that
// need no numbers from its author, and says which it needs.

#include <fstream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>

#include "scripts/program/command_line/options_of_commands.h"
#include "convergence/any_case/ablation.h"
#include "convergence/any_case/own_error.h"
#include "reference/bodies/level_set_provider.h"
#include "scripts/program/command_line/input_files.h"
#include "scripts/program/interruption.h"
#include "scripts/program/json_text.h"
#include "scripts/program/command_line/out_folder.h"
#include "scripts/program/command_line/typed_words.h"
#include "scripts/program/program_json.h"
#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"
#include "scripts/program/run_case.h"
#include "verification/files/atomic_file.h"
#include "verification/files/level_set_folder.h"

namespace foldproof {

namespace {

/// A case and all runs that are asked of it.
struct Ablation {
  CaseSource source;  // ends where the ablation does
  Case input_case;
  LevelSetProvider level_sets;  // of all its runs; each is made once
  std::vector<ScenePart> parts;
  ObservedRun scene;
  int mesh_levels;
  std::vector<ObservedRun> toggled;  // one a part
  size_t runs_left = 0;
  DiscretisationError error;
  std::vector<JudgedPart> judged_parts;
};

/// How much of the case's run is asked [s].
double ablation_end(const Case& input_case) {
  const double whole = input_case.scene.schedule.end;
  return input_case.ablated_until > 0 ? std::min(whole, input_case.ablated_until) : whole;
}

Ablation plan_ablation(const std::string& file, const Options& options,
                       const LevelSetProvider& level_sets) {
  Ablation plan;
  plan.source = {file, options.overrides, "", 0};
  plan.mesh_levels = options.mesh_levels;
  plan.input_case = case_of(plan.source);
  plan.level_sets = level_sets;
  const Case& input_case = plan.input_case;
  // refuses now what cannot be built; its level sets serve every run
  build(input_case.scene, level_sets);
  plan.parts = parts_of(input_case.scene);
  reject_unknown_parts(input_case, plan.parts);
  plan.toggled.resize(plan.parts.size());
  plan.source.until = ablation_end(input_case);
  plan.error.mesh.unknown = declared_reason(input_case, finer_mesh);
  if (input_case.coarser_mesh.empty()) return plan;
  if (!plan.error.mesh.unknown.empty())
    throw InputError(file + ": [ablation] does without a finer mesh, and names a coarser one");
  std::vector<std::string> overrides = options.overrides;
  overrides.insert(overrides.end(), input_case.coarser_mesh.begin(), input_case.coarser_mesh.end());
  const Case coarser = read_case(file, overrides);
  try {
    coarseness(input_case.scene.mesh, coarser.scene.mesh);
  } catch (const InputError& error) {
    throw InputError(fmt::format(
        "{}: [ablation] coarser_mesh: {}, or --set 'ablation.coarser_mesh=\"\"' for a finer one",
        file, error.what()));
  }
  return plan;
}

/// Called when a run has ended, by one thread at a time.
using AfterRun = std::function<void(Ablation&)>;

/// What one of the case's jobs does; an error goes into `why`.
Job job_of(Ablation& one, double length, std::function<void()> act, std::string& why,
           const AfterRun& after) {
  ++one.runs_left;
  return {one.input_case.scene.name, length,
          [&one, act = std::move(act), &why, after](const Progress&) {
            try {
              act();
            } catch (const std::exception& error) {
              why = error.what();
            }
            after(one);
            return RunRecord{};
          }};
}

/// The case's run with its scene changed, which goes into `into`.
Job run_job(Ablation& one, double length, std::function<Scene(Scene)> change, ObservedRun& into,
            const AfterRun& after) {
  const auto act = [&one, change = std::move(change), &into] {
    Scene scene = change(one.input_case.scene);
    scene.schedule.end = ablation_end(one.input_case);
    into = observe_run(with_scene(one.input_case, std::move(scene)), one.level_sets,
                       one.input_case.scene.mesh.particles());
  };
  return job_of(one, length, act, into.stopped, after);
}

/// How long the runs of that many meshes take, in runs of the case: each finer mesh has four times
/// the particles and half the steps, which all coarser ones take, too.
double length_of_meshes(int levels) { return 1.5 * std::pow(8, levels - 1); }

Job mesh_job(Ablation& one, const KeptRuns& by, const AfterRun& after) {
  const std::vector<std::string>& coarser = one.input_case.coarser_mesh;
  const auto act = [&one, &coarser, &by] {
    one.error.mesh = coarser.empty() ? error_of_mesh(one.source, one.mesh_levels, by)
                                     : error_from_coarser_mesh(one.source, coarser, by);
  };
  const double length = coarser.empty() ? length_of_meshes(one.mesh_levels) : 0.2;
  return job_of(one, length, act, one.error.mesh.unknown, after);
}

/// Case by case, so that what is cut off has whole cases.
std::vector<Job> jobs_of(std::vector<Ablation>& all, const KeptRuns& by, const AfterRun& after) {
  std::vector<Job> jobs;
  for (Ablation& one : all) {
    const size_t earlier = jobs.size();
    jobs.push_back(run_job(
        one, 1, [](Scene s) { return s; }, one.scene, after));
    jobs.push_back(job_of(
        one, 7, [&one, &by] { one.error.time = error_of_steps(one.source, by); },
        one.error.time.unknown, after));
    if (one.error.mesh.unknown.empty()) jobs.push_back(mesh_job(one, by, after));
    for (size_t k = 0; k < one.parts.size(); ++k)
      jobs.push_back(run_job(one, 1.1, one.parts[k].toggled, one.toggled[k], after));
    for (size_t k = earlier; k < jobs.size(); ++k) jobs[k].group = int(&one - all.data());
  }
  return jobs;
}

/// Positions of all frames of all runs are half a gigabyte of a large case.
void forget_positions(Ablation& one) {
  one.scene.x = {};
  for (JudgedPart& part : one.judged_parts) part.run.x = {};
}

void judge(Ablation& one) {
  const TriangleMesh& mesh = one.input_case.scene.mesh;
  const PerParticle mass = masses_of(one.input_case.scene);
  one.error.floor = 1e-6 * longest_side(mesh.rest);
  for (size_t k = 0; k < one.parts.size(); ++k) {
    one.judged_parts.push_back(
        judge_part(one.parts[k], one.scene, std::move(one.toggled[k]), one.error, mass));
    one.judged_parts.back().declared = declared_reason(one.input_case, one.parts[k].name);
  }
  forget_positions(one);
}

/// Why nothing can be said of the scene's parts: its own run is not what its author
/// wants; "" if it is.
std::string wrong_by_itself(const Ablation& one) {
  if (!one.scene.stopped.empty()) return "the scene itself stops early: " + one.scene.stopped;
  if (one.scene.failed_keys.empty()) return "";
  return fmt::format("expectations of the scene itself fail: {}",
                     fmt::join(one.scene.failed_keys, ", "));
}

nlohmann::json to_json(const ObservedRun& run) {
  const Work& work = run.work;
  return {{"seconds", run.seconds},
          {"steps", run.steps},
          {"elastic_evaluations", work.elastic_evaluations},
          {"cg_iterations", work.cg_iterations},
          {"object_queries", work.object_queries},
          {"strain_sweeps", work.strain_sweeps},
          {"crossing_queries", work.crossing_queries},
          {"deepest", run.deepest},
          {"crossings", run.crossings},
          {"stopped", run.stopped},
          {"failed", run.failed_keys}};
}

nlohmann::json to_json(const Ablation& one, const std::vector<std::string>& overrides) {
  nlohmann::json parts = nlohmann::json::array();
  for (const JudgedPart& part : one.judged_parts)
    parts.push_back({{"name", part.name},
                     {"present", part.is_present},
                     {"need", std::string(name_of(part.need))},
                     {"because", part.reason},
                     {"declared", part.declared},
                     {"as_it_should_be", part.is_justified()},
                     {"position_difference", part.position_difference},
                     {"energy_difference", part.energy_difference},
                     {"run", to_json(part.run)}});
  return {{"case", one.input_case.scene.name},
          {"overrides", overrides},
          {"asked_end", ablation_end(one.input_case)},
          {"end", one.input_case.scene.schedule.end},
          {"wrong", wrong_by_itself(one)},
          {"size", longest_side(one.input_case.scene.mesh.rest)},
          {"own_error",
           {{"levels", levels_of_own_error},
            {"mesh_levels", one.mesh_levels},
            {"time", one.error.time.value},
            {"time_without_bar", one.error.time.seen},
            {"mesh", one.error.mesh.value},
            {"mesh_without_bar", one.error.mesh.seen},
            {"floor", one.error.floor},
            {"value", one.error.value()},
            {"without_bar", one.error.seen()},
            {"without_time", one.error.time.unknown},
            {"without_mesh", one.error.mesh.unknown},
            {"coarser_mesh", one.input_case.coarser_mesh}}},
          {"run", to_json(one.scene)},
          {"parts", std::move(parts)}};
}

/// All cases whose runs are over.
nlohmann::json to_json(const std::vector<Ablation>& all, const Options& options) {
  nlohmann::json cases = nlohmann::json::array();
  for (const Ablation& one : all)
    if (one.runs_left == 0) cases.push_back(to_json(one, options.overrides));
  return {{"schema", 1}, {"program", program_json(options.command)}, {"cases", std::move(cases)}};
}

/// The new results, followed by the file's results for other cases if the same program wrote it.
nlohmann::json with_others_of(const std::string& path, nlohmann::json found) {
  if (!std::filesystem::is_regular_file(path)) return found;
  try {
    std::ifstream file(path);
    const nlohmann::json before = nlohmann::json::parse(file);
    if (before.at("program").at("identity") != found["program"]["identity"]) return found;
    std::set<std::string> expected_keys;
    for (const nlohmann::json& row : found["cases"]) expected_keys.insert(row["case"]);
    for (const nlohmann::json& row : before.at("cases"))
      if (!expected_keys.count(row.at("case"))) found["cases"].push_back(row);
  } catch (const nlohmann::json::exception&) {  // no file of ours: it is replaced
  }
  return found;
}

/// from: the runs that it was read from.
std::string error_text(const ErrorPart& error, const std::string& from) {
  if (std::isnan(error.value)) return "not known: " + error.unknown;
  return fmt::format("{:.2g} m, {:.2g} m with its error bar ({})", error.seen, error.value, from);
}

std::string mesh_error_text(const Ablation& one) {
  const std::vector<std::string>& coarser = one.input_case.coarser_mesh;
  return error_text(one.error.mesh,
                    coarser.empty() ? fmt::format("{} meshes", one.mesh_levels)
                                    : fmt::format("a coarser mesh, {}", fmt::join(coarser, ", ")));
}

void print(const Ablation& one) {
  const double whole = one.input_case.scene.schedule.end, end = ablation_end(one.input_case);
  const std::string first =
      end < whole ? fmt::format(" (its first {:g} s of {:g})", end, whole) : "";
  fmt::print("{}{}: {:.2f} s; own error {:.2g} m, {:.2g} m with its error bar\n",
             one.input_case.scene.name, first, one.scene.seconds, one.error.seen(),
             one.error.value());
  fmt::print("  its steps: {}\n  its mesh: {}\n", error_text(one.error.time, "steps halved twice"),
             mesh_error_text(one));
  if (const std::string wrong = wrong_by_itself(one); !wrong.empty()) fmt::print("! {}\n", wrong);
  for (const JudgedPart& part : one.judged_parts) {
    fmt::print("{} {:<18} {:<30} {:5.0f} % of the time; {}\n", part.is_justified() ? ' ' : '!',
               name_of(part.need), (part.is_present ? "" : "with ") + part.name,
               100 * part.run.seconds / one.scene.seconds, part.reason);
    if (!part.declared.empty()) fmt::print("{:>20} {}\n", "declared:", part.declared);
  }
}

std::vector<Ablation> ablations_of(const Options& options) {
  std::vector<Ablation> all;
  const LevelSetProvider level_sets =
      memoizing_provider(provider_for(options.cache, threads_of(options.running)));
  std::vector<std::string> files = options.names;
  if (files.empty())
    for (const std::string& name : built_in_cases(tier_of(options)))
      files.push_back(shipped_case_file(name));
  for (const std::string& file : files)
    all.push_back(plan_ablation(case_file(file), options, level_sets));
  return all;
}

/// Writes what is found so far: a run of hours that is cut off leaves the cases that it
/// was through with.
void write(const std::vector<Ablation>& all, const Options& options) {
  const std::string path = options.out + "/ablation.json";
  write_text(path, json_text(with_others_of(path, to_json(all, options))) + "\n");
}

}  // namespace

int ablate(const Options& options) {
  std::vector<Ablation> all = ablations_of(options);
  const OutFolder folder(options.out);
  require_replaceable(options.out + "/ablation.json");
  for (const Ablation& one : all) log_warnings(one.input_case.scene);
  ResultStore store(options.out + "/store");
  const InterruptionNotice notice(
      fmt::format(
          "finished cases are kept in {0}/ablation.json, and runs of their errors in {0}/store",
          options.out),
      typed_again(options.words));
  const KeptRuns by{all.empty() ? computing_provider() : all.front().level_sets, store,
                    program_identity()};
  std::mutex one_at_a_time;
  const AfterRun after = [&](Ablation& one) {
    const std::lock_guard lock(one_at_a_time);
    if (--one.runs_left > 0) return;
    judge(one);
    try {
      write(all, options);
    } catch (const InputError&) {  // it is tried again at the end, and then told
    }
  };
  RunRecord run;
  run_jobs(jobs_of(all, by, after), "scenes with and without their parts", options.running, run);
  write(all, options);
  bool is_minimal = run.records.empty();  // which tell of runs that could not be judged
  for (const Ablation& one : all) {
    is_minimal &= wrong_by_itself(one).empty();
    for (const JudgedPart& part : one.judged_parts) is_minimal &= part.is_justified();
  }
  if (options.json) fmt::print("{}\n", json_text(to_json(all, options)));
  for (const Ablation& one : all)
    if (!options.json && one.runs_left == 0) print(one);
  return is_minimal ? all_hold : some_fail;
}

namespace {

constexpr const char* below_ablate =
    R"(First finds the scene's own error, as converge does: that of its steps, from steps halved twice,
and that of its mesh, from edges halved once (--mesh-levels 3: twice, in ten times the time). With
two meshes, the error bar is three times their difference. OUT/store keeps these runs; those that
converge left there are not repeated. Then ablate removes one part at a time, and adds, one at a
time, the missing parts that need no parameters: self-collision, strain limits, points between
particles. A part is needed, or missing, if one of these happens without it:
- particles move by more than the scene's own error, error bar included;
- the run does not reach its end, or an expectation of the case fails or loses its meaning;
- the cloth crosses itself, or lies deeper in an object by more than the scene's own error.
Where a change exceeds the error, but not the error with its bar, ablate says "cannot tell". The
table [ablation] of a case file can justify a part that is not needed, or the lack of one that is.
It can name a coarser mesh where a finer one would take hours, and limit ablate to the beginning of
a run.

Examples:
  foldproof ablate hinge
  foldproof ablate grab --set time.end=0.2 --out mine

Exit codes:
  0    every part is needed, none is missing
  1    a part (marked !) is not needed, or is missing, and the case gives no reason; or it gives one
       that is not called for; or the unchanged scene stops early, or fails an expectation
  2    bad input, or a file that cannot be written)";

}  // namespace

void add_ablate_command(CLI::App& app, Program& program) {
  auto [command, options] = add_command(
      app, program,
      {"ablate",
       "Which of its parts does a case need, and which does it lack? Adds to ablation.json",
       below_ablate},
      ablate);
  command
      ->add_option("CASE", options.names,
                   "Case files, or names of shipped cases (default: all of the tier)")
      ->check(some_text("a case file"));
  add_value(command, "--mesh-levels N", options.mesh_levels,
            "Meshes that measure the mesh's error, 2 to 5; each takes about ten times as "
            "long as the one before",
            whole_number(2, 5))
      ->capture_default_str();
  add_tier(command, options);
  add_overrides(command, options);
  add_threads(command, options);
  add_cache(command, options);
  add_folder(command, options, "Folder for ablation.json")->capture_default_str();
  add_json(command, options);
}

}  // namespace foldproof
