#include "convergence/any_case/space_ladder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "reference/scene/key_file.h"
#include "reference/scene/read_cloth_mesh.h"
#include "reference/scene/refine_cloth.h"

namespace foldproof {

namespace {

constexpr double most_step_error = 0.1;  // over the last difference between meshes [1]
constexpr double same_place = 1e-9;      // over the cloth's extent [1]: two points are one

/// The case's keys with those overrides, as a tree of its own.
CaseKeys keys_of(const CaseSource& source, const std::vector<std::string>& more) {
  std::vector<std::string> all = source.overrides;
  all.insert(all.end(), more.begin(), more.end());
  return parse_case(source.path, all);
}

std::string times_two(const KeyTable& table, const std::string& path, const std::string& key,
                      int k) {
  return fmt::format("{}.{}={}", path, key, table.integer(key) << k);
}

/// Keys that say how fine the shape is; none for a shape whose finer mesh is another one.
std::vector<std::string> numbers_of(const KeyTable& cloth) {
  const std::string shape = cloth.text_or("shape", "");
  if (shape == "sheet") return {"columns", "rows"};
  if (shape == "disc") return {"rings"};
  if (shape == "cylinder") return {"around", "along"};
  if (shape == "sphere") return {cloth.has("divisions") ? "divisions" : "subdivisions"};
  return {};
}

/// Level k by numbers.
std::vector<std::string> number_overrides(const KeyTable& cloth, int k) {
  std::vector<std::string> overrides;
  for (const std::string& key : numbers_of(cloth))
    overrides.push_back(key == "subdivisions"
                            ? fmt::format("cloth.subdivisions={}", cloth.integer(key) + k)
                            : times_two(cloth, "cloth", key, k));
  if (const auto pleats = cloth.table("pleats"))
    overrides.push_back(times_two(*pleats, "cloth.pleats", "columns", k));
  return overrides;
}

/// A list of numbers of particles in the case: its path, and the table that has it.
struct ParticleList {
  std::string path;
  std::vector<long> particles;
};

void add_list(const std::shared_ptr<KeyTable>& table, const std::string& path,
              std::vector<ParticleList>& lists) {
  if (table && table->has("particles") && table->is_list("particles"))
    lists.push_back({path + ".particles", table->integers("particles")});
}

std::vector<ParticleList> particle_lists(const KeyTable& keys) {
  std::vector<ParticleList> lists;
  const auto holds = keys.tables("hold"), sticky = keys.tables("sticky"),
             quantities = keys.tables("quantity");
  for (size_t k = 0; k < holds.size(); ++k) add_list(holds[k], fmt::format("hold.{}", k), lists);
  for (size_t k = 0; k < sticky.size(); ++k)
    add_list(sticky[k]->table("particles"), fmt::format("sticky.{}.particles", k), lists);
  for (size_t k = 0; k < quantities.size(); ++k)
    if (quantities[k]->has("of") && !quantities[k]->is_text("of"))
      add_list(quantities[k]->table("of"), fmt::format("quantity.{}.of", k), lists);
  return lists;
}

/// Why something of the case goes by number, so that meshes must be refined by middles; ""
/// if nothing does.
std::string what_goes_by_number(const KeyTable& keys) {
  if (const auto start = keys.table("start"); start && start->number_or("noise", 0) > 0)
    return "the noise of the start goes by particle";
  if (const auto bending = keys.table("bending"); bending && bending->has("rest_angle") &&
                                                  !bending->is_text("rest_angle") &&
                                                  bending->number("rest_angle") != 0)
    return "one rest angle is given for all hinges";
  for (const auto& patch : keys.tables("sticky"))
    if (const auto surface = patch->table("surface");
        surface && surface->text_or("of", "") == "cloth" && surface->has("triangles"))
      return "what is sticky is listed by triangles";
  return "";
}

std::vector<std::string> remapped_lists(const std::vector<ParticleList>& lists,
                                        const std::vector<int>& common) {
  std::vector<std::string> overrides;
  for (const ParticleList& list : lists) {
    std::string numbers;
    for (const long i : list.particles)
      numbers += (numbers.empty() ? "" : ", ") +
                 std::to_string(i >= 0 && i < long(common.size()) ? common[size_t(i)] : i);
    overrides.push_back(list.path + "=[" + numbers + "]");
  }
  return overrides;
}

/// The source of all finer levels.
struct Refinement {
  const CaseSource& source;
  const KeyTable& keys;
  const Case& coarse;
  ObjectsToo objects;
};

/// Cells of level sets as much smaller as edges of the cloth, if they are to be refined.
std::vector<std::string> object_overrides(const Refinement& of, int k) {
  if (of.objects == ObjectsToo::no) return {};
  std::vector<std::string> overrides;
  const auto objects = of.keys.tables("object");
  for (size_t j = 0; j < objects.size(); ++j) {
    const KeyTable& object = *objects[j];
    const bool has_cells =
        (object.has("mesh") || object.has("frames") || object.text_or("shape", "") == "statue") &&
        object.text_or("field", "grid") != "exact";
    if (!has_cells) continue;
    overrides.push_back(fmt::format("object.{}.cells={}", j, object.integer_or("cells", 64) << k));
    if (object.has("tolerance"))
      overrides.push_back(fmt::format("object.{}.tolerance={:.17g}", j,
                                      std::ldexp(object.number("tolerance"), -k)));
  }
  return overrides;
}

/// A thickness that level k allows, where the case's is too much for it.
std::vector<std::string> thickness_override(const Refinement& of,
                                            const std::vector<std::string>& finer) {
  const auto& self_collision = of.coarse.scene.self_collision;
  if (!self_collision) return {};
  const CaseKeys keys = keys_of(of.source, finer);
  const auto cloth = keys.keys->table("cloth");
  PlacedMesh placed =
      read_cloth_mesh(*cloth, std::filesystem::path(of.source.path).parent_path().string(), {});
  const double height = smallest_height(placed.mesh.triangles, placed.mesh.rest);
  const double allowed = 0.49 * std::ldexp(height, -refinements_of(*cloth));
  if (self_collision->thickness <= allowed) return {};
  return {fmt::format("self_collision.thickness={:.17g}", allowed)};
}

Case read_level(const CaseSource& source, const std::vector<std::string>& finer, int k) {
  CaseSource level = source;
  level.overrides.insert(level.overrides.end(), finer.begin(), finer.end());
  try {
    return case_of(level);
  } catch (const InputError& error) {
    throw InputError(fmt::format("level {}: {}; or ask for fewer --levels", k, error.what()));
  }
}

double mean_edge(const TriangleMesh& mesh) {
  double area = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vector3 ab = mesh.rest.col(t[1]) - mesh.rest.col(t[0]),
                  ac = mesh.rest.col(t[2]) - mesh.rest.col(t[0]);
    area += ab.cross(ac).norm() / 2;
  }
  return std::sqrt(4 / std::sqrt(3.0) * area / double(mesh.triangles.size()));
}

void add_all(const std::vector<std::string>& more, std::vector<std::string>& overrides) {
  overrides.insert(overrides.end(), more.begin(), more.end());
}

SpaceLevel level_with(const Refinement& of, std::vector<std::string> finer, int k) {
  add_all(thickness_override(of, finer), finer);
  SpaceLevel level{finer, read_level(of.source, finer, k), {}, 0};
  level.edge = mean_edge(level.input_case.scene.mesh);
  return level;
}

std::vector<int> all_particles(const Case& input_case) {
  std::vector<int> all(size_t(input_case.scene.mesh.particles()));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// A way to make level k.
using Refine = SpaceLevel (*)(const Refinement& of, int k);

SpaceLevel level_by_middles(const Refinement& of, int k) {
  const int own = refinements_of(*of.keys.table("cloth"));
  std::vector<std::string> finer = {fmt::format("cloth.refine={}", own + k)};
  add_all(object_overrides(of, k), finer);
  SpaceLevel level = level_with(of, finer, k);
  level.common = all_particles(of.coarse);
  return level;
}

/// By numbers; without `common` where its particles are not those of level 0.
SpaceLevel level_by_numbers(const Refinement& of, int k) {
  std::vector<std::string> finer = number_overrides(*of.keys.table("cloth"), k);
  const CaseKeys finer_keys = keys_of(of.source, finer);
  const TriangleMesh mesh = read_cloth_mesh(*finer_keys.keys->table("cloth"), "", {}).mesh;
  const PerParticle3& rest = of.coarse.scene.mesh.rest;
  const double tolerance = same_place * longest_side(rest);
  const std::vector<int> common = matching_points(rest, mesh.rest, tolerance);
  if (common.empty()) return {};
  add_all(remapped_lists(particle_lists(of.keys), common), finer);
  add_all(object_overrides(of, k), finer);
  SpaceLevel level = level_with(of, finer, k);
  const PerParticle3 starts = level.input_case.scene.x(Eigen::all, common);
  if ((starts - of.coarse.scene.x).cwiseAbs().maxCoeff() <= tolerance) level.common = common;
  return level;
}

/// Level 0, and the finer ones; empty if one of them lacks particles of the case.
std::vector<SpaceLevel> refined_levels(const Refinement& of, int levels, Refine refine) {
  std::vector<SpaceLevel> all{
      {{}, of.coarse, all_particles(of.coarse), mean_edge(of.coarse.scene.mesh)}};
  for (int k = 1; k < levels; ++k) {
    all.push_back(refine(of, k));
    if (all.back().common.empty()) return {};
  }
  return all;
}

/// Why the meshes are not refined by numbers; "" if they can be.
std::string why_by_middles(const KeyTable& keys) {
  const auto cloth = keys.table("cloth");
  if (cloth->has("mesh")) return "the mesh is a file";
  if (refinements_of(*cloth) > 0) return "[cloth] refine is set";
  if (numbers_of(*cloth).empty()) return "shape '" + cloth->text("shape") + "' has no finer one";
  return what_goes_by_number(keys);
}

/// Of what the case names, what does not mean the same on a finer mesh.
std::vector<std::string> warnings_of(const KeyTable& keys, const SpaceLadder& ladder) {
  const Scene& scene = ladder.levels.front().input_case.scene;
  const Scene& finest = ladder.levels.back().input_case.scene;
  std::vector<std::string> warnings;
  for (const auto& hold : keys.tables("hold"))
    if (hold->has("particles")) {
      warnings.push_back(
          "cloth is held at points ([[hold]] particles): a membrane held at points need not "
          "converge in space; a box holds a region");
      break;
    }
  if (scene.bending && scene.bending->damping > 0 &&
      scene.bending->damping_factor == DampingFactor::edge)
    warnings.push_back(
        "damping of bending with the factor \"edge\" is another material on each mesh; "
        "\"edge_squared_over_area\" is the same on all");
  if (scene.self_collision && finest.self_collision->thickness < scene.self_collision->thickness)
    warnings.push_back(
        fmt::format("the thickness of self-collision falls with the triangles, {:.3g} to {:.3g} m",
                    scene.self_collision->thickness, finest.self_collision->thickness));
  if (scene.self_collision && scene.self_collision->stiffness > 0)
    warnings.push_back("repulsion is a stiffness per pair of features: finer meshes repel more");
  if (!scene.sticky.empty())
    warnings.push_back("the stiffness of sticking is that of a bond: finer meshes stick more");
  if (scene.schedule.step.fixed > 0)
    warnings.push_back(
        fmt::format("the fixed step is divided by {} on all meshes, since the elastic limit falls "
                    "with the edges",
                    1 << (ladder.levels.size() - 1)));
  return warnings;
}

/// Errors of the ladder's own steps, from one mesh with them and with halves of them: that much
/// times 2^p / (2^p - 1), p the order of the method.
void add_step_errors(const Scene& scene, const LevelRun& run, const LevelRun& halved,
                     LadderAnswer& answer) {
  const double gain = std::pow(2.0, integrator_named(scene.integrator).order);
  const double whole = gain / (gain - 1);
  const PerParticle mass = masses_of(scene);
  for (size_t q = 0; q < answer.quantities.size(); ++q) {
    QuantityOverLevels& over = answer.quantities[q];
    const double difference =
        q == 0
            ? field_difference(run, halved, mass)
            : (halved.stopped.empty() ? std::abs(run.values[q - 1] - halved.values[q - 1]) : nan);
    over.step_error = whole * difference;
    const double last = std::abs(over.differences.back());
    if (!(over.step_error <= most_step_error * last) && last > 0)
      answer.warnings.push_back(
          fmt::format("{}: the steps' own error, {:.2g} {}, is not below a tenth of the last "
                      "difference between meshes, {:.2g}: shorten them (--set time.safety=...)",
                      over.name, over.step_error, over.unit, last));
  }
}

}  // namespace

Case case_of(const CaseSource& source) {
  Case input_case = read_case(source.path, source.overrides);
  if (!source.method.empty()) {
    integrator_named(source.method);
    input_case.scene.integrator = source.method;
  }
  if (source.until > 0)
    input_case.scene.schedule.end = std::min(source.until, input_case.scene.schedule.end);
  return input_case;
}

std::vector<int> matching_points(const PerParticle3& of, const PerParticle3& among,
                                 double tolerance) {
  // along a direction that no grid is square to, few points are close to another
  const Vector3 direction = Vector3(0.61, 0.53, 0.37).normalized();
  const Eigen::RowVectorXd along = direction.transpose() * among;
  std::vector<int> order(size_t(among.cols()));
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](int i) { return along[i]; });
  std::vector<int> matches;
  for (Eigen::Index p = 0; p < of.cols(); ++p) {
    const double place = direction.dot(of.col(p));
    int found = -1, count = 0;
    auto next =
        std::ranges::lower_bound(order, place - tolerance, {}, [&](int i) { return along[i]; });
    for (; next != order.end() && along[*next] <= place + tolerance; ++next)
      if ((among.col(*next) - of.col(p)).norm() <= tolerance) found = *next, ++count;
    if (count != 1) return {};
    matches.push_back(found);
  }
  return matches;
}

