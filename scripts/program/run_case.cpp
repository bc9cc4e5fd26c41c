#include "scripts/program/run_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>

#include "scripts/program/data_folder.h"
#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"
#include "verification/cases/judge.h"
#include "verification/files/level_set_folder.h"
#include "verification/files/trajectory_file.h"

namespace foldproof {

namespace {

/// All that watch one run, in the order in which they are told.
using Observers = std::vector<Observer>;

Observer all_of(Observers list) {
  return {[list](const State& s) {
            for (const Observer& one : list)
              if (one.frame) one.frame(s);
          },
          [list](const Diagnostics& row) {
            for (const Observer& one : list)
              if (one.step) one.step(row);
          },
          [list](const Checkpoint& now) {
            for (const Observer& one : list)
              if (one.checkpoint) one.checkpoint(now);
          }};
}

/// Makes a run happen before observers.
using Runner = std::function<RunResult(const Observers&)>;

Runner from_the_start(const BuiltCase& of) {
  return [&of](const Observers& observers) {
    const Scene& scene = of.input_case.scene;
    return simulate(of.built.system, integrator_named(scene.integrator), of.built.start,
                    scene.schedule, all_of(observers));
  };
}

/// Replays all callbacks up to the last checkpoint, then continues the run, with a checkpoint
/// at every frame.
Runner from_checkpoints(const BuiltCase& of, const CheckpointFolder& checkpoints, Start start) {
  return [&of, &checkpoints, start](Observers observers) {
    std::optional<Checkpoint> last;
    const Observer before = all_of(observers);
    const auto replay = [&](const CheckpointRecord& record) {
      for (const Diagnostics& row : record.rows) before.step(row);
      before.frame(record.at.past.back());
      before.checkpoint(record.at);
    };
    if (start == Start::fresh)
      checkpoints.remove_from(0);
    else
      last = checkpoints.replay(replay, log_line);
    if (start == Start::last_checkpoint)
      log_line(last ? fmt::format("resumed from frame {}, t = {:.6g} s, after {} steps",
                                  last->frame, last->past.back().time, last->steps)
                    : "there is no checkpoint to resume from: started anew");
    std::vector<Diagnostics> rows;  // since the latest checkpoint
    observers.push_back(Observer{{},
                                 [&](const Diagnostics& row) { rows.push_back(row); },
                                 [&](const Checkpoint& now) {
                                   checkpoints.write({now, rows});
                                   rows.clear();
                                 }});
    if (!last) return from_the_start(of)(observers);
    const Scene& scene = of.input_case.scene;
    return resume(of.built.system, integrator_named(scene.integrator), *last, scene.schedule,
                  all_of(observers));
  };
}

/// Runs the case before its judge and the others.
std::vector<Record> judged_run(const BuiltCase& of, const Runner& run, Observers others,
                               const Progress& progress, RunResult& result) {
  CaseJudge judge(of.input_case, of.built.objects, of.level_sets);
  const Observer judging{[&](const State& s) { judge.record(s); },
                         [&](const Diagnostics& row) { judge.record(row); },
                         [&](const Checkpoint& now) { judge.record(now); }};
  others.insert(others.begin(), judging);
  const double end = of.input_case.scene.schedule.end;
  others.push_back(Observer{{}, [&](const Diagnostics& row) { progress(row.time / end); }});
  result = run(others);
  return judge.records(result);
}

/// Runs the case, judges it and measures its quantities.
CaseRun measured_run(const BuiltCase& of, const Runner& run, Observers others,
                     const Progress& progress) {
  const Scene& scene = of.input_case.scene;
  const std::vector<Measurement> measurements =
      of.input_case.quantities.empty() ? usual_measurements(scene, {}) : of.input_case.quantities;
  Measurer measurer(scene, of.built, measurements);
  others.push_back(Observer{[&](const State& s) { measurer.record(s); },
                            [&](const Diagnostics& row) { measurer.record(row); }});
  const auto start = std::chrono::steady_clock::now();
  CaseRun done;
  done.findings = judged_run(of, run, others, progress, done.result);
  const std::vector<double> values = measurer.values(done.result);
  for (size_t k = 0; k < values.size(); ++k)
    done.quantities.push_back({measurements[k].name, values[k], unit_of(measurements[k])});
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  done.record = {scene.name,  "",      scene.title,
                 scene.about, seconds, done.result.stop ? describe(*done.result.stop) : ""};
  return done;
}

CaseRun recorded_run(const BuiltCase& of, const Runner& run, TrajectoryFile& trajectory,
                     const Progress& progress) {
  const Observer writing{[&](const State& s) { trajectory.add_frame(s); },
                         [&](const Diagnostics& row) { trajectory.add_diagnostics(row); }};
  CaseRun done = measured_run(of, run, {writing}, progress);
  done.record.file = done.record.name + ".h5";
  trajectory.finish(done.record.stopped, done.record.seconds, done.findings);
  return done;
}

TrajectoryFile trajectory_file(const BuiltCase& of, const std::string& folder,
                               const Provenance& provenance) {
  const Scene& scene = of.input_case.scene;
  const std::string path = (std::filesystem::path(folder) / (scene.name + ".h5")).string();
  return TrajectoryFile(path, scene, of.built.system, of.built.objects, provenance);
}

}  // namespace

BuiltCase built_case(Case input_case, const LevelSetProvider& level_sets) {
  const LevelSetProvider kept = memoizing_provider(level_sets);
  BuiltScene built = build(input_case.scene, kept);
  return {std::move(input_case), kept, std::move(built)};
}

void log_warnings(const Scene& scene) {
  for (const std::string& note : scene.notes) log_line(note);
  for (const std::string& warning : scene.warnings) log_line("warning: " + warning);
}

CaseRun run_case(const BuiltCase& of, const std::string& folder, const Provenance& provenance,
                 const Progress& progress) {
  TrajectoryFile trajectory = trajectory_file(of, folder, provenance);
  return recorded_run(of, from_the_start(of), trajectory, progress);
}

std::string checkpoint_path(const Scene& scene, const std::string& folder) {
  return (std::filesystem::path(folder) / (scene.name + ".checkpoints")).string();
}

CheckpointFolder checkpoint_folder(const Scene& scene, const std::string& folder) {
  return {checkpoint_path(scene, folder), identity_of(scene, program_identity())};
}

CaseRun run_case_with_checkpoints(const BuiltCase& of, const std::string& folder, Start start,
                                  const Provenance& provenance, const Progress& progress) {
  const CheckpointFolder checkpoints = checkpoint_folder(of.input_case.scene, folder);
  TrajectoryFile trajectory = trajectory_file(of, folder, provenance);
  CaseRun done = recorded_run(of, from_checkpoints(of, checkpoints, start), trajectory, progress);
  checkpoints.remove_from(0);
  return done;
}

CaseRun run_case_without_files(const BuiltCase& of, const Progress& progress) {
  return measured_run(of, from_the_start(of), {}, progress);
}

std::vector<Record> judge_case(const BuiltCase& of, const Progress& progress) {
  RunResult result;
  return judged_run(of, from_the_start(of), {}, progress, result);
}

std::vector<std::string> shown_cases(Tier tier) {
  std::vector<std::string> input_case = {
      "hinge",          "hanging_sheet", "flag_drop",    "rest_fold",       "stiff_statue",
      "any_mesh",       "drape_sphere",  "drape_statue", "spinning_sphere", "incline",
      "incline_slides", "pinch",         "armpit",       "half_inside",     "stretched_body",
      "deforming_body", "hard/fast",     "grab",         "garment"};
  if (tier == Tier::full)
    for (const std::string& name : long_cases()) input_case.push_back(name);
  return input_case;
}

std::vector<std::string> hard_cases() {
  return {"hard/stiff_bending",     "hard/soft_bending",
          "hard/heavy_damping",     "hard/slivers",
          "hard/graded_mesh",       "hard/sharp_fold",
          "hard/inextensible",      "hard/flat_hanging",
          "hard/flat_standing",     "hard/strip_below_euler",
          "hard/strip_above_euler", "hard/hundred_thousand_steps",
          "hard/reef_fold",         "hard/sticky_layers",
          "hard/biphasic_pull",     "hard/buckle"};
}

std::vector<std::string> long_cases() {
  return {"hard/fold_stack", "hard/twist", "hard/funnel", "hard/pile",    "hard/pinch_self",
          "sleeve",          "robe",       "tunic",       "water_bottle", "balloon"};
}

std::vector<std::string> built_in_cases(Tier tier) {
  std::vector<std::string> all = shown_cases(tier);
  for (const std::string& name : hard_cases()) all.push_back(name);
  return all;
}

std::vector<std::string> shipped_cases() {
  std::vector<std::string> all = built_in_cases(Tier::full);
  all.push_back("cantilever");  // for `settle`
  return all;
}

std::string shipped_case_file(const std::string& name) {
  return data_folder() + "/cases/" + name + ".toml";
}

Case built_in_case(const std::string& name) {
  return with_usual_expectations(read_case(shipped_case_file(name)));
}

LevelSetProvider provider_for(const std::string& cache, int threads) {
  return cache.empty() ? computing_provider(threads) : caching_provider(cache, log_line, threads);
}

}  // namespace foldproof
