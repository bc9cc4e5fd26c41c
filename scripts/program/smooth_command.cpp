// foldproof smooth: a stored run with a smooth surface of its cloth that does not cross itself.

#include <limits>
#include <nlohmann/json.hpp>

#include "scripts/program/command_line/options_of_commands.h"
#include "reference/bodies/level_set_provider.h"
#include "reference/post/smooth_cloth.h"
#include "scripts/program/command_line/input_files.h"
#include "scripts/program/command_line/out_folder.h"
#include "scripts/program/json_text.h"
#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"
#include "scripts/program/run_case.h"
#include "verification/files/stored_run_file.h"
#include "verification/files/trajectory_file.h"
#include "verification/oracles/exact_crossings.h"

namespace foldproof {

namespace {

struct SmoothOptions : Options {
  int levels = 1;  // of subdivision
};

/// Pairs of an edge and a triangle that cross in one frame.
struct SmoothedFrame {
  double time;  // s
  std::size_t in_run, in_loops, left;
  double mean_share;  // of the way to Loop's surface [1]
};

struct SmoothedRun {
  std::string file;
  std::vector<SmoothedFrame> frames;
};

SmoothedFrame smooth_frame(const ClothSmoother& smoother, const std::vector<Triangle>& triangles,
                           State& s) {
  const std::vector<Triangle>& fine = smoother.smooth.triangles;
  SmoothedFrame frame{s.time, oracles::exact_crossings(s.x, triangles).size(),
                      oracles::exact_crossings(smoother.smooth.of(s.x), fine).size(), 0, 0};
  const SmoothedCloth cloth = smooth_cloth(smoother, s.x);
  s.v = smoother.smooth.of(s.v);
  s.x = cloth.x;
  frame.left = oracles::exact_crossings(s.x, fine).size();
  frame.mean_share = cloth.share.mean();
  return frame;
}

SmoothedRun smooth_all(const SmoothOptions& options) {
  const StoredRun run = read_stored_run(options.file);
  const std::vector<Object> objects =
      build_objects(run.scene, provider_for(options.cache, threads_of(options.running)));
  const ClothSmoother smoother(run.scene.mesh, options.levels);
  Scene scene = run.scene;
  scene.mesh = make_triangle_mesh(smoother.flat.of(scene.mesh.rest), smoother.smooth.triangles);
  scene.name += "_smooth";
  scene.title += ", smooth";
  scene.prescribed.clear();
  scene.fabrics = {}, scene.membrane.reset();  // of the triangles before
  SmoothedRun smooth{scene.name + ".h5", {}};
  const System system = make_system(masses_of(scene));
  TrajectoryFile file((std::filesystem::path(options.out) / smooth.file).string(), scene, system,
                      objects, provenance(options.command));
  ProgressLine progress("smooth " + run.scene.name);
  for (std::size_t k = 0; k < run.times.size(); ++k) {
    State s = run.frame(k);
    s.bonds.clear();
    smooth.frames.push_back(smooth_frame(smoother, run.scene.mesh.triangles, s));
    file.add_frame(s);
    progress.show(double(k + 1) / double(run.times.size()));
  }
  file.finish("", std::numeric_limits<double>::quiet_NaN(), {});
  return smooth;
}

void print(const SmoothedRun& run, const std::string& folder) {
  fmt::print("{:>10} {:>16} {:>16} {:>16} {:>14}\n", "time [s]", "crossings, run", "Loop's surface",
             "smooth", "mean share");
  for (const SmoothedFrame& frame : run.frames)
    fmt::print("{:>10.4g} {:>16} {:>16} {:>16} {:>14.4f}\n", frame.time, frame.in_run,
               frame.in_loops, frame.left, frame.mean_share);
  fmt::print("{}/{}\n", folder, run.file);
}

nlohmann::json to_json(const SmoothedRun& run, const std::string& folder) {
  nlohmann::json json = {{"file", folder + "/" + run.file}, {"frames", nlohmann::json::array()}};
  for (const SmoothedFrame& frame : run.frames)
    json["frames"].push_back({{"time", frame.time},
                              {"crossings_of_run", frame.in_run},
                              {"crossings_of_loops_surface", frame.in_loops},
                              {"crossings", frame.left},
                              {"mean_share", frame.mean_share}});
  return json;
}

int smooth_run(const SmoothOptions& options) {
  require_input(options.file, run_kind);
  const OutFolder folder(options.out);
  const SmoothedRun run = smooth_all(options);
  if (options.json)
    fmt::print("{}\n", json_text(to_json(run, options.out)));
  else
    print(run, options.out);
  const bool crosses =
      std::ranges::any_of(run.frames, [](const SmoothedFrame& frame) { return frame.left > 0; });
  return crosses ? some_fail : all_hold;
}

constexpr const char* below_smooth =
    R"(Subdivides the cloth of every frame by Loop's rule, each triangle into four a level. Where the
smooth surface would cross itself, points stop on the way there from the cloth's own triangles.
Prints, for each frame, how many pairs of an edge and a triangle cross in the run, on Loop's surface
and on the smooth one (decided exactly), and how far points came on average. A cloth that crosses
itself stays crossed.

Examples:
  foldproof smooth results/grab.h5 --levels 2

Exit codes:
  0    no frame crosses itself
  1    a frame of the smooth surface crosses itself, as the run's does
  2    bad input, or a file that cannot be written)";

}  // namespace

void add_smooth_command(CLI::App& app, Program& program) {
  auto [smooth, options] = add_command(
      app, program,
      {"smooth", "Give the cloth of a stored run a smooth surface; writes NAME_smooth.h5",
       below_smooth},
      smooth_run);
  add_input(smooth, "RUN.h5", options.file, "Run stored by `foldproof simulate`");
  add_value(smooth, "--levels N", options.levels, "Levels of subdivision, 1 to 4",
            whole_number(1, 4))
      ->capture_default_str();
  add_cache(smooth, options);
  add_folder(smooth, options, "Folder for the smooth run")->capture_default_str();
  add_json(smooth, options);
}

}  // namespace foldproof
