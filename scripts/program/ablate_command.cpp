// foldproof ablate: runs a case without each of its parts, and with those that it lacks and that need no numbers
// from its author, and says which it needs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "convergence/any_case/ablation.h"
#include "convergence/any_case/coarser_mesh.h"
#include "convergence/any_case/finer_scene.h"
#include "reference/bodies/makers.h"
#include "scripts/program/commands.h"
#include "scripts/program/command_line/input_files.h"
#include "scripts/program/json_text.h"
#include "scripts/program/command_line/out_folder.h"
#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"
#include "scripts/program/run_case.h"
#include "verification/files/whole_file.h"

namespace foldproof {

namespace {

/// A case and all runs that are asked of it.
struct Ablation {
  Case shown;
  LevelSetMakers level_sets;    // of all its runs; each is made once
  std::optional<Case> coarser;  // with the coarser mesh that it names
  std::vector<ScenePart> parts;
  RunObserved scene, half_steps, other_mesh;
  std::vector<RunObserved> toggled;  // one a part
  size_t runs_left = 0;
  OwnError own;
  std::vector<PartJudged> judged;
};

/// How much of the case's run is asked [s].
double asked_end(const Case& shown) {
  const double whole = shown.scene.schedule.end;
  return shown.ablated_until > 0 ? std::min(whole, shown.ablated_until) : whole;
}

Ablation planned(const std::string& file, const Options& options, const LevelSetMakers& level_sets) {
  Ablation plan{read_case(file, options.overrides), level_sets, {}, {}, {}, {}, {}, {}, 0, {}, {}};
  const Case& shown = plan.shown;
  build(shown.scene, level_sets);  // refuses now what cannot be built; its level sets serve every run
  plan.parts = parts_of(shown.scene);
  refuse_unknown_parts(shown, plan.parts);
  plan.toggled.resize(plan.parts.size());
  plan.other_mesh.stopped = declared_for(shown, finer_mesh);
  if (shown.coarser_mesh.empty()) return plan;
  if (!plan.other_mesh.stopped.empty())
    throw InputError(file + ": [ablation] does without a finer mesh, and names a coarser one");
  std::vector<std::string> overrides = options.overrides;
  overrides.insert(overrides.end(), shown.coarser_mesh.begin(), shown.coarser_mesh.end());
  plan.coarser = read_case(file, overrides);
  try {
    coarseness(shown.scene.mesh, plan.coarser->scene.mesh);
  } catch (const InputError& error) {
    throw InputError(
        fmt::format("{}: [ablation] coarser_mesh: {}, or --set 'ablation.coarser_mesh=\"\"' for a finer one",
                    file, error.what()));
  }
  return plan;
}

/// What is done when a run is over; by one thread at a time.
using AfterRun = std::function<void(Ablation&)>;

/// The run of `shown`, which `one` asks for and finds in `into`.
Job job_of(Ablation& one, double length, const Case& shown, std::function<Scene(const Scene&)> change,
           RunObserved& into, const AfterRun& after) {
  ++one.runs_left;
  return {one.shown.scene.name, length,
          [&one, &shown, change = std::move(change), &into, after](const Progress&) {
            const int particles = shown.scene.mesh.particles();
            try {
              Scene scene = change(shown.scene);
              scene.schedule.end = asked_end(shown);
              into = observed(with_scene(shown, std::move(scene)), one.level_sets, particles);
            } catch (const std::exception& error) {
              into.stopped = error.what();
            }
            after(one);
            return RunRecord{};
          }};
}

/// Case by case, so that what is cut off has whole cases. Finer meshes take some ten times as long: four times the particles, and smaller steps.
std::vector<Job> jobs_of(std::vector<Ablation>& all, const AfterRun& after) {
  const auto as_it_is = [](const Scene& s) { return s; };
  std::vector<Job> jobs;
  for (Ablation& one : all) {
    const Case& shown = one.shown;
    const size_t earlier = jobs.size();
    jobs.push_back(job_of(one, 1, shown, as_it_is, one.scene, after));
    jobs.push_back(job_of(one, 2, shown, with_half_steps, one.half_steps, after));
    if (one.coarser)
      jobs.push_back(job_of(one, 0.2, *one.coarser, as_it_is, one.other_mesh, after));
    else if (one.other_mesh.stopped.empty())
      jobs.push_back(job_of(one, 10, shown, with_finer_mesh, one.other_mesh, after));
    for (size_t k = 0; k < one.parts.size(); ++k)
      jobs.push_back(job_of(one, 1.1, shown, one.parts[k].toggled, one.toggled[k], after));
    for (size_t k = earlier; k < jobs.size(); ++k) jobs[k].group = int(&one - all.data());
  }
  return jobs;
}

double extent_of(const PerParticle3& x) {
  return (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).maxCoeff();
}

OwnError own_error(const Ablation& one, const PerParticle& mass) {
  const TriangleMesh& mesh = one.shown.scene.mesh;
  OwnError own{nan, nan, 1e-6 * extent_of(mesh.rest)};
  if (one.half_steps.stopped.empty()) own.time = position_difference(one.scene, one.half_steps, mass);
  if (one.other_mesh.stopped.empty())
    own.mesh = one.coarser ? error_from_coarser(one.scene, mesh, one.other_mesh, one.coarser->scene.mesh)
                           : position_difference(one.scene, one.other_mesh, mass);
  return own;
}

/// Positions of all frames of all runs are half a gigabyte of a large case.
void forget_positions(Ablation& one) {
  for (RunObserved* run : {&one.scene, &one.half_steps, &one.other_mesh}) run->x = {};
  for (PartJudged& part : one.judged) part.run.x = {};
}

void judge(Ablation& one) {
  const PerParticle mass = lumped_masses(one.shown.scene.mesh, one.shown.scene.density);
  one.own = own_error(one, mass);
  for (size_t k = 0; k < one.parts.size(); ++k) {
    one.judged.push_back(judged(one.parts[k], one.scene, std::move(one.toggled[k]), one.own, mass));
    one.judged.back().declared = declared_for(one.shown, one.parts[k].name);
  }
  forget_positions(one);
}

/// Why nothing can be said of the scene's parts: its own run is not what its author wants; "" if it is.
std::string wrong_by_itself(const Ablation& one) {
  if (!one.scene.stopped.empty()) return "the scene itself does not come to its end: " + one.scene.stopped;
  if (one.scene.failed.empty()) return "";
  return fmt::format("expectations of the scene itself fail: {}", fmt::join(one.scene.failed, ", "));
}

nlohmann::json told(const RunObserved& run) {
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
          {"failed", run.failed}};
}

nlohmann::json told(const Ablation& one, const std::vector<std::string>& overrides) {
  nlohmann::json parts = nlohmann::json::array();
  for (const PartJudged& part : one.judged)
    parts.push_back({{"name", part.name},
                     {"present", part.is_present},
                     {"need", std::string(name_of(part.need))},
                     {"because", part.because},
                     {"declared", part.declared},
                     {"as_it_should_be", part.is_as_it_should_be()},
                     {"position_difference", part.position_difference},
                     {"energy_difference", part.energy_difference},
                     {"run", told(part.run)}});
  return {{"case", one.shown.scene.name},
          {"overrides", overrides},
          {"asked_end", asked_end(one.shown)},
          {"end", one.shown.scene.schedule.end},
          {"wrong", wrong_by_itself(one)},
          {"size", extent_of(one.shown.scene.mesh.rest)},
          {"own_error",
           {{"time", one.own.time},
            {"mesh", one.own.mesh},
            {"floor", one.own.floor},
            {"value", one.own.value()},
            {"without_time", one.half_steps.stopped},
            {"without_mesh", one.other_mesh.stopped},
            {"coarser_mesh", one.shown.coarser_mesh}}},
          {"run", told(one.scene)},
          {"parts", std::move(parts)}};
}

/// All cases whose runs are over.
nlohmann::json told(const std::vector<Ablation>& all, const Options& options) {
  const Provenance p = provenance(options.command);
  nlohmann::json cases = nlohmann::json::array();
  for (const Ablation& one : all)
    if (one.runs_left == 0) cases.push_back(told(one, options.overrides));
  return {{"schema", 1},
          {"program",
           {{"version", p.version},
            {"commit", p.commit},
            {"tree", p.tree},
            {"identity", program_identity()},
            {"cpu", p.cpu},
            {"date", p.date},
            {"command", p.command}}},
          {"cases", std::move(cases)}};
}

/// What was found, and after it what the file says of other cases, if the same program wrote it.
nlohmann::json with_others_of(const std::string& path, nlohmann::json found) {
  if (!std::filesystem::is_regular_file(path)) return found;
  try {
    std::ifstream file(path);
    const nlohmann::json before = nlohmann::json::parse(file);
    if (before.at("program").at("identity") != found["program"]["identity"]) return found;
    std::set<std::string> asked;
    for (const nlohmann::json& row : found["cases"]) asked.insert(row["case"]);
    for (const nlohmann::json& row : before.at("cases"))
      if (!asked.count(row.at("case"))) found["cases"].push_back(row);
  } catch (const nlohmann::json::exception&) {  // no file of ours: it is replaced
  }
  return found;
}

std::string error_text(double error, const std::string& why_unknown) {
  return std::isnan(error) ? "not known: " + why_unknown : fmt::format("{:.2g}", error);
}

void print(const Ablation& one) {
  const double whole = one.shown.scene.schedule.end, asked = asked_end(one.shown);
  const std::string first = asked < whole ? fmt::format(" (its first {:g} s of {:g})", asked, whole) : "";
  fmt::print("{}{}: {:.2f} s; own error {:.2g} m (half the step {}; {} {})\n", one.shown.scene.name, first,
             one.scene.seconds, one.own.value(), error_text(one.own.time, one.half_steps.stopped),
             one.coarser ? fmt::format("from a coarser mesh, {},", fmt::join(one.shown.coarser_mesh, ", "))
                         : "finer mesh",
             error_text(one.own.mesh, one.other_mesh.stopped));
  if (const std::string wrong = wrong_by_itself(one); !wrong.empty()) fmt::print("! {}\n", wrong);
  for (const PartJudged& part : one.judged) {
    fmt::print("{} {:<16} {:<30} {:5.0f} % of the time; {}\n", part.is_as_it_should_be() ? ' ' : '!',
               name_of(part.need), (part.is_present ? "" : "with ") + part.name,
               100 * part.run.seconds / one.scene.seconds, part.because);
    if (!part.declared.empty()) fmt::print("{:>20} {}\n", "declared:", part.declared);
  }
}

std::vector<Ablation> asked_of(const Options& options) {
  std::vector<Ablation> all;
  const LevelSetMakers level_sets = remembering(makers_of(options.cache));
  std::vector<std::string> files = options.names;
  if (files.empty())
    for (const std::string& name : built_in_cases(tier_of(options)))
      files.push_back(shipped_case_file(name));
  for (const std::string& file : files) all.push_back(planned(case_file(file), options, level_sets));
  return all;
}

/// Writes what is found so far: a run of hours that is cut off leaves the cases that it was through with.
void write(const std::vector<Ablation>& all, const Options& options) {
  const std::string path = options.out + "/ablation.json";
  write_text(path, json_text(with_others_of(path, told(all, options))) + "\n");
}

}  // namespace

int ablate(const Options& options) {
  std::vector<Ablation> all = asked_of(options);
  const OutFolder folder(options.out);
  refuse_unless_replaceable(options.out + "/ablation.json");
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
  run_jobs(jobs_of(all, after), "scenes with and without their parts", options.running, run);
  write(all, options);
  bool is_minimal = run.records.empty();  // which tell of runs that could not be judged
  for (const Ablation& one : all) {
    is_minimal &= wrong_by_itself(one).empty();
    for (const PartJudged& part : one.judged) is_minimal &= part.is_as_it_should_be();
  }
  if (options.json) fmt::print("{}\n", json_text(told(all, options)));
  for (const Ablation& one : all)
    if (!options.json && one.runs_left == 0) print(one);
  return is_minimal ? all_hold : some_fail;
}

}  // namespace foldproof
