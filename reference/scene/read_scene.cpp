#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <sstream>

#include "reference/scene/key_values.h"
#include "reference/scene/fabrics.h"
#include "reference/scene/read_materials.h"
#include "reference/scene/read_objects.h"
#include "reference/scene/read_region.h"
#include "reference/scene/read_self_collision.h"
#include "reference/scene/read_start.h"
#include "reference/scene/read_sticky.h"
#include "reference/scene/read_strain.h"
#include "reference/scene/refine_cloth.h"
#include "reference/scene/scene.h"
#include "reference/scene/scene_sizes.h"
#include "reference/scene/read_cloth_mesh.h"

namespace foldproof {

namespace {

std::vector<double> read_rest_angles(const KeyTable& keys, const TriangleMesh& mesh) {
  if (keys.has("rest_angle") && !keys.is_text("rest_angle")) {
    const double degrees = keys.number("rest_angle");
    if (!(std::abs(degrees) <= 180))
      throw InputError(keys.where("rest_angle") + ": 'rest_angle' must lie in [-180, 180] degrees");
    return std::vector<double>(mesh.hinges.size(), degrees * radians_per_degree);
  }
  enum class Source { rest_shape, flat };
  const Source source = choice<Source>(
      keys, "rest_angle", {{"rest_shape", Source::rest_shape}, {"flat", Source::flat}});
  if (source == Source::flat) return std::vector<double>(mesh.hinges.size(), 0.0);
  if (!mesh.pattern.empty()) return std::vector<double>(mesh.hinges.size(), 0.0);
  return hinge_angles(mesh, mesh.rest);
}

std::vector<int> particles_at_top(const KeyTable& keys, const PerParticle3& x) {
  const double fraction = positive(keys, "top");
  const double low = x.row(1).minCoeff(), high = x.row(1).maxCoeff();
  std::vector<int> chosen;
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    if (x(1, i) >= high - fraction * (high - low)) chosen.push_back(int(i));
  return chosen;
}

/// "lies from (0, 0, 0) to (1, 0, 2) m".
std::string extent_in_words(const PerParticle3& x) {
  const auto point = [](const Vector3& p) {
    std::ostringstream text;
    text << "(" << p.x() << ", " << p.y() << ", " << p.z() << ")";
    return text.str();
  };
  return "lies from " + point(x.rowwise().minCoeff()) + " to " + point(x.rowwise().maxCoeff()) +
         " m";
}

void read_hold(const KeyTable& keys, Scene& scene) {
  if (int(keys.has("particles")) + int(keys.has("box")) + int(keys.has("top")) != 1)
    throw InputError(keys.where() + ": [[hold]] needs one of 'particles', 'box', 'top'");
  const std::vector<int> chosen =
      keys.has("particles")
          ? with_copies(numbered(keys, "particles", scene.x.cols()), scene.copy_of)
      : keys.has("box") ? select_in_box(keys, scene.x)
                        : particles_at_top(keys, scene.x);
  const std::string by = keys.has("particles") ? "particles" : keys.has("box") ? "box" : "top";
  if (chosen.empty())
    throw InputError(keys.where(by) + ": [[hold]] holds no particle; the cloth " +
                     extent_in_words(scene.x));
  if (chosen.size() == 1 && by != "particles")
    scene.warnings.push_back(keys.where(by) + ": [[hold]] holds one particle only, number " +
                             std::to_string(chosen.front()) + "; the cloth " +
                             extent_in_words(scene.x));
  const Motion motion = read_motion(keys);
  std::vector<char> is_held(size_t(scene.x.cols()), 0);
  for (const PrescribedParticle& other : scene.prescribed) is_held[size_t(other.particle)] = 1;
  for (int i : chosen) {
    if (is_held[size_t(i)]++)
      throw InputError(keys.where() + ": particle " + std::to_string(i) + " is held twice");
    scene.prescribed.push_back({i, scene.x.col(i), motion});
  }
}

void read_time(const KeyTable& keys, Scene& scene) {
  scene.schedule.end = positive(keys, "end");
  scene.schedule.frame_interval = 1 / positive_or(keys, "frames_per_second", 30);
  if (choice<bool>(keys, "until", {{"end", false}, {"rest", true}})) {
    RestLimits limits;
    limits.speed = positive_or(keys, "rest_speed", limits.speed);
    limits.force = positive_or(keys, "rest_force", limits.force);
    scene.schedule.rest = limits;
  }
  if (keys.is_text("step")) {
    if (keys.text("step") != "automatic")
      throw InputError(keys.where("step") + ": 'step' must be a number [s] or \"automatic\"");
  } else if (keys.has("step")) {
    scene.schedule.step.fixed = positive(keys, "step");
  }
  scene.schedule.step.safety = positive_or(keys, "safety", scene.schedule.step.safety);
  scene.schedule.step.strain_per_step =
      positive_or(keys, "strain_per_step", scene.schedule.step.strain_per_step);
  scene.schedule.max_steps = count_or(keys, "max_steps", scene.schedule.max_steps);
  scene.integrator = keys.text_or("integrator", scene.integrator);
  try {
    integrator_named(scene.integrator);
  } catch (const InputError& error) {
    throw InputError(keys.where("integrator") + ": " + error.what());
  }
}

void read_solver(const KeyTable& keys, SolverSettings& solver) {
  solver.tolerance = positive_or(keys, "tolerance", solver.tolerance);
  solver.max_iterations = int(count_or(keys, "max_iterations", solver.max_iterations));
  solver.scale = choice<ResidualScale>(keys, "relative_to",
                                       {{"momentum", ResidualScale::momentum},
                                        {"initial_residual", ResidualScale::initial_residual}});
}

constexpr size_t longest_name = 100;

/// A case's name becomes part of file names and of names of findings: it must contain no path and
/// need no quoting.
void reject_name(const std::string& name, const std::string& path) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  };
  const bool is_good = !name.empty() && name.size() <= longest_name &&
                       std::ranges::all_of(name, is_plain) && name.front() != '.' &&
                       name.front() != '-' && name.find("..") == std::string::npos;
  if (!is_good)
    throw InputError(path + ": a case is named after its file, by at most " +
                     std::to_string(longest_name) +
                     " letters a-z, digits and '_', '-', '.', the first no hyphen or dot and no "
                     "two dots in a row; rename the file");
}

