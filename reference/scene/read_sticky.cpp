#include "reference/scene/read_sticky.h"

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <utility>

#include "reference/mesh/mesh_file.h"
#include "reference/scene/key_values.h"
#include "reference/scene/read_region.h"
#include "reference/scene/read_cloth_mesh.h"
#include "reference/scene/refine_cloth.h"

namespace foldproof {

namespace {

/// The triangles from which a sticky patch is selected.
struct StickySheet {
  const PerParticle3& x;  // of the corners at the start [m]
  const std::vector<Triangle>& triangles;
  std::function<FaceGroups()> groups;  // of its OBJ file; empty if it has none
  int parts = 1;                       // of each triangle that a list or a group names
};

/// Groups of the OBJ file that the table's key `mesh` names.
std::function<FaceGroups()> groups_of(const std::shared_ptr<KeyTable>& keys,
                                      const std::string& folder, const std::string& table) {
  if (!keys->has("mesh")) return {};
  return [=] { return read_mesh_file(mesh_file(*keys, folder, table)).groups; };
}

/// Numbers of the triangles into which the listed ones were divided.
std::vector<int> divided(const std::vector<int>& triangles, int parts) {
  std::vector<int> all;
  for (const int t : triangles)
    for (int part = 0; part < parts; ++part) all.push_back(t * parts + part);
  return all;
}

std::vector<int> triangles_of_group(const KeyTable& keys, const StickySheet& sheet) {
  const std::string name = keys.text("group");
  if (!sheet.groups)
    throw InputError(keys.where("group") +
                     ": 'group' names a group of an OBJ file; this is made without one");
  const FaceGroups groups = sheet.groups();
  const auto found = groups.find(name);
  if (found != groups.end()) return divided(found->second, sheet.parts);
  std::string known;
  for (const auto& [other, triangles] : groups) known += (known.empty() ? "" : ", ") + other;
  throw InputError(keys.where("group") + ": there is no group '" + name +
                   "'; known: " + (known.empty() ? "none" : known));
}

/// Items selected by a table: by their positions x, or of a group by of_group; all if it selects
/// none. parts: number of items per number of a list.
std::vector<int> read_region(const KeyTable& keys, const std::string& list, int parts,
                             const PerParticle3& x,
                             const std::function<std::vector<int>()>& of_group) {
  const bool is_list = keys.has(list), is_box = keys.has("box"), is_sphere = keys.has("sphere"),
             is_group = keys.has("group");
  if (int(is_list) + int(is_box) + int(is_sphere) + int(is_group) > 1)
    throw InputError(keys.where() + ": give one of '" + list +
                     "', 'box', 'sphere', 'group', or none for all");
  std::vector<int> chosen;
  if (is_list) chosen = divided(numbered(keys, list, x.cols() / parts), parts);
  if (is_box) chosen = select_in_box(keys, x);
  if (is_sphere) chosen = select_in_sphere(keys, x);
  if (is_group) chosen = of_group();
  if (!is_list && !is_box && !is_sphere && !is_group)
    for (int i = 0; i < int(x.cols()); ++i) chosen.push_back(i);
  if (chosen.empty()) throw InputError(keys.where() + ": no " + list + " are there");
  std::ranges::sort(chosen);
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  return chosen;
}

std::vector<Triangle> read_triangles(const KeyTable& keys, const StickySheet& sheet) {
  PerParticle3 centres(3, sheet.triangles.size());
  for (size_t t = 0; t < sheet.triangles.size(); ++t) {
    const auto [a, b, c] = sheet.triangles[t];
    centres.col(Eigen::Index(t)) = (sheet.x.col(a) + sheet.x.col(b) + sheet.x.col(c)) / 3;
  }
  std::vector<Triangle> chosen;
  for (const int t : read_region(keys, "triangles", sheet.parts, centres,
                                 [&] { return triangles_of_group(keys, sheet); }))
    chosen.push_back(sheet.triangles[size_t(t)]);
  return chosen;
}

std::vector<int> read_particles(const KeyTable& keys, const StickySheet& cloth,
                                const std::vector<int>& copy_of) {
  std::vector<int> chosen = read_region(keys, "particles", 1, cloth.x, [&] {
    std::vector<int> corners;
    for (const int t : triangles_of_group(keys, cloth))
      for (const int corner : cloth.triangles[size_t(t)]) corners.push_back(corner);
    return corners;
  });
  if (keys.has("particles")) chosen = with_copies(std::move(chosen), copy_of);
  std::ranges::sort(chosen);
  return chosen;
}

/// Lets an object carry the patch; keeps only the vertices that the patch uses.
void carry(StickyPatch& patch, const SceneObject& by) {
  std::map<int, int> place_of;  // new number of a used vertex
  for (Triangle& triangle : patch.triangles)
    for (int& corner : triangle)
      corner = place_of.try_emplace(corner, int(place_of.size())).first->second;
  auto part = std::make_shared<SceneObject>(by);
  PerParticle3 kept(3, place_of.size());
  for (const auto& [vertex, place] : place_of) kept.col(place) = by.vertices.col(vertex);
  part->vertices = kept;
  if (by.animation) {
    auto animation = std::make_shared<MeshSequence>(MeshSequence{{}, by.animation->times, {}});
    for (const PerParticle3& x : by.animation->positions) {
      for (const auto& [vertex, place] : place_of) kept.col(place) = x.col(vertex);
      animation->positions.push_back(kept);
    }
    part->animation = std::move(animation);
  }
  patch.place = [part](double t) { return surface_at(*part, t); };
  patch.velocity = [part](double t) { return surface_velocity_at(*part, t); };
}

void read_surface(const KeyTable& keys, const KeyTable& case_keys, const std::string& folder,
                  const Scene& scene, const StickySheet& cloth, StickyPatch& patch) {
  const std::string of = keys.text("of");
  if (of == "cloth") {
    patch.triangles = read_triangles(keys, cloth);
    return;
  }
  std::string known = "cloth";
  const auto tables = case_keys.tables("object");
  for (size_t k = 0; k < scene.objects.size(); ++k) {
    const SceneObject& part = scene.objects[k];
    known += ", " + part.object.name;
    if (part.object.name != of) continue;
    const PerParticle3 x = surface_at(part, 0);
    patch.triangles =
        read_triangles(keys, {x, part.triangles, groups_of(tables[k], folder, "object")});
    return carry(patch, part);
  }
  throw InputError(keys.where("of") + ": there is nothing named '" + of +
                   "' to stick to; known: " + known);
}

StickyPatch read_patch(const KeyTable& keys, const KeyTable& case_keys, const std::string& folder,
                       const Scene& scene) {
  const auto cloth_keys = case_keys.table("cloth");
  const StickySheet cloth{scene.x, scene.mesh.triangles, groups_of(cloth_keys, folder, "cloth"),
                          1 << (2 * refinements_of(*cloth_keys))};
  const auto surface = keys.table("surface"), particles = keys.table("particles");
  if (!surface || !particles)
    throw InputError(keys.where() +
                     ": [[sticky]] needs 'surface', what is sticky, and 'particles', what sticks");
  StickyPatch patch;
  read_surface(*surface, case_keys, folder, scene, cloth, patch);
  patch.particles = read_particles(*particles, cloth, scene.copy_of);
  patch.name =
      keys.text_or("name", surface->text("of") + " " + std::to_string(scene.sticky.size() + 1));
  patch.stiffness = positive(keys, "stiffness");
  patch.forecast_time = non_negative_or(keys, "forecast_time", keys.number("forecast_time"));
  patch.near = positive(keys, "near");
  patch.far = positive(keys, "far");
  patch.from = non_negative_or(keys, "from", 0);
  patch.until = keys.number_or("until", patch.until);
  patch.release = non_negative_or(keys, "release", 0);
  if (!(patch.until > patch.from))
    throw InputError(keys.where("until") + ": 'until' must be later than 'from', in s");
  if (!(patch.release <= patch.until - patch.from))
    throw InputError(keys.where("release") +
                     ": 'release' must not be longer than the time from 'from' to 'until'");
  return patch;
}

}  // namespace

void read_sticky(const KeyTable& case_keys, const std::string& folder, Scene& scene) {
  for (const auto& keys : case_keys.tables("sticky"))
    scene.sticky.push_back(read_patch(*keys, case_keys, folder, scene));
}

}  // namespace foldproof
