// foldproof project: a stored run with its cloth brought out of the objects, and what that leaves
// of its wrinkles.

#include <array>
#include <limits>
#include <nlohmann/json.hpp>

#include "scripts/program/command_line/options_of_commands.h"
#include "convergence/contact/section_profile.h"
#include "convergence/contact/wrinkle_measure.h"
#include "reference/bodies/level_set_provider.h"
#include "reference/mesh/subdivision.h"
#include "reference/post/fold_projection.h"
#include "scripts/program/command_line/input_files.h"
#include "scripts/program/json_text.h"
#include "scripts/program/command_line/out_folder.h"
#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"
#include "scripts/program/run_case.h"
#include "verification/cases/quantities.h"
#include "verification/files/stored_run_file.h"
#include "verification/files/trajectory_file.h"

namespace foldproof {

namespace {

struct ProjectOptions : Options {
  std::string map, rule = "loop";                             // a depth map, a rule of subdivision
  double reach = 0, eps = 0;                                  // m
  double deepest = std::numeric_limits<double>::quiet_NaN();  // m; NaN: the deepest in the run
  int subdivisions = 0;
};

constexpr int samples_along = 256;  // of a section

/// A stored run as it is to be projected: its objects, and its cloth, subdivided or not.
struct Source {
  StoredRun run;
  std::vector<Object> objects;
  Subdivision finer;
  Scene scene;  // of the finer cloth

