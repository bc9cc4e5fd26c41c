#include "reference/scene/cloth_fabrics.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <utility>

#include "reference/scene/fabrics.h"
#include "reference/scene/key_values.h"
#include "reference/scene/read_region.h"
#include "reference/scene/read_materials.h"
#include "reference/scene/read_strain.h"
#include "reference/scene/scene.h"

namespace foldproof {

namespace {

PerParticle3 centres_of(const std::vector<Triangle>& triangles, const PerParticle3& x) {
  PerParticle3 centres(3, Eigen::Index(triangles.size()));
  for (size_t t = 0; t < triangles.size(); ++t)
    centres.col(Eigen::Index(t)) =
        (x.col(triangles[t][0]) + x.col(triangles[t][1]) + x.col(triangles[t][2])) / 3;
  return centres;
}

std::vector<int> triangles_of(const KeyTable& keys, const FaceGroups& groups, const Scene& scene) {
  if (int(keys.has("group")) + int(keys.has("box")) + int(keys.has("triangles")) != 1)
    throw InputError(keys.where() + ": [[fabric]] needs one of 'group', 'box', 'triangles'");
  if (keys.has("triangles"))
    return numbered(keys, "triangles", Eigen::Index(scene.mesh.triangles.size()));
  if (keys.has("box")) {
    std::vector<int> chosen = select_in_box(keys, centres_of(scene.mesh.triangles, scene.x));
    if (chosen.empty())
      throw InputError(keys.where("box") + ": the centre of no triangle lies in this box");
    return chosen;
  }
  const std::string name = keys.text("group");
  const auto found = groups.find(name);
  if (found != groups.end()) return found->second;
  std::string known;
  for (const auto& [other, triangles] : groups) known += (known.empty() ? "" : ", ") + other;
  throw InputError(keys.where("group") + ": the mesh has no group '" + name + "'; " +
                   (known.empty() ? "it has none at all" : "known: " + known));
}

/// The table of that name in a fabric's; throws InputError if the case does not have the part.
std::shared_ptr<KeyTable> part_of(const KeyTable& keys, const std::string& name, bool is_there) {
  auto table = keys.table(name);
  if (table && !is_there)
    throw InputError(table->where() + ": a fabric's " + name + " needs the table [" + name + "]");
  return table;
}

/// The fabric of a table; what it leaves out is as in `base`.
ClothFabric fabric_of(const KeyTable& keys, const std::string& folder, Scene& scene,
                      const ClothFabric& base) {
  ClothFabric fabric = base;
  const size_t notes = scene.notes.size();
  fabric.name = keys.text_or("name", keys.text_or("group", keys.text_or("fabric", "")));
  std::optional<Fabric> measured;
  if (keys.has("fabric")) {
    const std::filesystem::path file = keys.text_or("fabrics", "fabrics.toml");
    const std::string path =
        (file.is_absolute() ? file : std::filesystem::path(folder) / file).string();
    measured = fabric_named(read_fabrics(path), keys.text("fabric"), keys.where("fabric"));
    fabric.density = measured->density;
    if (scene.bending) {
      fabric.bending.stiffness = fabric_on_mesh(*measured, scene.mesh).stiffness;
      fabric.bending_directions = {};
    }
  }
  fabric.density = positive_or(keys, "density", fabric.density);
  if (const auto stretch = part_of(keys, "stretch", scene.stretch.has_value())) {
    const Directed<StretchMaterial> own{fabric.stretch, fabric.stretch_directions};
    const auto [material, directions] = read_stretch(*stretch, scene.mesh, &own, scene.notes);
    fabric.stretch = material;
    fabric.stretch_directions = directions;
  }
  if (const auto bending = part_of(keys, "bending", scene.bending.has_value())) {
    const Directed<BendingMaterial> own{fabric.bending, fabric.bending_directions};
    const auto [material, directions] =
        read_bending(*bending, scene.mesh, &own, measured, scene.notes);
    fabric.bending = material;
    fabric.bending_directions = directions;
  }
  if (const auto membrane = part_of(keys, "membrane", scene.membrane.has_value()))
    fabric.membrane = read_membrane(*membrane, &fabric.membrane);
  if (const auto limits = part_of(keys, "strain_limits", scene.strain_limits.has_value()))
    read_strain_range(*limits, fabric.limits);
  if (const auto layers = part_of(keys, "self_collision", base.thickness > 0)) {
    fabric.thickness = positive_or(*layers, "thickness", fabric.thickness);
    fabric.layer_friction = non_negative_or(*layers, "friction", fabric.layer_friction);
  }
  if (keys.has("friction")) fabric.friction = non_negative_or(keys, "friction", 0);
  for (size_t k = notes; k < scene.notes.size(); ++k)
    scene.notes[k] = "Fabric '" + fabric.name + "': " + scene.notes[k];
  return fabric;
}

/// A hinge between two fabrics.
BendingMaterial between(const BendingMaterial& one, const BendingMaterial& other) {
  BendingMaterial both = one;
  const double sum = one.stiffness + other.stiffness;
  both.stiffness = sum > 0 ? 2 * one.stiffness * other.stiffness / sum : 0;
  both.damping = (one.damping + other.damping) / 2;
  return both;
}

}  // namespace

void read_cloth_fabrics(const KeyTable& keys, const std::string& folder, const FaceGroups& groups,
                        Scene& scene) {
  const auto tables = keys.tables("fabric");
  if (tables.empty()) return;
  ClothFabrics& all = scene.fabrics;
  ClothFabric first;
  first.name = keys.table("cloth")->text_or("fabric", "cloth");
  if (const auto self = keys.table("self_collision")) {
    first.thickness = positive(*self, "thickness");
    first.layer_friction = non_negative_or(*self, "friction", 0);
  }
  all.fabrics = {first};
  all.fabrics.front() = fabrics_of(scene).front();
  all.of_triangle.assign(scene.mesh.triangles.size(), 0);
  for (const auto& table : tables) {
    for (const int t : triangles_of(*table, groups, scene))
      all.of_triangle[size_t(t)] = int(all.fabrics.size());
    all.fabrics.push_back(fabric_of(*table, folder, scene, all.fabrics.front()));
  }
  const Eigen::VectorXd areas = rest_areas(scene.mesh);
  for (size_t k = 0; k < all.fabrics.size(); ++k) {
    double area = 0;
    for (size_t t = 0; t < all.of_triangle.size(); ++t)
      if (all.of_triangle[t] == int(k)) area += areas[Eigen::Index(t)];
    if (k > 0 && !(area > 0))
      throw InputError(tables[k - 1]->where() +
                       ": later tables [[fabric]] name all triangles of this one");
  }
}

std::vector<ClothFabric> fabrics_of(const Scene& scene) {
  std::vector<ClothFabric> all = scene.fabrics.fabrics;
  if (all.empty()) all.emplace_back();
  ClothFabric& first = all.front();
  first.density = scene.density;
  first.stretch = scene.stretch.value_or(StretchMaterial{});
  first.bending = scene.bending.value_or(BendingMaterial{});
  first.membrane = scene.membrane.value_or(MembraneMaterial{});
  first.stretch_directions = scene.stretch_directions;
  first.bending_directions = scene.bending_directions;
  first.limits = scene.strain_limits.value_or(StrainLimits{});
  return all;
}

std::vector<double> densities_of(const Scene& scene) {
  const std::vector<ClothFabric> fabrics = fabrics_of(scene);
  std::vector<double> densities(scene.mesh.triangles.size(), scene.density);
  for (size_t t = 0; t < scene.fabrics.of_triangle.size(); ++t)
    densities[t] = fabrics[size_t(scene.fabrics.of_triangle[t])].density;
  return densities;
}

CustomForce membrane_of(const Scene& scene) {
  std::vector<MembraneMaterial> materials;
  for (const ClothFabric& fabric : fabrics_of(scene)) materials.push_back(fabric.membrane);
  return make_membrane(scene.mesh, materials, scene.fabrics.of_triangle);
}

std::vector<StrainRange> strain_ranges_of(const Scene& scene) {
  const std::vector<ClothFabric> fabrics = fabrics_of(scene);
  std::vector<StrainRange> ranges;
  if (scene.fabrics.empty()) return ranges;
  for (const Edge& edge : scene.mesh.edges) {
    constexpr double none = std::numeric_limits<double>::infinity();
    StrainRange range{none, none};
    for (const int t : edge.triangles) {
      if (t < 0) continue;
      const StrainRange& own = fabrics[size_t(scene.fabrics.of_triangle[size_t(t)])].limits;
      range = {std::min(range.extension, own.extension),
               std::min(range.compression, own.compression)};
    }
    ranges.push_back(range);
  }
  return ranges;
}

double largest_extension_of(const Scene& scene) {
  double largest = 0;
  for (const ClothFabric& fabric : fabrics_of(scene))
    largest = std::max(largest, fabric.limits.extension);
  return largest;
}

namespace {

double own_or(double own, double otherwise) { return std::isnan(own) ? otherwise : own; }

/// The mean of a fabric's value over the areas of each particle's triangles; NaN where all are.
template <class Value>
PerParticle mean_of_triangles(const Scene& scene, Value value) {
  const Eigen::VectorXd areas = rest_areas(scene.mesh);
  PerParticle sums = PerParticle::Zero(scene.x.cols()), weights = sums;
  for (size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    const double own = value(scene.fabrics.fabrics[size_t(scene.fabrics.of_triangle[t])]);
    if (std::isnan(own)) continue;
    for (const int i : scene.mesh.triangles[t]) {
      sums[i] += areas[Eigen::Index(t)] * own;
      weights[i] += areas[Eigen::Index(t)];
    }
  }
  return sums.cwiseQuotient(weights);
}

}  // namespace

PerParticle friction_of(const Scene& scene) {
  const auto has_own = [](const ClothFabric& fabric) { return !std::isnan(fabric.friction); };
  if (std::ranges::none_of(scene.fabrics.fabrics, has_own)) return {};
  return mean_of_triangles(scene, [](const ClothFabric& fabric) { return fabric.friction; });
}

LayerProperties layers_of(const Scene& scene) {
  if (scene.fabrics.empty()) return {};
  const SelfCollisionSettings& all = *scene.self_collision;
  return {mean_of_triangles(
              scene, [&](const ClothFabric& of) { return own_or(of.thickness, all.thickness); }),
          mean_of_triangles(scene, [&](const ClothFabric& of) {
            return own_or(of.layer_friction, all.friction);
          })};
}

PerParticle masses_of(const Scene& scene) { return lumped_masses(scene.mesh, densities_of(scene)); }

namespace {

/// Its place in fabrics_of.
size_t fabric_of_triangle(const Scene& scene, int t) {
  return scene.fabrics.empty() ? 0 : size_t(scene.fabrics.of_triangle[size_t(t)]);
}

/// The factor of an edge's spring or hinge in each of its two triangles. turn: angle from the edge
/// to the direction of its resistance [rad].
std::vector<std::array<double, 2>> factors_of_edges(const Scene& scene,
                                                    ByDirection ClothFabric::*directions,
                                                    double turn) {
  const std::vector<ClothFabric> fabrics = fabrics_of(scene);
  std::vector<std::array<double, 2>> factors(scene.mesh.edges.size(), {1, 1});
  const bool is_uniform = std::ranges::all_of(
      fabrics, [&](const ClothFabric& fabric) { return (fabric.*directions).is_uniform(); });
  if (is_uniform) return factors;
  const std::vector<std::array<double, 2>> angles = angles_of_edges(scene.mesh);
  for (size_t e = 0; e < factors.size(); ++e)
    for (size_t side = 0; side < 2; ++side) {
      const int t = scene.mesh.edges[e].triangles[side];
      if (t < 0) continue;
      const ByDirection& by = fabrics[fabric_of_triangle(scene, t)].*directions;
      factors[e][side] = by.at(angles[e][side] + turn);
    }
  return factors;
}

}  // namespace

StretchSprings springs_of(const Scene& scene) {
  StretchSprings all = make_springs(scene.mesh, *scene.stretch);
  if (scene.fabrics.empty() && scene.mesh.pattern.empty() && scene.stretch_directions.is_uniform())
    return all;
  const std::vector<ClothFabric> fabrics = fabrics_of(scene);
  const std::vector<std::array<EdgeSide, 2>> sides = edge_sides(scene.mesh);
  const auto factors = factors_of_edges(scene, &ClothFabric::stretch_directions, 0);
  for (size_t e = 0; e < sides.size(); ++e) {
    double stiffness = 0, damping = 0, pull = 0;  // pull: tension at the length 0 [N]
    for (size_t k = 0; k < 2; ++k) {
      const EdgeSide& side = sides[e][k];
      if (side.triangle < 0) continue;
      const StretchMaterial& material = fabrics[fabric_of_triangle(scene, side.triangle)].stretch;
      const double shape = side.area / (side.length * side.length);
      stiffness += factors[e][k] * material.stiffness * shape;
      damping += material.damping * shape;
      pull += factors[e][k] * material.stiffness * shape * side.length;
    }
    Spring& spring = all.springs[e];
    spring.stiffness = stiffness;
    spring.damping = damping;
    if (sides[e][0].length != sides[e][1].length && sides[e][1].triangle >= 0 && stiffness > 0)
      spring.rest_length = scene.stretch->rest_length_scale * pull / stiffness;
  }
  return all;
}

std::vector<Bending> bending_of(const Scene& scene) {
  Bending all = make_bending(scene.mesh, *scene.bending, scene.rest_angles);
  const auto factors = factors_of_edges(scene, &ClothFabric::bending_directions, pi / 2);
  for (size_t h = 0; h < scene.mesh.hinges.size(); ++h) {
    const auto& [one, other] = factors[size_t(scene.mesh.hinges[h].edge)];
    all.hinges[h].rest_weight *= (one + other) / 2;
  }
  if (scene.fabrics.empty()) return {all};
  const std::vector<ClothFabric> fabrics = fabrics_of(scene);
  std::map<std::pair<size_t, size_t>, Bending> parts;  // of pairs of fabrics
  for (size_t h = 0; h < scene.mesh.hinges.size(); ++h) {
    const Edge& edge = scene.mesh.edges[size_t(scene.mesh.hinges[h].edge)];
    const std::pair<size_t, size_t> pair =
        std::minmax({fabric_of_triangle(scene, edge.triangles[0]),
                     fabric_of_triangle(scene, edge.triangles[1])});
    Bending& part = parts[pair];
    if (part.hinges.empty())
      part.material = pair.first == pair.second
                          ? fabrics[pair.first].bending
                          : between(fabrics[pair.first].bending, fabrics[pair.second].bending);
    part.hinges.push_back(all.hinges[h]);
  }
  std::vector<Bending> forces;
  for (auto& [pair, part] : parts) forces.push_back(std::move(part));
  return forces;
}

}  // namespace foldproof
