#include "reference/scene/read_materials.h"

#include <cmath>
#include <limits>

#include "reference/mesh/pattern.h"
#include "reference/scene/key_values.h"

namespace foldproof {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// The elements of the mesh, or of its flat panels. Throws InputError at `where` if it is not flat.
std::vector<FlatElement> elements_of(const TriangleMesh& mesh, const std::string& where,
                                     decltype(flat_hinges)* elements) {
  const TriangleMesh panels = flat_panels(mesh);
  RestPlane plane;
  if (!is_flat(panels, plane))
    throw InputError(where +
                     ": the rest shape is not flat; give [cloth] pattern, which says where warp "
                     "and weft run");
  return elements(panels, plane);
}

/// Warp and weft of springs or hinges.
DirectedStiffness directed(const KeyTable& keys, const std::string& key, const TriangleMesh& mesh,
                           const StripStiffness& wanted, decltype(flat_hinges)* elements) {
  const double warp = keys.number_or("direction", 0) * radians_per_degree;
  return with_error_location(keys.where(key), [&] {
    return fit_directions(elements_of(mesh, keys.where(key), elements), wanted, warp);
  });
}

StripStiffness read_strips(const KeyTable& keys) {
  if (keys.has("stiffness"))
    throw InputError(keys.where("stiffness") + ": give 'stiffness' or 'warp', not both");
  const double warp = positive(keys, "warp");
  return {warp, positive_or(keys, "weft", warp), keys.has("bias") ? positive(keys, "bias") : none};
}

}  // namespace

Directed<StretchMaterial> read_stretch(const KeyTable& keys, const TriangleMesh& mesh,
                                       const Directed<StretchMaterial>* base,
                                       std::vector<std::string>& notes) {
  auto [material, directions] = base ? *base : Directed<StretchMaterial>{};
  if (keys.has("warp")) {
    const DirectedStiffness fit = directed(keys, "warp", mesh, read_strips(keys), flat_springs);
    material.stiffness = fit.stiffness;
    directions = fit.factor;
    notes.push_back("Springs by direction: " + fit.report + " (N/m).");
  } else if (!base || keys.has("stiffness")) {
    material.stiffness = non_negative_or(keys, "stiffness", keys.number("stiffness"));
    directions = {};
  }
  material.damping = non_negative_or(keys, "damping", material.damping);
  material.rest_length_scale = positive_or(keys, "rest_length_scale", material.rest_length_scale);
  return {material, directions};
}

namespace {

/// Reads the keys that a fabric's table does not have.
void read_bending_forms(const KeyTable& keys, BendingMaterial& material) {
  material.weighting = choice<Weighting>(
      keys, "weighting", {{"rest", Weighting::rest}, {"current", Weighting::current}});
  material.damping_factor =
      choice<DampingFactor>(keys, "damping_factor",
                            {{"edge", DampingFactor::edge},
                             {"edge_squared_over_area", DampingFactor::edge_squared_over_area}});
  std::vector<std::pair<std::string, std::string_view>> laws;
  for (const BendingLaw& law : bending_laws()) laws.emplace_back(std::string(law.name), law.name);
  material.law = choice<std::string_view>(keys, "law", laws);
}

/// The rigidities along warp and weft that the table names, or measured ones; {} if one stiffness
/// is meant.
std::optional<StripStiffness> read_rigidities(const KeyTable& keys,
                                              const std::optional<Fabric>& fabric) {
  const bool both = choice<bool>(keys, "directions", {{"first", false}, {"both", true}});
  if (!both) return keys.has("warp") ? std::optional(read_strips(keys)) : std::nullopt;
  if (keys.has("warp"))
    throw InputError(keys.where("directions") + ": give 'directions' or 'warp', not both");
  if (!fabric)
    throw InputError(keys.where("directions") +
                     ": no measured 'fabric' is named, whose directions they could be; give 'warp' "
                     "and 'weft'");
  return StripStiffness{fabric->rigidity[0], fabric->rigidity[1], none};
}

}  // namespace

Directed<BendingMaterial> read_bending(const KeyTable& keys, const TriangleMesh& mesh,
                                       const Directed<BendingMaterial>* base,
                                       const std::optional<Fabric>& fabric,
                                       std::vector<std::string>& notes) {
  auto [material, directions] = base ? *base : Directed<BendingMaterial>{};
  if (!base) read_bending_forms(keys, material);
  if (const auto wanted = read_rigidities(keys, fabric)) {
    const std::string key = keys.has("warp") ? "warp" : "directions";
    if (material.weighting == Weighting::current)
      throw InputError(keys.where(key) + ": warp and weft need weighting = \"rest\"");
    const DirectedStiffness fit = directed(keys, key, mesh, *wanted, flat_hinges);
    material.stiffness = fit.stiffness;
    directions = fit.factor;
    notes.push_back("Hinges by direction: " + fit.report + " (N m).");
  } else if (keys.has("stiffness") || (!base && !fabric)) {
    material.stiffness = non_negative_or(keys, "stiffness", keys.number("stiffness"));
    directions = {};
  } else if (fabric) {
    material.stiffness = fabric_on_mesh(*fabric, mesh).stiffness;
    directions = {};
  }
  material.damping = non_negative_or(keys, "damping", material.damping);
  return {material, directions};
}

MembraneMaterial read_membrane(const KeyTable& keys, const MembraneMaterial* base) {
  MembraneMaterial material = base ? *base : MembraneMaterial{};
  material.warp = base ? positive_or(keys, "warp", base->warp) : positive(keys, "warp");
  material.weft = positive_or(keys, "weft", base ? base->weft : material.warp);
  material.poisson = non_negative_or(keys, "poisson", material.poisson);
  material.shear =
      positive_or(keys, "shear", base ? base->shear : material.warp / (2 * (1 + material.poisson)));
  material.damping = non_negative_or(keys, "damping", material.damping);
  if (keys.has("direction")) material.direction = keys.number("direction") * radians_per_degree;
  return material;
}

Air read_air(const KeyTable& keys) {
  Air air;
  air.density = non_negative_or(keys, "density", air.density);
  air.wind = keys.vector_or("wind", air.wind);
  air.normal_drag = non_negative_or(keys, "normal_drag", air.normal_drag);
  air.tangential_drag = non_negative_or(keys, "tangential_drag", air.tangential_drag);
  return air;
}

}  // namespace foldproof
