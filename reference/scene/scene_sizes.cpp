#include "reference/scene/scene_sizes.h"

#include <cmath>
#include <sstream>

#include "reference/bodies/closed_mesh.h"
#include "reference/dynamics/integrator.h"
#include "reference/forces/degenerate.h"
#include "reference/mesh/box_tree.h"
#include "reference/mesh/pattern.h"
#include "reference/mesh/rigidity_map.h"
#include "reference/mesh/seams.h"
#include "reference/mesh/self_intersection.h"

namespace foldproof {

namespace {

constexpr double longest_cloth = 20, shortest_cloth = 0.005;  // m
constexpr double heaviest = 5, lightest = 0.01;               // kg/m^2
constexpr double other_unit = 7;  // of two lengths: beyond it, one may be in another unit [1]

std::string digits(double value) {
  std::ostringstream text;
  text.precision(3);
  text << value;
  return text.str();
}

double length_of(const PerParticle3& x) { return bounds_of(x).sizes().maxCoeff(); }

std::string extent_of(const PerParticle3& x) {
  Vector3 size = bounds_of(x).sizes();
  size = (size.array() < 1e-9 * size.maxCoeff()).select(0, size);  // rounding of a flat cloth
  return digits(size.x()) + " x " + digits(size.y()) + " x " + digits(size.z()) + " m";
}

/// The factor that brings a length nearest to another, of those between m, cm and mm.
std::string likely_scale(double length, double other) {
  const double decades = std::clamp(std::round(std::log10(other / length)), -3.0, 3.0);
  return digits(std::pow(10, decades));
}

void warn_of_bodies(const std::string& where, Scene& scene) {
  const double cloth = length_of(scene.x);
  for (const SceneObject& part : scene.objects) {
    if (!part.field || part.vertices.cols() == 0) continue;
    const double body = length_of(part.vertices);
    if (!(std::max(cloth / body, body / cloth) >= other_unit)) continue;
    scene.warnings.push_back(
        where + ": the cloth is " + digits(cloth) + " m long and object '" + part.object.name +
        "' " + digits(body) + " m; if a file is in another unit, give [cloth] scale = " +
        likely_scale(cloth, body) + " or [[object]] scale = " + likely_scale(body, cloth));
  }
}

}  // namespace

std::string sizes_in_words(const Scene& scene) {
  std::string words = "cloth " + extent_of(scene.x) + ", " + digits(rest_areas(scene.mesh).sum()) +
                      " m^2, " + digits(masses_of(scene).sum()) + " kg";
  if (const int pieces = count_of_pieces(scene.mesh); pieces > 1)
    words += ", in " + std::to_string(pieces) + " pieces";
  for (const SceneObject& part : scene.objects)
    if (part.field && part.vertices.cols() > 0)
      words += "; object '" + part.object.name + "' " + extent_of(part.vertices);
  return words;
}

void note_pattern(Scene& scene) {
  if (scene.mesh.pattern.empty()) return;
  const PatternFacts facts = facts_of_pattern(scene.mesh, scene.x);
  const auto percent = [](double share) { return digits(100 * share) + " %"; };
  scene.notes.push_back(
      "pattern: " + std::to_string(facts.panels) + " panels, " + digits(facts.area) + " m^2; " +
      (facts.seams > 0 ? "seams of " + digits(facts.seams) + " m, whose sides differ by at most " +
                             percent(facts.ease < 1e-6 ? 0 : facts.ease)
                       : "no seams") +
      "; edges start at " + percent(facts.least) + " to " + percent(facts.greatest) +
      " of their rest lengths");
}

void note_scales(const KeyTable& keys, double of_cloth, Scene& scene) {
  const auto note = [&](const std::string& name, const KeyTable& part, double scale) {
    if (part.has("fit") && digits(scale) != "1")
      scene.notes.push_back(name + ": fit = " + digits(part.number("fit")) +
                            " m scales the mesh by " + digits(scale));
  };
  const KeyTable& cloth = *keys.table("cloth");
  note("cloth", cloth, of_cloth);
  for (size_t k = 0; k < scene.objects.size(); ++k) {
    const KeyTable& object = *keys.tables("object")[k];
    const std::string name = "object '" + scene.objects[k].object.name + "'";
    const double scale = scene.objects[k].scale;
    note(name, object, scale);
    const auto is_typed = [&](const char* key) {
      return is_override(cloth.where(key)) || is_override(object.where(key));
    };
    const bool are_meshes =
        cloth.has("mesh") && !object.has("shape") && (cloth.has("fit") || object.has("fit"));
    if (!are_meshes || !(is_typed("mesh") || is_typed("frames")) || is_typed("fit")) continue;
    if (std::abs(scale - of_cloth) <= 1e-6 * scale) continue;
    const bool fits_object = object.has("fit") && digits(scale) != "1",
               fits_cloth = cloth.has("fit") && digits(of_cloth) != "1";
    if (!fits_object && !fits_cloth) continue;
    scene.warnings.push_back((fits_object ? object : cloth).where("fit") +
                             ": 'fit' scales the mesh of " + name + " by " + digits(scale) +
                             ", that of the cloth by " + digits(of_cloth) + "; --set " +
                             (fits_object ? "object" : "cloth") + ".fit= unsets it");
  }
}

void warn_of_sizes(const KeyTable& cloth, double unit, Scene& scene) {
  const double length = length_of(scene.x);
  const std::string where = cloth.where(cloth.has("mesh") ? "mesh" : "shape");
  if (length > longest_cloth || length < shortest_cloth)
    scene.warnings.push_back(where + ": the cloth is " + digits(length) +
                             " m long; if its file is in cm, give scale = 0.01, if in mm, 0.001");
  warn_of_bodies(where, scene);
  for (const ClothFabric& fabric : fabrics_of(scene)) {
    const double density = fabric.density;
    if (density <= heaviest && density >= lightest) continue;
    const std::string of = scene.fabrics.empty() ? "" : " of '" + fabric.name + "'";
    scene.warnings.push_back(cloth.where("density") + ": a density" + of + " of " +
                             digits(density) + " kg/m^2; cloth has 0.05 to 0.8" +
                             (density > heaviest
                                  ? "; " + digits(density) + " g/m^2 are " + digits(density / 1000)
                                  : ""));
  }
  if (!cloth.has("mesh") || cloth.has("seams")) return;
  TriangleMesh start = scene.mesh;
  start.rest = scene.x;
  if (const std::string words = open_seams_in_words(start, "[cloth]", unit); !words.empty())
    scene.warnings.push_back(where + ": " + words);
}

std::string warning_of_start(const Scene& scene, const State& s) {
  const std::vector<Triangle>& triangles = scene.mesh.triangles;
  const auto flat = std::ranges::count_if(
      triangles, [&](const Triangle& triangle) { return !has_area(s.x, triangle); });
  if (flat > 0)
    return std::to_string(flat) +
           " triangles of the cloth have no area at the start, so that the "
           "forces of their springs and hinges have no direction; change its places at the start";
  if (scene.self_collision) return "";
  TriangleMesh start = scene.mesh;
  start.rest = s.x;
  RestPlane plane;
  const bool lies_flat = is_flat(start, plane);
  // there the exact test finds that neighbours touch
  if (!lies_flat && !open_seams_in_words(start).empty()) return "";
  const size_t pairs = lies_flat ? overlaps_in_plane(s.x, triangles, plane.first, plane.second,
                                                     1e-6 * length_of(s.x))
                                 : self_intersections(s.x, triangles).size();
  if (pairs == 0) return "";
  return "the cloth " + std::string(lies_flat ? "lies on" : "crosses") +
         " itself at the start, in " + std::to_string(pairs) +
         " pairs of triangles, and nothing parts them; move its layers apart, or give "
         "[self_collision]";
}

std::string warning_of_step(const Scene& scene, const System& system, const State& s) {
  const double step = scene.schedule.step.fixed;
  if (!(step > 0) || integrator_named(scene.integrator).family == Family::fully_implicit) return "";
  double limit = 0;
  try {
    limit = elastic_limit(system, s);
  } catch (const DegenerateElement&) {
    return "";
  }
  if (!(step > limit)) return "";
  return "a step of " + digits(step) + " s is " + digits(step / limit) +
         " times the elastic limit here, " + digits(limit) + " s, below which " + scene.integrator +
         " is known to be stable; step = \"automatic\" keeps to it";
}

}  // namespace foldproof