void refine(const KeyTable& cloth, const SceneLimits& limits, Scene& scene) {
  const int times = refinements_of(cloth);
  reject_many_triangles(cloth, "refine", std::ldexp(double(scene.mesh.triangles.size()), 2 * times),
                        limits);
  for (int k = 0; k < times; ++k) refine_cloth(scene);
}

/// Numbers of a case can be valid one by one, yet their product can overflow or underflow a double.
void reject_overflow(const KeyTable& cloth, const Scene& scene) {
  const State start = start_state(scene);
  if (!start.x.allFinite() || !start.v.allFinite() || !scene.mesh.rest.allFinite())
    throw InputError(cloth.where() +
                     ": a place or velocity at the start, or at rest, is not finite");
  const PerParticle masses = masses_of(scene);
  if (!(masses.minCoeff() > 0) || !masses.allFinite())
    throw InputError(cloth.where() + ": a particle has the mass 0, or one that is not finite");
}

/// The fabric that the cloth names, if any.
std::optional<Fabric> read_fabric(const KeyTable& cloth, const std::string& folder) {
  if (!cloth.has("fabric")) {
    if (cloth.has("fabrics"))
      throw InputError(cloth.where("fabrics") +
                       ": 'fabrics' is a file to look 'fabric' up in; name one");
    return std::nullopt;
  }
  const std::filesystem::path file = cloth.text_or("fabrics", "fabrics.toml");
  const std::string path =
      (file.is_absolute() ? file : std::filesystem::path(folder) / file).string();
  return fabric_named(read_fabrics(path), cloth.text("fabric"), cloth.where("fabric"));
}

/// The mesh at its start, with masses, title and text; nothing acts on it yet.
Scene read_cloth(const KeyTable& keys, const KeyTable& cloth, const std::optional<Fabric>& fabric,
                 PlacedMesh& placed) {
  const double density =
      fabric && !cloth.has("density") ? fabric->density : positive(cloth, "density");
  Scene scene = scene_at_rest(std::move(placed.mesh), density);
  scene.x = std::move(placed.start);
  scene.copy_of = std::move(placed.copy_of);
  scene.unsewn = std::move(placed.unsewn);
  scene.title = keys.text_or("title", "");
  scene.about = keys.text_or("about", "");
  if (const auto start = keys.table("start")) read_start(*start, scene);
  reject_overflow(cloth, scene);
  return scene;
}