SpaceLadder space_ladder(const CaseSource& source, int levels, ObjectsToo objects_too) {
  const Case coarse = case_of(source);
  const CaseKeys keys = keys_of(source, {});
  const Refinement of{source, *keys.keys, coarse, objects_too};
  SpaceLadder ladder;
  std::string why = why_by_middles(*keys.keys);
  if (why.empty()) {
    ladder.levels = refined_levels(of, levels, level_by_numbers);
    ladder.refined_by = fmt::format("{}", fmt::join(numbers_of(*keys.keys->table("cloth")), ", "));
    if (ladder.levels.empty()) why = "finer meshes of this shape lack particles of the case";
  }
  if (!why.empty()) {
    ladder.levels = refined_levels(of, levels, level_by_middles);
    ladder.refined_by = "middles of edges, since " + why;
  }
  ladder.warnings = warnings_of(*keys.keys, ladder);
  return ladder;
}

Level space_level(const SpaceLadder& ladder, int k, const std::vector<double>& step_ends) {
  const SpaceLevel& at = ladder.levels[size_t(k)];
  Level level{fmt::format("{}, edges divided by {}", at.input_case.scene.name, 1 << k),
              at.input_case, measurements_of(at.input_case), at.input_case.scene.mesh.particles(),
              at.common};
  StepRule& rule = level.input_case.scene.schedule.step;
  rule.fixed = std::ldexp(rule.fixed, 1 - int(ladder.levels.size()));
  rule.ends = step_ends;
  return level;
}

Level step_check_level(const SpaceLadder& ladder, const std::vector<double>& step_ends) {
  Level level = space_level(ladder, int(ladder.levels.size()) - 2, divide_steps(step_ends, 0, 2));
  level.label += ", steps halved";
  return level;
}

LadderAnswer space_answer(const SpaceLadder& ladder, const std::vector<LevelRun>& runs,
                          const LevelRun& halved) {
  const Scene& scene = ladder.levels.front().input_case.scene;
  LadderAnswer answer = ladder_answer(
      scene, "space", measurements_of(ladder.levels.front().input_case), runs, order_in_space);
  for (const SpaceLevel& level : ladder.levels) {
    answer.sizes.push_back(level.edge);
    answer.particles.push_back(level.input_case.scene.mesh.particles());
    answer.overrides.push_back(level.overrides);
  }
  answer.refined_by = ladder.refined_by;
  answer.warnings = ladder.warnings;
  add_step_errors(scene, runs[runs.size() - 2], halved, answer);
  return answer;
}

}  // namespace foldproof