  State frame(std::size_t k) const {
    const State s = run.frame(k);
    return {s.time, finer.of(s.x), finer.of(s.v)};
  }
};

Source source_of(const ProjectOptions& options) {
  Source source;
  source.run = read_stored_run(options.file);
  const Scene& scene = source.run.scene;
  if (scene.objects.empty())
    throw InputError(options.file + ": its case names no object to project out of");
  source.objects = build_objects(scene, provider_for(options.cache, threads_of(options.running)));
  const SubdivisionRule rule =
      options.rule == "loop" ? SubdivisionRule::loop : SubdivisionRule::midpoint;
  source.finer = subdivision(scene.mesh, rule, options.subdivisions);
  source.scene = scene;
  source.scene.mesh = make_triangle_mesh(source.finer.of(scene.mesh.rest), source.finer.triangles);
  source.scene.name += "_projected";
  source.scene.title += ", projected";
  source.scene.prescribed.clear();
  return source;
}

/// The largest depth below the surface of a point that is not pinched, over all frames [m].
double deepest_in(const Source& source) {
  double deepest = 0;
  for (std::size_t k = 0; k < source.run.times.size(); ++k) {
    const State s = source.frame(k);
    ObjectsOverSpan now(source.objects, {s.time, s.time, 0});
    for (Eigen::Index i = 0; i < s.x.cols(); ++i) {
      const Nearest nearest = nearest_of(now.at(s.x.col(i)));
      if (!nearest.held_between()) deepest = std::max(deepest, -nearest.first.phi);
    }
  }
  return deepest;
}

FoldProjection projection_of(const ProjectOptions& options, const Source& source) {
  const double deepest = std::isnan(options.deepest) ? deepest_in(source) : options.deepest;
  return {options.map,
          {options.eps, options.reach, deepest},
          PinchedPoints::left_alone,
          1e-6 * options.reach,
          100};
}

/// How high the wrinkles are that were inside [m], and how long, along sections across
/// x, y and z [m].
struct Wrinkles {
  std::string of;
  double deviation;
  std::array<double, 3> wavelength;  // NaN where there is no section
};

Wrinkles wrinkles_of(const std::string& of, const Source& source, const PerParticle& before,
                     const PerParticle& phi) {
  Wrinkles wrinkles{of, deviation_where(phi, [&](Eigen::Index i) { return before[i] < 0; }), {}};
  for (int axis = 0; axis < 3; ++axis) {
    const MeshSection section = section_of(source.scene.mesh, axis);
    const double length = section.length.empty() ? 0 : section.length.back();
    wrinkles.wavelength[std::size_t(axis)] =
        dominant_wavelength(along(section, phi, samples_along), length / (samples_along - 1));
  }
  return wrinkles;
}

/// The report of the command.
struct Report {
  FoldProjection projection;
  std::string file;
  long frames = 0, moved = 0, pinched = 0, unfinished = 0;  // points, over all frames
  std::size_t inside = 0;                                   // points of the last frame
  double longest_edge = 0;                                  // of the last frame [m]
  double faces_before = 0, faces_after = 0;  // deepest point of a triangle, of all frames [m]
  std::vector<Wrinkles> wrinkles;            // of the last frame
};

void count(const ProjectedCloth& cloth, Report& report) {
  ++report.frames;
  report.moved += cloth.count(ProjectionOutcome::moved);
  report.pinched += cloth.count(ProjectionOutcome::pinched);
  report.unfinished += cloth.count(ProjectionOutcome::unfinished);
}

void compare_last_frame(const Source& source, Report& report) {
  const State s = source.frame(source.run.times.size() - 1);
  FoldProjection plainly = report.projection;
  plainly.map = "plain";
  const ProjectedCloth plain = project_folds(source.objects, s.x, s.time, plainly);
  const ProjectedCloth mapped = project_folds(source.objects, s.x, s.time, report.projection);
  report.inside = std::size_t((mapped.before.array() < 0).count());
  for (const Edge& edge : source.scene.mesh.edges)
    report.longest_edge =
        std::max(report.longest_edge, (mapped.x.col(edge.a) - mapped.x.col(edge.b)).norm());
  report.wrinkles = {wrinkles_of("before", source, mapped.before, mapped.before),
                     wrinkles_of("plain", source, mapped.before, plain.after),
                     wrinkles_of(report.projection.map, source, mapped.before, mapped.after)};
}

/// As the quantity faces_outside has it [m].
double deepest_face(const Source& source, const State& s) {
  return value_at(*find_quantity("faces_outside"), source.scene, source.objects, s);
}

Report project_all(const Source& source, const ProjectOptions& options) {
  Report report;
  report.projection = projection_of(options, source);
  check_band(report.projection.band);  // before a file is begun
  report.file = source.scene.name + ".h5";
  const System system = make_system(masses_of(source.scene));
  TrajectoryFile file((std::filesystem::path(options.out) / report.file).string(), source.scene,
                      system, source.objects, provenance(options.command));
  ProgressLine progress("project " + source.run.scene.name);
  for (std::size_t k = 0; k < source.run.times.size(); ++k) {
    State s = source.frame(k);
    const ProjectedCloth cloth = project_folds(source.objects, s.x, s.time, report.projection);
    report.faces_before = std::max(report.faces_before, deepest_face(source, s));
    s.x = cloth.x;
    report.faces_after = std::max(report.faces_after, deepest_face(source, s));
    count(cloth, report);
    file.add_frame(s);
    progress.show(double(k + 1) / double(source.run.times.size()));
  }
  file.finish("", std::numeric_limits<double>::quiet_NaN(), {});
  compare_last_frame(source, report);
  return report;
}

std::string length_text(double length) {
  return std::isnan(length) ? "-" : fmt::format("{:.3g}", length);
}

void print(const Report& report, const std::string& folder) {
  const DepthBand& band = report.projection.band;
  fmt::print("map '{}': eps {:.3g} m, tau {:.3g} m, deepest {:.3g} m; {} frames\n",
             report.projection.map, band.nearest, band.reach, band.deepest, report.frames);
  fmt::print("points over all frames: {} moved, {} pinched and left alone, {} without room\n",
             report.moved, report.pinched, report.unfinished);
  fmt::print("last frame, {} points that were inside:\n", report.inside);
  fmt::print("  {:<8} {:>22} {:>40}\n", "", "deviation of depths [m]",
             "dominant wavelength across x, y, z [m]");
  for (const Wrinkles& row : report.wrinkles)
    fmt::print("  {:<8} {:>22} {:>16} {:>11} {:>11}\n", row.of, length_text(row.deviation),
               length_text(row.wavelength[0]), length_text(row.wavelength[1]),
               length_text(row.wavelength[2]));
  fmt::print("deepest point of a triangle over all frames: {:.3g} m before, {:.3g} m after\n",
             report.faces_before, report.faces_after);
  fmt::print(
      "edges up to {:.3g} m: for any objects, eps = {:.3g} m would keep every triangle out\n",
      report.longest_edge, report.longest_edge / std::sqrt(3.0));
  fmt::print("{}/{}\n", folder, report.file);
}

nlohmann::json to_json(const Report& report, const std::string& folder) {
  const DepthBand& band = report.projection.band;
  nlohmann::json json = {{"file", folder + "/" + report.file},
                         {"map", report.projection.map},
                         {"eps", band.nearest},
                         {"tau", band.reach},
                         {"deepest", band.deepest},
                         {"frames", report.frames},
                         {"moved", report.moved},
                         {"pinched", report.pinched},
                         {"unfinished", report.unfinished},
                         {"inside", report.inside},
                         {"longest_edge", report.longest_edge},
                         {"faces_before", report.faces_before},
                         {"faces_after", report.faces_after},
                         {"wrinkles", nlohmann::json::array()}};
  for (const Wrinkles& row : report.wrinkles)
    json["wrinkles"].push_back(
        {{"of", row.of}, {"deviation", row.deviation}, {"wavelength", row.wavelength}});
  return json;
}

int project_run(const ProjectOptions& options) {
  require_input(options.file, run_kind);
  const OutFolder folder(options.out);
  const Report report = project_all(source_of(options), options);
  if (options.json)
    fmt::print("{}\n", json_text(to_json(report, options.out)));
  else
    print(report, options.out);
  return report.unfinished == 0 ? all_hold : some_fail;
}

constexpr const char* below_project =
    R"(Prints how many points moved. For the last frame it also prints how much of the wrinkles is left
before projection, after plain projection, and after the map: the standard deviation of the depths
of points that were inside, and the peak of the spectrum of depth along a section of the cloth.
Points between two objects are left alone. Points end at most tau/10^6 farther out than the map
says.

Examples:
  foldproof project results/half_inside.h5 --map blend --tau 0.01

Exit codes:
  0    all points are out
  1    some points have too little clearance between objects
  2    bad input, or a file that cannot be written)";

}  // namespace

