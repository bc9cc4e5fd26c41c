#include "scripts/program/run_case.h"

#include <chrono>
#include <filesystem>

#include "reference/level_set/makers.h"
#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"
#include "verification/cases/judge.h"
#include "verification/kept_level_sets_file.h"
#include "verification/trajectory_file.h"

namespace foldproof {

namespace {

/// Runs the case; `also` watches beside the judge.
std::vector<Record> judged_run(const Case& shown, const Observer& also, const Progress& progress,
                               Outcome& outcome) {
  const Scene& scene = shown.scene;
  CaseJudge judge(shown);
  const Observer observer{[&](const State& s) {
                            judge.enter(s);
                            if (also.frame) also.frame(s);
                          },
                          [&](const Diagnostics& row) {
                            judge.enter(row);
                            if (also.step) also.step(row);
                            progress(row.time / scene.schedule.end);
                          }};
  outcome = simulate(build_system(scene), integrator_named(scene.integrator), start_state(scene),
                     scene.schedule, observer);
  return judge.judged(outcome);
}

}  // namespace

CaseRun run_case(const Case& shown, const std::string& folder, const Provenance& provenance,
                 const Progress& progress) {
  const Scene& scene = shown.scene;
  const std::string file = scene.name + ".h5";
  TrajectoryFile trajectory((std::filesystem::path(folder) / file).string(), scene, build_system(scene),
                            provenance);
  const auto start = std::chrono::steady_clock::now();
  CaseRun run;
  run.findings = judged_run(shown,
                            {[&](const State& s) { trajectory.add_frame(s); },
                             [&](const Diagnostics& row) { trajectory.add_diagnostics(row); }},
                            progress, run.outcome);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  run.record = {scene.name,  file,    scene.title,
                scene.about, seconds, run.outcome.stop ? described(*run.outcome.stop) : ""};
  trajectory.finish(run.record.stopped, run.record.seconds);
  return run;
}

std::vector<Record> judge_case(const Case& shown, const Progress& progress) {
  Outcome outcome;
  return judged_run(shown, {}, progress, outcome);
}

std::vector<std::string> shown_cases() {
  return {"hinge",        "hanging_sheet", "flag_drop",       "rest_fold",      "stiff_statue",
          "drape_sphere", "drape_statue",  "spinning_sphere", "incline",        "incline_slides",
          "pinch",        "armpit",        "half_inside",     "stretched_body", "deforming_body",
          "hard/fast",    "grab"};
}

std::vector<std::string> hard_cases() {
  return {
      "hard/stiff_bending", "hard/soft_bending",      "hard/heavy_damping",     "hard/slivers",
      "hard/graded_mesh",   "hard/sharp_fold",        "hard/inextensible",      "hard/flat_hanging",
      "hard/flat_standing", "hard/strip_below_euler", "hard/strip_above_euler", "hard/hundred_thousand_steps",
      "hard/reef_fold",     "hard/sticky_layers",     "hard/biphasic_pull",     "hard/buckle"};
}

std::vector<std::string> long_cases() {
  return {"hard/fold_stack", "hard/twist", "hard/funnel", "hard/pile", "hard/pinch_self"};
}

std::vector<std::string> built_in_cases() {
  std::vector<std::string> all = shown_cases();
  for (const std::string& name : long_cases()) all.push_back(name);
  for (const std::string& name : hard_cases()) all.push_back(name);
  return all;
}

Case built_in_case(const std::string& name) { return built_in_case(name, computing_makers()); }

Case built_in_case(const std::string& name, const LevelSetMakers& makers) {
  return with_usual_expectations(case_of_file(project_folder() + "/cases/" + name + ".toml", {}, makers));
}

LevelSetMakers makers_of(const std::string& cache) {
  return cache.empty() ? computing_makers() : caching_makers(cache, say);
}

}  // namespace foldproof
