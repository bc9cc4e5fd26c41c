// foldproof simulate: runs a case, and loses nothing of it when it is interrupted.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "reference/scene/field_recipe.h"
#include "scripts/program/commands.h"
#include "scripts/program/command_line/input_files.h"
#include "scripts/program/interruption.h"
#include "scripts/program/json_text.h"
#include "scripts/program/command_line/out_folder.h"
#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"
#include "scripts/program/run_all.h"
#include "scripts/program/run_case.h"
#include "scripts/program/command_line/typed_command.h"
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
    fmt::print("{}{}/{}: t = {:.6g} s in {} steps, {:.2f} CG iterations a solve, {:.1f} s\n",
               listing(expected), options.out, run.record.file, run.result.last.time,
               run.result.steps, double(work.cg_iterations) / double(std::max(1L, work.solves)),
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

}  // namespace

int simulate_case(const Options& options) {
  Case input_case = read_case(case_file(options.file), options.overrides);
  const bool may_delete = options.resumes || options.restarts;
  const std::optional<KeptRun> kept = checkpoint_folder(input_case.scene, options.out).kept_run();
  if (kept && !may_delete) refuse_to_lose(*kept, input_case.scene, options);
  const OutFolder folder(options.out);
  const BuiltCase of = built_with_notice(std::move(input_case), options);
  const Scene& scene = of.input_case.scene;
  log_warnings(scene);
  log_line(
      fmt::format("{}: {}", scene.name, fmt::join(describe_parts(scene, of.built.system), "; ")));
  for (std::size_t k = 0; k < scene.objects.size(); ++k)
    if (const auto& field = scene.objects[k].field)
      if (const std::string text = accuracy_report(*field, of.built.objects[k].body); !text.empty())
        log_line(fmt::format("object '{}': {}", scene.objects[k].object.name, text));
  try {
    return report(run_of(of, options), options);
  } catch (const Interrupted& interrupted) {
    say_how_to_resume(scene, options);
    end_by(interrupted);
  }
}

}  // namespace foldproof
