// foldproof compare: the cloth of a stored run against frames of any other program, or a
// captured cloth.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "scripts/program/command_line/options_of_commands.h"
#include "reference/mesh/seams.h"
#include "scripts/program/command_line/input_files.h"
#include "scripts/program/command_line/out_folder.h"
#include "scripts/program/frame_files.h"
#include "scripts/program/json_text.h"
#include "scripts/program/provenance.h"
#include "scripts/program/run_case.h"
#include "verification/cases/frames_of_case.h"
#include "verification/files/results_file.h"
#include "verification/files/stored_run_file.h"

namespace foldproof {

namespace {

struct CompareOptions : Options {
  double seams = 0;  // distance within which vertices of frames are joined [m]; 0: none
};

struct Comparison {
  std::string name;  // of the run's case
  Matching matching = Matching::particles;
  std::vector<FrameComparison> frames;
  std::size_t left_out = 0;     // frames before the run's first or after its last
  std::string seams = {};       // as CaseFrames::seams
  std::string difference = {};  // of the meshes, in words
};

/// The run's state at t, which lies between its first and its last frame [s].
State state_at(const StoredRun& run, double t) {
  const auto after = std::ranges::upper_bound(run.times, t);
  const std::size_t next = std::min(std::size_t(after - run.times.begin()), run.times.size() - 1);
  return next == 0 ? run.frame(0) : state_between(run.frame(next - 1), run.frame(next), t);
}

/// The frames of another stored run.
std::vector<TimedMesh> frames_of_run(const Options& options) {
  if (options.rate > 0 || !options.times.empty())
    throw InputError(options.frames +
                     ": a stored run knows its times; leave out --rate and --times");
  const StoredFrames run = read_stored_frames(options.frames);
  std::vector<TimedMesh> frames;
  for (std::size_t k = 0; k < run.times.size(); ++k)
    frames.push_back(
        {fmt::format("{} frame {}", options.frames, k), run.times[k], run.frame(k), run.triangles});
  return frames;
}

/// Joins the vertices that are near in the first frame, in all that have its mesh.
void sew(std::vector<TimedMesh>& frames, double distance) {
  const TimedMesh first = frames.front();
  for (TimedMesh& frame : frames) {
    if (frame.triangles.empty()) continue;
    const bool is_same = frame.triangles == first.triangles && frame.x.cols() == first.x.cols();
    std::vector<PerParticle3> motion{is_same ? first.x : frame.x, std::move(frame.x)};
    close_seams_in_motion(motion, frame.triangles, distance, frame.file);
    frame.x = std::move(motion.back());
  }
}

CaseFrames read_other(const CompareOptions& options, const Scene& scene) {
  if (std::filesystem::path(options.frames).extension() == run_kind.ending) {
    require_input(options.frames, run_kind);
    return {frames_of_run(options), ""};
  }
  std::vector<TimedMesh> frames =
      read_frames(options.frames, {options.times, options.rate, options.first_time}, scene.name);
  if (options.seams > 0) sew(frames, options.seams);
  return frames_of_case(scene, std::move(frames));
}

/// Takes out the frames outside of the run; times that round to its ends count.
std::size_t leave_out(const StoredRun& run, std::vector<TimedMesh>& frames) {
  const double close = 1e-9 * (run.times.back() - run.times.front());
  const std::size_t left_out = std::erase_if(frames, [&](const TimedMesh& frame) {
    return frame.time < run.times.front() - close || frame.time > run.times.back() + close;
  });
  if (frames.empty())
    throw InputError(
        fmt::format("no frame lies in the run's time, {:g} to {:g} s; check their times",
                    run.times.front(), run.times.back()));
  return left_out;
}

Comparison compared(const CompareOptions& options) {
  const StoredRun run = read_stored_run(options.file);
  if (run.times.empty()) throw InputError(options.file + ": holds no frame");
  CaseFrames other = read_other(options, run.scene);
  std::vector<TimedMesh>& frames = other.frames;
  Comparison comparison{
      run.scene.name, Matching::particles, {}, leave_out(run, frames), other.seams};
  comparison.matching = matching_of(run.scene.mesh, frames);
  comparison.difference = mesh_difference(run.scene.mesh, frames);
  const BuiltScene built =
      build(run.scene, provider_for(options.cache, threads_of(options.running)));
  for (const TimedMesh& frame : frames) {
    const double t = std::clamp(frame.time, run.times.front(), run.times.back());
    comparison.frames.push_back(
        compare_frame({run.scene, built, comparison.matching}, state_at(run, t), frame));
  }
  return comparison;
}

std::string in_words(const Comparison& c) {
  const auto worst = std::ranges::max_element(
      c.frames, {}, [](const FrameComparison& f) { return f.distance.rms; });
  std::string words = fmt::format(
      "frames compared {1}: {0}; the largest root mean square distance is {2:.3g} m, at t = "
      "{3:.4g} s",
      c.frames.size(), name_of(c.matching), worst->distance.rms, worst->time);
  if (c.left_out > 0)
    words += fmt::format("; {} frame{} outside of the run's time left out", c.left_out,
                         c.left_out == 1 ? "" : "s");
  if (c.matching == Matching::surface)
    words += "; another mesh than the run's, so its energies are not known: " + c.difference;
  if (c.matching == Matching::points)
    words += "; points have no surface, so what of the run they leave out is not measured";
  if (!c.seams.empty()) words += "; " + c.seams;
  return words;
}

void print(const Comparison& c) {
  fmt::print("{:>8} {:>9} {:>9} {:>21} {:>21} {:>11} {:>19}\n", "time", "rms", "largest", "stretch",
             "bending", "crossings", "depth");
  fmt::print("{:>8} {:>9} {:>9} {:>21} {:>21} {:>11} {:>19}\n", "s", "m", "m", "run / frame, J",
             "run / frame, J", "run / frame", "run / frame, m");
  for (const FrameComparison& f : c.frames)
    fmt::print(
        "{:>8.4g} {:>9.3g} {:>9.3g} {:>10.3g} {:>10.3g} {:>10.3g} {:>10.3g} {:>5} {:>5} {:>9.3g} "
        "{:>9.3g}\n",
        f.time, f.distance.rms, f.distance.largest, f.run.stretch, f.frame.stretch, f.run.bending,
        f.frame.bending, f.run.crossings, f.frame.crossings, f.run.depth, f.frame.depth);
  fmt::print("\n{:<20} {:>10} {:>10}   at t = {:.4g} s\n", "folds", "run", "frame",
             c.frames.back().time);
  for (std::size_t b = 0; b < c.frames.back().run.folds.size(); ++b)
    fmt::print("{:<20} {:>10.4f} {:>10.4f}\n", name_of_fold_band(b), c.frames.back().run.folds[b],
               c.frames.back().frame.folds[b]);
  fmt::print("\n{}\n", in_words(c));
}

nlohmann::json to_json(const ClothShape& shape) {
  return {{"stretch", shape.stretch},
          {"bending", shape.bending},
          {"folds", shape.folds},
          {"crossings",
           std::isnan(shape.crossings) ? nlohmann::json() : nlohmann::json(long(shape.crossings))},
          {"depth", shape.depth}};
}

nlohmann::json to_json(const Comparison& c) {
  nlohmann::json told = {{"case", c.name},
                         {"matching", name_of(c.matching)},
                         {"left_out", c.left_out},
                         {"difference", c.difference},
                         {"seams", c.seams},
                         {"fold_bands", nlohmann::json::array()},
                         {"frames", nlohmann::json::array()}};
  for (std::size_t b = 0; b <= fold_band_ends.size(); ++b)
    told["fold_bands"].push_back(name_of_fold_band(b));
  for (const FrameComparison& f : c.frames)
    told["frames"].push_back({{"file", f.file},
                              {"time", f.time},
                              {"rms", f.distance.rms},
                              {"largest", f.distance.largest},
                              {"run", to_json(f.run)},
                              {"frame", to_json(f.frame)}});
  return told;
}

/// run.h5, as a report shows it.
void write_result(const Comparison& c, const Options& options) {
  ComparisonEvidence evidence = evidence_of(c.frames, c.matching);
  StudyRecord study{"compare." + c.name,
                    "How far are the frames from the run?",
                    options.file + " and " + options.frames,
                    in_words(c) + ".",
                    0,
                    std::move(evidence.figures),
                    {},
                    std::move(evidence.tables)};
  RunRecord run;
  run.provenance = provenance(options.command);
  run.tier = options.tier;
  run.subject = "frames";
  run.studies.push_back(std::move(study));
  write_run(options.out + "/run.h5", run);
}

}  // namespace

int compare_frames(const CompareOptions& options) {
  require_input(options.file, run_kind);
  const OutFolder folder(options.out);
  const Comparison comparison = compared(options);
  if (!options.out.empty()) write_result(comparison, options);
  if (options.json)
    fmt::print("{}\n", json_text(to_json(comparison)));
  else
    print(comparison);
  return all_hold;
}

namespace {

constexpr const char* below_compare =
    R"(Frames that have the run's vertices and triangles are compared vertex by vertex, other meshes by
the nearest points of both surfaces, and points without faces one-sided, by their distances from the
run's surface. The root mean square weights each vertex with a third of the areas around it, so that
it belongs to the surfaces, not to their meshes. FRAMES is a folder, a cache of all frames (.pc2,
.npz, .usda), or another stored run, OTHER.h5. Prints for each frame: distances, energies of
stretching and bending computed with the run's forces, the distribution of fold angles,
self-crossing pairs, and the depth in the run's objects. Between two frames of the run, its cloth is
interpolated from positions and velocities.

Examples:
  foldproof compare results/grab.h5 captured --rate 60 --start 0.5
  foldproof compare results/grab.h5 frames --out mine && foldproof report mine

Exit codes:
  0    compared; the distance does not matter
  2    bad input; a frame cannot be read, or none lies in the run's time)";

}  // namespace

void add_compare_command(CLI::App& app, Program& program) {
  auto [compare, options] = add_command(
      app, program,
      {"compare", "How far are frames of another program, or a captured cloth, from a stored run?",
       below_compare},
      compare_frames);
  add_input(compare, "RUN.h5", options.file, "Run stored by `foldproof simulate`");
  add_input(compare, "FRAMES", options.frames,
            "Folder of OBJ or PLY files, one a frame [m]; a cache; or another run");
  add_frame_times(compare, options);
  add_seams(compare, options.seams);
  add_cache(compare, options);
  add_out_if_typed(compare, options, "Also write run.h5 into this folder, for `foldproof report`");
  add_json(compare, options);
}

}  // namespace foldproof
