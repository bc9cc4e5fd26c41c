// foldproof simulate: runs a case, and loses nothing of it when it is interrupted.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "scripts/program/command_line/options_of_commands.h"
#include "reference/scene/field_recipe.h"
#include "reference/scene/scene_sizes.h"
#include "scripts/program/command_line/input_files.h"
#include "scripts/program/interruption.h"
#include "scripts/program/json_text.h"
#include "scripts/program/command_line/out_folder.h"
#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"
#include "scripts/program/run_all.h"
#include "scripts/program/run_case.h"
#include "scripts/program/command_line/typed_words.h"
#include "scripts/program/listing.h"

namespace foldproof {

namespace {

// A thread with fewer costs more in waking up and waiting than it saves.
constexpr Eigen::Index least_particles_per_thread = 1000;

std::string reached_text(const KeptRun& kept) {
  return fmt::format("frame {}, t = {:.6g} s", kept.frame, kept.time);
}

/// An interrupted run may be hours of work: only --restart deletes it.
void refuse_to_lose(const KeptRun& kept, const Scene& scene, const Options& options) {
  const std::string folder = checkpoint_path(scene, options.out);
  const char* const over = "start over with --restart, which deletes it";
  if (kept.frame < 0)
    throw InputError(
        fmt::format("{}: holds an interrupted run that cannot be read; {}", folder, over));
  if (!kept.differs.empty())
    throw InputError(
        fmt::format("{}: holds an interrupted run ({}) of {}; choose another --out, or {}", folder,
                    reached_text(kept), kept.differs, over));
  throw InputError(fmt::format(
      "{}: holds this run, interrupted at {} of {:.6g} s; resume it with `{}`, or {}", folder,
      reached_text(kept), scene.schedule.end, with_option(options.words, "--resume"), over));
}

void say_how_to_resume(const Scene& scene, const Options& options) {
  const std::optional<KeptRun> kept = checkpoint_folder(scene, options.out).kept_run();
  if (!kept || kept->frame < 0)
    log_line("interrupted before the first frame: there is nothing to resume");
  else
    log_line(fmt::format("interrupted at {} of {:.6g} s; resume with: {}", reached_text(*kept),
                         scene.schedule.end, with_option(options.words, "--resume")));
}

nlohmann::json to_json(const CaseRun& run, const Options& options) {
  const Work& work = run.result.work;
  nlohmann::json json = {{"case", run.record.name},
                         {"file", options.out + "/" + run.record.file},
                         {"stopped", run.record.stopped},
                         {"steps", run.result.steps},
                         {"time", run.result.last.time},
                         {"seconds", run.record.seconds},
                         {"cg_iterations", work.cg_iterations},
                         {"solves", work.solves},
                         {"elastic_evaluations", work.elastic_evaluations},
                         {"unfinished_solves", work.unfinished_solves},
                         {"findings", nlohmann::json::array()},
                         {"quantities", nlohmann::json::array()}};
  for (const Record& record : run.findings) {
    const Verdict& v = record.finding.verdict;
    json["findings"].push_back({{"name", record.name},
                                {"outcome", outcome_text(record)},
                                {"measured", v.measured},
                                {"bound", v.bound},
                                {"unit", v.unit},
                                {"note", record.finding.note}});
  }
  for (const MeasuredQuantity& quantity : run.quantities)
    json["quantities"].push_back(
        {{"name", quantity.name}, {"value", quantity.value}, {"unit", quantity.unit}});
  return json;
}

/// Returns the exit code.
int report(const CaseRun& run, const Options& options) {
  const Work& work = run.result.work;
  RunRecord expected;
  expected.records = run.findings;
  if (options.json)
    fmt::print("{}\n", json_text(to_json(run, options)));
  else
    fmt::print("{}{}/{}: t = {:.6g} s in {} steps{}, {:.1f} s\n", listing(expected), options.out,
               run.record.file, run.result.last.time, run.result.steps,
               work.cg_iterations > 0
                   ? fmt::format(", {:.2f} CG iterations a solve",
                                 double(work.cg_iterations) / double(work.solves))
                   : "",
               run.record.seconds);
  if (work.unfinished_solves > 0)
    log_line(fmt::format("warning: {} of {} solves hit the cap on iterations",
                         work.unfinished_solves, work.solves));
  if (!run.record.stopped.empty()) log_line("stopped: " + run.record.stopped);
  return run.record.stopped.empty() ? exit_code(expected) : some_fail;
}

/// As typed, or else one a core, but no more than pay.
int threads_of_run(const Scene& scene, const Options& options) {
  const int all = threads_of(options.running);
  if (options.running.threads > 0) return all;
  return int(std::clamp<Eigen::Index>(scene.x.cols() / least_particles_per_thread, 1, all));
}

/// Level sets may take a minute.
BuiltCase built_with_notice(Case input_case, const Options& options) {
  const InterruptionNotice notice("no step is made yet", typed_again(options.words));
  BuiltCase of =
      built_case(std::move(input_case), provider_for(options.cache, threads_of(options.running)));
  set_team(of.built.system, threads_of_run(of.input_case.scene, options));
  return of;
}

CaseRun run_of(const BuiltCase& of, const Options& options) {
  const InterruptionWatch watch;
  ProgressLine line("simulate " + of.input_case.scene.name);
  return run_case_with_checkpoints(of, options.out,
                                   options.resumes ? Start::last_checkpoint : Start::fresh,
                                   provenance(options.command), [&](double part) {
                                     line.show(part);
                                     watch.check();
                                   });
}

void warn_of_step(const Scene& scene, const System& system, const State& s) {
  if (const std::string text = warning_of_step(scene, system, s); !text.empty())
    log_line("warning: " + text);
}

int simulate_case(const Options& options) {
  Case input_case = read_case(case_file(options.file), options.overrides);
  const bool may_delete = options.resumes || options.restarts;
  const std::optional<KeptRun> kept = checkpoint_folder(input_case.scene, options.out).kept_run();
  if (kept && !may_delete) refuse_to_lose(*kept, input_case.scene, options);
  const OutFolder folder(options.out);
  const BuiltCase of = built_with_notice(std::move(input_case), options);
  const Scene& scene = of.input_case.scene;
  log_warnings(scene);
  if (const std::string text = warning_of_start(scene, of.built.start); !text.empty())
    log_line("warning: " + text);
  warn_of_step(scene, of.built.system, of.built.start);
  log_line(fmt::format("{}: {}", scene.name, sizes_in_words(scene)));
  log_line(
      fmt::format("{}: {}", scene.name, fmt::join(describe_parts(scene, of.built.system), "; ")));
  for (std::size_t k = 0; k < scene.objects.size(); ++k) {
    if (!scene.objects[k].field) continue;
    const FieldRecipe& field = *scene.objects[k].field;
    const std::string& name = scene.objects[k].object.name;
    if (const auto text = accuracy_report(field, of.built.objects[k].body); !text.empty())
      log_line(fmt::format("object '{}': {}", name, text));
    if (const auto text = lost_parts_report(field, of.built.objects[k].body); !text.empty())
      log_line(fmt::format("warning: object '{}': {}", name, text));
  }
  try {
    const CaseRun run = run_of(of, options);
    const int code = report(run, options);
    if (!run.record.stopped.empty()) warn_of_step(scene, of.built.system, run.result.last);
    return code;
  } catch (const Interrupted& interrupted) {
    say_how_to_resume(scene, options);
    end_by(interrupted);
  }
}

constexpr const char* below_simulate =
    R"(A checkpoint is written at every frame and removed at the end. An interrupted run prints how to
resume it. The same command without --resume or --restart then stops, and deletes nothing.

Examples:
  foldproof simulate hanging_sheet --set bending.stiffness=1e-3 --out mine
  foldproof simulate any_mesh --set cloth.mesh=cases/skirt.obj --out mine

Exit codes:
  0    the run reached its end time, and every expectation of the case holds
  1    an expectation fails, or the run stopped early and prints why
  2    bad input, checkpoints of an interrupted run, or a file that cannot be written
  130  interrupted by Ctrl-C (143: by SIGTERM))";

}  // namespace

void add_simulate_command(CLI::App& app, Program& program) {
  auto [simulate, options] = add_command(
      app, program, {"simulate", "Simulate a case; writes NAME.h5 and NAME.xdmf", below_simulate},
      simulate_case);
  add_input(simulate, "CASE", options.file, case_words);
  add_overrides(simulate, options);
  CLI::Option* resume = add_switch(
      simulate, "--resume", options.resumes,
      "Resume from the last checkpoint of an interrupted run; the results are the same to the bit");
  add_switch(simulate, "--restart", options.restarts,
             "Start over; deletes checkpoints of an interrupted run")
      ->excludes(resume);
  add_threads(simulate, options,
              "Threads of the run; the results are the same to the bit (default: one a core, fewer "
              "in small scenes)");
  add_cache(simulate, options);
  add_folder(simulate, options, "Folder for results")->capture_default_str();
  add_json(simulate, options);
}

}  // namespace foldproof
