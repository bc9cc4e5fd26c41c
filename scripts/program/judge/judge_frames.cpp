// foldproof judge --frames: frames that any program wrote, without an adapter.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "scripts/program/command_line/input_files.h"
#include "scripts/program/command_line/out_folder.h"
#include "scripts/program/frame_files.h"
#include "scripts/program/judge/judge_frames.h"
#include "scripts/program/provenance.h"
#include "scripts/program/run_case.h"
#include "scripts/program/judge/trial_output.h"
#include "verification/cases/frames_of_case.h"
#include "verification/cases/judged_frames.h"

namespace foldproof {

namespace {

/// One folder of frames, and the case that they show.
struct ReadMotion {
  Case of;
  std::vector<TimedMesh> frames;
  std::string seams;  // as CaseFrames::seams
};

ReadMotion read_motion(const Options& options) {
  if (options.file.empty())
    throw InputError("--frames needs --case CASE: a case file, or a shipped case");
  Case of = with_usual_expectations(read_case(case_file(options.file), options.overrides));
  CaseFrames read = frames_of_case(
      of.scene, read_frames(options.frames, {options.times, options.rate, options.first_time},
                            of.scene.name));
  if (matching_of(of.scene.mesh, read.frames) == Matching::points)
    throw InputError(mesh_difference(of.scene.mesh, read.frames) +
                     "; give as many points as the cloth has, or faces");
  return {std::move(of), std::move(read.frames), std::move(read.seams)};
}

std::string span_text(const std::vector<TimedMesh>& frames) {
  return fmt::format("{} from t = {:.6g} s to {:.6g} s", frames.size(), frames.front().time,
                     frames.back().time);
}

std::string subject_name(const Options& options) {
  return options.name.empty() ? "frames of " + options.frames : options.name;
}

std::string vertices_text(const ReadMotion& motion, Matching matching) {
  const std::string difference = mesh_difference(motion.of.scene.mesh, motion.frames);
  return fmt::format("compared {}{}{}{}{}", name_of(matching), difference.empty() ? "" : ": ",
                     difference, motion.seams.empty() ? "" : "; ", motion.seams);
}

/// The keys of a judged solver's file: frames are of level 0, and say nothing of their solver.
std::string facts_of(const ReadMotion& motion, Matching matching, const Options& options) {
  const nlohmann::json facts = {{"schema", 1},
                                {"name", subject_name(options)},
                                {"version", ""},
                                {"level", "L0"},
                                {"precision", "files"},
                                {"scheme", "frames without a solver"},
                                {"order", 0},
                                {"capabilities", nlohmann::json::array()},
                                {"solve_tolerance", 0},
                                {"command", "none: frames of " + options.frames},
                                {"settings", nlohmann::json::object()},
                                {"calibration", nlohmann::json::array()},
                                {"mapping",
                                 {{"case", motion.of.scene.name},
                                  {"frames", span_text(motion.frames)},
                                  {"vertices", vertices_text(motion, matching)}}}};
  return facts.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

RunRecord run_of(const ReadMotion& motion, FramesJudgement judged, const Options& options) {
  RunRecord run;
  run.provenance = provenance(options.command);
  run.tier = options.tier;
  run.subject = subject_name(options);
  run.records = std::move(judged.records);
  run.studies.push_back({"frames." + motion.of.scene.name,
                         "What do the frames show?",
                         options.frames,
                         span_text(motion.frames) + ".",
                         0,
                         std::move(judged.evidence.figures),
                         {},
                         std::move(judged.evidence.tables)});
  return run;
}

std::string heading(const ReadMotion& motion, Matching matching, const Options& options) {
  const std::string difference = mesh_difference(motion.of.scene.mesh, motion.frames);
  return fmt::format("{}: {}, of case {}, {}\n{}{}{}", options.frames, span_text(motion.frames),
                     motion.of.scene.name, name_of(matching), motion.seams,
                     motion.seams.empty() ? "" : "\n",
                     difference.empty() ? "" : difference + ": judged as another mesh\n");
}

bool starts_as_the_case(const FramesJudgement& judged) {
  return judged.records.front().outcome != Outcome::fails;
}

constexpr const char* other_start =
    "The first frame is not the start of the case: suspect units, axes, the order of vertices or "
    "the times before the solver.\n";

}  // namespace

int judge_frames_of_a_case(const Options& options) {
  const auto baseline = baseline_of(options);
  const OutFolder folder(options.out);
  const ReadMotion motion = read_motion(options);
  const FramesJudgement judged = judge_frames(
      motion.of, build(motion.of.scene, provider_for(options.cache, threads_of(options.running))),
      motion.frames);
  return finish_trial(
      {run_of(motion, judged, options), facts_of(motion, judged.matching, options),
       heading(motion, judged.matching, options), starts_as_the_case(judged) ? "" : other_start},
      baseline, options);
}

}  // namespace foldproof
