// foldproof ablate: runs a case without each of its parts, and with those that it lacks and that need no numbers
// from its author, and says which it needs.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "convergence/ablation.h"
#include "convergence/finer_scene.h"
#include "reference/level_set/makers.h"
#include "scripts/program/commands.h"
#include "scripts/program/json_text.h"
#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"
#include "scripts/program/run_case.h"
#include "verification/whole_file.h"

namespace foldproof {

namespace {

/// A case and all runs that are asked of it.
struct Ablation {
  Case shown;
  std::vector<ScenePart> parts;
  RunObserved scene, half_steps, finer;
  std::vector<RunObserved> toggled;  // one a part
  OwnError own;
  std::vector<PartJudged> judged;
};

Ablation planned(Case shown) {
  Ablation plan{std::move(shown), {}, {}, {}, {}, {}, {}, {}};
  plan.parts = parts_of(plan.shown.scene);
  refuse_unknown_parts(plan.shown, plan.parts);
  plan.toggled.resize(plan.parts.size());
  plan.finer.stopped = declared_for(plan.shown, finer_mesh);
  return plan;
}

/// A run that a job makes and leaves in `into`.
Job job_of(const std::string& name, double length, const Case& shown,
           std::function<Scene(const Scene&)> change, RunObserved& into) {
  return {name, length, [&shown, change = std::move(change), &into](const Progress&) {
            const int particles = shown.scene.mesh.particles();
            try {
              into = observed(with_scene(shown, change(shown.scene)), particles);
            } catch (const InputError& error) {
              into.stopped = error.what();
            }
            return RunRecord{};
          }};
}

/// Finer meshes take some ten times as long: four times the particles, and smaller steps.
std::vector<Job> jobs_of(std::vector<Ablation>& all) {
  std::vector<Job> jobs;
  for (Ablation& one : all) {
    const std::string& name = one.shown.scene.name;
    jobs.push_back(job_of(
        name, 1, one.shown, [](const Scene& s) { return s; }, one.scene));
    jobs.push_back(job_of(name, 2, one.shown, with_half_steps, one.half_steps));
    if (one.finer.stopped.empty()) jobs.push_back(job_of(name, 10, one.shown, with_finer_mesh, one.finer));
    for (size_t k = 0; k < one.parts.size(); ++k)
      jobs.push_back(job_of(name, 1.1, one.shown, one.parts[k].toggled, one.toggled[k]));
  }
  return jobs;
}

double size_of(const PerParticle3& x) { return (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).maxCoeff(); }

void judge(Ablation& one) {
  const PerParticle mass = lumped_masses(one.shown.scene.mesh, one.shown.scene.density);
  const auto error_of = [&](const RunObserved& run) {
    return run.stopped.empty() ? position_difference(one.scene, run, mass) : nan;
  };
  one.own = {error_of(one.half_steps), error_of(one.finer), 1e-6 * size_of(one.shown.scene.mesh.rest)};
  for (size_t k = 0; k < one.parts.size(); ++k) {
    one.judged.push_back(judged(one.parts[k], one.scene, std::move(one.toggled[k]), one.own, mass));
    one.judged.back().declared = declared_for(one.shown, one.parts[k].name);
  }
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

nlohmann::json told(const Ablation& one) {
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
          {"wrong", wrong_by_itself(one)},
          {"size", size_of(one.shown.scene.mesh.rest)},
          {"own_error",
           {{"time", one.own.time},
            {"mesh", one.own.mesh},
            {"floor", one.own.floor},
            {"value", one.own.value()},
            {"without_time", one.half_steps.stopped},
            {"without_mesh", one.finer.stopped}}},
          {"run", told(one.scene)},
          {"parts", std::move(parts)}};
}

nlohmann::json told(const std::vector<Ablation>& all, const Options& options) {
  const Provenance p = provenance(options.command);
  nlohmann::json cases = nlohmann::json::array();
  for (const Ablation& one : all) cases.push_back(told(one));
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
  fmt::print("{}: {:.2f} s; own error {:.2g} m (half the step {}; finer mesh {})\n", one.shown.scene.name,
             one.scene.seconds, one.own.value(), error_text(one.own.time, one.half_steps.stopped),
             error_text(one.own.mesh, one.finer.stopped));
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
  const LevelSetMakers makers = makers_of(options.cache);
  std::vector<std::string> files = options.names;
  if (files.empty())
    for (const auto& names : {shown_cases(tier_of(options)), hard_cases()})
      for (const std::string& name : names) files.push_back(project_folder() + "/cases/" + name + ".toml");
  for (const std::string& file : files) all.push_back(planned(case_of_file(file, options.overrides, makers)));
  return all;
}

}  // namespace

int ablate(const Options& options) {
  std::vector<Ablation> all = asked_of(options);
  RunRecord run;
  run_jobs(jobs_of(all), "scenes with and without their parts", options.running, run);
  bool is_minimal = true;
  for (Ablation& one : all) {
    judge(one);
    is_minimal &= wrong_by_itself(one).empty();
    for (const PartJudged& part : one.judged) is_minimal &= part.is_as_it_should_be();
  }
  const nlohmann::json found = told(all, options);
  if (!options.out.empty()) {
    make_folder(options.out);
    const std::string path = options.out + "/ablation.json";
    write_text(path, json_text(with_others_of(path, found)) + "\n");
  }
  if (options.json) fmt::print("{}\n", json_text(found));
  for (const Ablation& one : all)
    if (!options.json) print(one);
  return is_minimal ? all_hold : some_fail;
}

}  // namespace foldproof