void read_stretch_and_limits(const KeyTable& keys, Scene& scene) {
  if (const auto stretch = keys.table("stretch")) {
    const auto [material, directions] = read_stretch(*stretch, scene.mesh, nullptr, scene.notes);
    scene.stretch = material;
    scene.stretch_directions = directions;
  }
  if (const auto membrane = keys.table("membrane"))
    scene.membrane = read_membrane(*membrane, nullptr);
  read_strain_limits(keys, scene);
}

void read_bending_of(const KeyTable& bending, const std::optional<Fabric>& fabric, Scene& scene) {
  if (fabric) {
    const std::string report = fabric_on_mesh(*fabric, scene.mesh).report;
    scene.about += (scene.about.empty() ? "" : " ") + report;
    scene.notes.push_back(report);
  }
  const auto [material, directions] =
      read_bending(bending, scene.mesh, nullptr, fabric, scene.notes);
  scene.bending = material;
  scene.bending_directions = directions;
  scene.rest_angles = read_rest_angles(bending, scene.mesh);
}

}  // namespace

Scene scene_from(const CaseKeys& of, const SceneLimits& limits) {
  const std::filesystem::path file(of.path);
  const std::string folder = file.parent_path().string();
  const KeyTable& keys = *of.keys;
  const auto cloth = keys.table("cloth"), time = keys.table("time"),
             self = keys.table("self_collision");
  if (!cloth || !time)
    throw InputError(keys.where() + ": a case needs the tables [cloth] and [time]");
  PlacedMesh placed = read_cloth_mesh(*cloth, folder, limits);
  const std::optional<Fabric> fabric = read_fabric(*cloth, folder);
  Scene scene = read_cloth(keys, *cloth, fabric, placed);
  if (const auto gravity = keys.table("gravity"))
    scene.gravity = gravity->vector_or("acceleration", {0, -9.80665, 0});
  read_stretch_and_limits(keys, scene);
  if (const auto bending = keys.table("bending")) read_bending_of(*bending, fabric, scene);
  read_cloth_fabrics(keys, folder, placed.groups, scene);
  if (const auto air = keys.table("air")) scene.air = read_air(*air);
  note_pattern(scene);
  refine(*cloth, limits, scene);
  for (const auto& hold : keys.tables("hold")) read_hold(*hold, scene);
  reject_overflow(*cloth, scene);
  read_time(*time, scene);
  read_objects(keys, {folder, scene.schedule.end, limits}, scene);
  note_scales(keys, placed.scale, scene);
  if (self) scene.self_collision = read_self_collision(*self, scene);
  read_sticky(keys, folder, scene);
  if (const auto solver = keys.table("solver")) read_solver(*solver, scene.solver);
  if (self) {
    reject_touching_start(*self, scene);
    reject_tangled_start(*self, scene);
  }
  warn_of_sizes(*cloth, placed.scale, scene);
  scene.name = file.stem().string();
  scene.folder = folder;
  scene.text = of.text;
  return scene;
}

CaseKeys parse_case_text(const std::string& text, const std::string& path,
                         const std::vector<std::string>& overrides) {
  reject_name(std::filesystem::path(path).stem().string(), path);
  CaseKeys of{path, text, parse_keys(text, path)};
  for (const std::string& assignment : overrides) {
    set_key(*of.keys, assignment);
    of.text += "\n# --set " + assignment;
  }
  return of;
}

CaseKeys parse_case(const std::string& path, const std::vector<std::string>& overrides) {
  if (!std::filesystem::is_regular_file(path))
    throw InputError(path + ": there is no such case file");
  return parse_case_text(read_text(path), path, overrides);
}

namespace {

Scene scene_alone(const CaseKeys& of, const SceneLimits& limits) {
  Scene scene = scene_from(of, limits);
  const KeyTable& keys = *of.keys;
  keys.leave("expect");    // expectations of the run: read by its judge
  keys.leave("ablation");  // reasons for parts present or absent: read by the ablation
  keys.leave("quantity");  // measurements of the run: read by its measurer
  keys.reject_unused();
  return scene;
}

}  // namespace

Scene read_scene(const std::string& path, const std::vector<std::string>& overrides) {
  return scene_alone(parse_case(path, overrides), {});
}

Scene read_scene_text(const std::string& text, const std::string& path,
                      const std::vector<std::string>& overrides, const SceneLimits& limits) {
  return scene_alone(parse_case_text(text, path, overrides), limits);
}

}  // namespace foldproof
