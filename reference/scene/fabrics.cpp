#include "reference/scene/fabrics.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "reference/mesh/pattern.h"
#include "reference/mesh/rigidity_map.h"
#include "reference/scene/key_file.h"
#include "reference/scene/key_values.h"

namespace foldproof {

namespace {

constexpr double of_a_hinge = 0.25;  // D/ke where the database's ke is a rigidity [1]

std::string text_of(const KeyTable& keys, const std::string& key) {
  const std::string text = keys.text(key);
  if (text.empty()) throw InputError(keys.where(key) + ": '" + key + "' is empty");
  return text;
}

/// Of the first and the second direction.
std::array<double, 2> pair_of(const KeyTable& keys, const std::string& key) {
  const auto pair = keys.table(key);
  return {positive(*pair, "first"), positive(*pair, "second")};
}

double positive_if_there(const KeyTable& keys, const char* key) {
  return keys.has(key) ? positive(keys, key) : none_measured;
}

Fabric fabric_of(const KeyTable& keys) {
  Fabric fabric{text_of(keys, "name"),
                text_of(keys, "words"),
                text_of(keys, "source"),
                text_of(keys, "place"),
                text_of(keys, "method"),
                positive(keys, "density"),
                {},
                positive_if_there(keys, "scatter"),
                keys.texts("missing"),
                positive_if_there(keys, "thickness"),
                positive_if_there(keys, "shear"),
                positive_if_there(keys, "drape")};
  if (keys.has("rigidity") == keys.has("hinge_stiffness"))
    throw InputError(keys.where("rigidity") +
                     ": a fabric has one of 'rigidity' and 'hinge_stiffness'");
  if (keys.has("rigidity")) {
    fabric.rigidity = pair_of(keys, "rigidity");
  } else {
    fabric.rigidity = pair_of(keys, "hinge_stiffness");
    for (double& B : fabric.rigidity) B *= of_a_hinge;
  }
  return fabric;
}

/// The median of the mean of least and greatest D/ke, and the largest ratio of the two.
struct LocalRigidity {
  double middle, anisotropy;
};

LocalRigidity local_rigidity(const TriangleMesh& mesh) {
  std::vector<double> means;
  double anisotropy = 1;
  for (const RigidityExtremes& at : rigidity_around_particles(mesh)) {
    if (!std::isfinite(at.greatest)) continue;
    means.push_back((at.least + at.greatest) / 2);
    anisotropy = std::max(anisotropy, at.anisotropy());
  }
  if (means.empty()) return {none_measured, none_measured};
  std::nth_element(means.begin(), means.begin() + long(means.size() / 2), means.end());
  return {means[means.size() / 2], anisotropy};
}

std::string in_words(const char* format, double a, double b, double c) {
  char text[200];
  std::snprintf(text, sizeof text, format, a, b, c);
  return text;
}

std::string report_of(const Fabric& fabric, const FabricOnMesh& on) {
  std::string text = "Fabric '" + fabric.name + "': ";
  text += in_words(
      "B = %.3g N m along its first direction and B/ke = %.4g of a strip of this mesh give ke = "
      "%.4g J. ",
      fabric.rigidity[0], on.rigidity_ratio, on.stiffness);
  if (std::isfinite(on.second_over_first))
    text += in_words(
        "Along the second direction the fabric is %.3g times as stiff, this mesh %.3g times; its "
        "stiffest direction is %.3g times its softest.",
        fabric.rigidity[1] / fabric.rigidity[0], on.second_over_first, on.anisotropy);
  else
    text += in_words(
        "Along the second direction the fabric is %.3g times as stiff; the mesh is not flat, and "
        "around single particles its stiffest direction is up to %.3g times its softest.",
        fabric.rigidity[1] / fabric.rigidity[0], on.anisotropy, 0);
  return text;
}

}  // namespace

std::vector<Fabric> read_fabrics(const std::string& path) {
  const auto root = parse_keys(read_text(path), path);
  std::vector<Fabric> fabrics;
  for (const auto& keys : root->tables("fabric")) {
    fabrics.push_back(fabric_of(*keys));
    const std::string& name = fabrics.back().name;
    if (std::count_if(fabrics.begin(), fabrics.end(),
                      [&](const Fabric& other) { return other.name == name; }) > 1)
      throw InputError(keys->where("name") + ": the fabric '" + name + "' is there already");
  }
  if (fabrics.empty()) throw InputError(path + ": there is no [[fabric]]");
  root->reject_unused();
  return fabrics;
}

const Fabric& fabric_named(const std::vector<Fabric>& fabrics, const std::string& name,
                           const std::string& where) {
  std::string known;
  for (const Fabric& fabric : fabrics) {
    if (fabric.name == name) return fabric;
    known += (known.empty() ? "" : ", ") + fabric.name;
  }
  throw InputError(where + ": unknown fabric '" + name + "'; known: " + known);
}

FabricOnMesh fabric_on_mesh(const Fabric& fabric, const TriangleMesh& cloth) {
  const TriangleMesh mesh = flat_panels(cloth);
  FabricOnMesh on{none_measured, none_measured, none_measured, none_measured, ""};
  RestPlane plane;
  if (is_flat(mesh, plane)) {
    const Rigidity rigidity = rigidity_of(mesh, plane);
    on.rigidity_ratio = rigidity.of_strip(0);
    on.anisotropy = extremes_of(rigidity).anisotropy();
    on.second_over_first = rigidity.of_strip(std::numbers::pi / 2) / on.rigidity_ratio;
  } else {
    const LocalRigidity local = local_rigidity(mesh);
    on.rigidity_ratio = local.middle;
    on.anisotropy = local.anisotropy;
  }
  if (!(on.rigidity_ratio > 0))
    throw InputError("fabric '" + fabric.name + "': the cloth has too few hinges to bend");
  on.stiffness = fabric.rigidity[0] / on.rigidity_ratio;
  on.report = report_of(fabric, on);
  return on;
}

}  // namespace foldproof