void add_project_command(CLI::App& app, Program& program) {
  auto [project, options] = add_command(
      app, program,
      {"project", "Move the cloth of a stored run out of its objects; writes NAME_projected.h5",
       below_project},
      project_run);
  add_input(project, "RUN.h5", options.file, "Run stored by `foldproof simulate`");
  add_value(project, "--map MAP", options.map, "Map of depth: plain, power or blend",
            one_of({"plain", "power", "blend"}))
      ->required();
  add_length(project, "--tau", options.reach, "Move also points outside, up to this distance [m]")
      ->required();
  add_length(project, "--eps", options.eps,
             "Final distance of the deepest points outside the object [m]")
      ->capture_default_str();
  add_length(project, "--deepest", options.deepest,
             "Depths [m] beyond this are treated alike (default: the deepest in the run)");
  add_value(project, "--subdivide N", options.subdivisions,
            "Levels of subdivision before the projection, 0 to 8", whole_number(0, 8))
      ->capture_default_str();
  add_value(project, "--rule RULE", options.rule, "Rule of subdivision: loop or midpoint",
            one_of({"loop", "midpoint"}))
      ->capture_default_str();
  add_cache(project, options);
  add_folder(project, options, "Folder for the projected run")->capture_default_str();
  add_json(project, options);
}

}  // namespace foldproof
