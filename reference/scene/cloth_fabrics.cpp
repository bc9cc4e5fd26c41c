#include "reference/scene/cloth_fabrics.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "reference/scene/fabrics.h"
#include "reference/scene/key_values.h"
#include "reference/scene/read_region.h"
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

/// The fabric of a table; what it leaves out is as in `base`.
ClothFabric fabric_of(const KeyTable& keys, const std::string& folder, const Scene& scene,
                      const ClothFabric& base) {
  ClothFabric fabric = base;
  fabric.name = keys.text_or("name", keys.text_or("group", keys.text_or("fabric", "")));
  if (keys.has("fabric")) {
    const std::filesystem::path file = keys.text_or("fabrics", "fabrics.toml");
    const std::string path =
        (file.is_absolute() ? file : std::filesystem::path(folder) / file).string();
    const Fabric measured =
        fabric_named(read_fabrics(path), keys.text("fabric"), keys.where("fabric"));
    fabric.density = measured.density;
    if (scene.bending) fabric.bending.stiffness = fabric_on_mesh(measured, scene.mesh).stiffness;
  }
  fabric.density = positive_or(keys, "density", fabric.density);
  if (const auto stretch = keys.table("stretch")) {
    if (!scene.stretch)
      throw InputError(stretch->where() + ": a fabric's stretch needs the table [stretch]");
    fabric.stretch.stiffness = non_negative_or(*stretch, "stiffness", fabric.stretch.stiffness);
    fabric.stretch.damping = non_negative_or(*stretch, "damping", fabric.stretch.damping);
  }
  if (const auto bending = keys.table("bending")) {
    if (!scene.bending)
      throw InputError(bending->where() + ": a fabric's bending needs the table [bending]");
    fabric.bending.stiffness = non_negative_or(*bending, "stiffness", fabric.bending.stiffness);
    fabric.bending.damping = non_negative_or(*bending, "damping", fabric.bending.damping);
  }
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
  all.fabrics = {{"cloth", scene.density, scene.stretch.value_or(StretchMaterial{}),
                  scene.bending.value_or(BendingMaterial{})}};
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

std::vector<double> densities_of(const Scene& scene) {
  std::vector<double> densities(scene.mesh.triangles.size(), scene.density);
  for (size_t t = 0; t < scene.fabrics.of_triangle.size(); ++t)
    densities[t] = scene.fabrics.fabrics[size_t(scene.fabrics.of_triangle[t])].density;
  return densities;
}

PerParticle masses_of(const Scene& scene) { return lumped_masses(scene.mesh, densities_of(scene)); }

StretchSprings springs_of(const Scene& scene) {
  const ClothFabrics& cloth = scene.fabrics;
  StretchSprings all = make_springs(scene.mesh, *scene.stretch);
  if (cloth.empty() && scene.mesh.pattern.empty()) return all;
  const std::vector<std::array<EdgeSide, 2>> sides = edge_sides(scene.mesh);
  for (size_t e = 0; e < sides.size(); ++e) {
    double stiffness = 0, damping = 0, pull = 0;  // pull: tension at the length 0 [N]
    for (const EdgeSide& side : sides[e]) {
      if (side.triangle < 0) continue;
      const StretchMaterial& material =
          cloth.empty() ? *scene.stretch
                        : cloth.fabrics[size_t(cloth.of_triangle[size_t(side.triangle)])].stretch;
      const double shape = side.area / (side.length * side.length);
      stiffness += material.stiffness * shape;
      damping += material.damping * shape;
      pull += material.stiffness * shape * side.length;
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
  const ClothFabrics& cloth = scene.fabrics;
  const Bending all = make_bending(scene.mesh, *scene.bending, scene.rest_angles);
  if (cloth.empty()) return {all};
  std::map<std::pair<int, int>, Bending> parts;  // of pairs of fabrics
  for (size_t h = 0; h < scene.mesh.hinges.size(); ++h) {
    const Edge& edge = scene.mesh.edges[size_t(scene.mesh.hinges[h].edge)];
    const auto pair = std::minmax({cloth.of_triangle[size_t(edge.triangles[0])],
                                   cloth.of_triangle[size_t(edge.triangles[1])]});
    Bending& part = parts[pair];
    if (part.hinges.empty())
      part.material = pair.first == pair.second
                          ? cloth.fabrics[size_t(pair.first)].bending
                          : between(cloth.fabrics[size_t(pair.first)].bending,
                                    cloth.fabrics[size_t(pair.second)].bending);
    part.hinges.push_back(all.hinges[h]);
  }
  std::vector<Bending> forces;
  for (auto& [pair, part] : parts) forces.push_back(std::move(part));
  return forces;
}

}  // namespace foldproof
