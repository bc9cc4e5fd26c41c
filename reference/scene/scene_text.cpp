// A scene, and the system built from it, in words.
#include <cstdio>
#include <set>

#include "reference/scene/scene.h"

namespace foldproof {

namespace {

std::string describe(const BendingMaterial& material) {
  return std::string(material.weighting == Weighting::rest ? "rest" : "current") +
         " weighting, law '" + std::string(material.law) + "'" +
         (material.damping > 0 ? ", damped" : "");
}

std::string describe(const SceneObject& part) {
  char friction[40];
  std::snprintf(friction, sizeof friction, "%.6g", part.object.friction);
  const std::string frames =
      part.animation ? ", " + std::to_string(part.animation->times.size()) + " level sets" : "";
  return "object '" + part.object.name + "' (" + part.shape + frames + ", friction " + friction +
         ")";
}

std::string describe(const StickyPatch& patch) {
  return "sticky '" + patch.name + "' (" + std::to_string(patch.triangles.size()) +
         " triangles of " + (patch.place ? "an object" : "the cloth") + ", " +
         std::to_string(patch.particles.size()) + " particles that may stick)";
}

std::string describe(const StrainLimiter& limiter) {
  const StrainLimits& limits = limiter.limits;
  char range[80];
  std::snprintf(range, sizeof range, "%.6g to %.6g", 1 - limits.compression, 1 + limits.extension);
  const std::string colours = limits.order == SweepOrder::coloured
                                  ? " in " + std::to_string(limiter.colours.size() - 1) + " colours"
                                  : "";
  return std::to_string(limiter.springs.size()) + " springs" + colours + " limited to " + range +
         " of their rest lengths, in at most " + std::to_string(limits.sweeps) + " sweeps";
}

std::string describe(const ObjectCollision& collision) {
  return std::to_string(collision.points.size()) + " points held out of objects, response '" +
         std::string(collision.response.name) + "'";
}

std::string describe(const SelfCollision& self) {
  char numbers[80];
  std::snprintf(numbers, sizeof numbers, "self-collision (thickness %.6g m, friction %.6g)",
                self.settings.thickness, self.settings.friction);
  return numbers + (self.at_start.empty()
                        ? ""
                        : ", which starts crossing itself: " + list_triangles(self.at_start));
}

/// "1 hinge", "5 hinges".
std::string count_text(size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

/// "2 vertices split into 5 particles".
std::string described_split(const std::vector<int>& copy_of) {
  std::set<int> split;
  size_t copies = 0;
  for (int i = 0; i < int(copy_of.size()); ++i) {
    if (copy_of[size_t(i)] == i) continue;
    split.insert(copy_of[size_t(i)]);
    ++copies;
  }
  return std::to_string(split.size()) + (split.size() == 1 ? " vertex" : " vertices") +
         " split into " + std::to_string(split.size() + copies) + " particles";
}

}  // namespace

std::vector<std::string> describe_parts(const Scene& scene, const System& system) {
  std::vector<std::string> parts = {count_text(size_t(scene.mesh.particles()), "particle") + ", " +
                                    count_text(scene.mesh.triangles.size(), "triangle")};
  if (!scene.copy_of.empty()) parts.push_back(described_split(scene.copy_of));
  for (const Force& force : system.forces) {
    if (std::holds_alternative<Gravity>(force)) parts.push_back("gravity");
    if (const auto* springs = std::get_if<StretchSprings>(&force))
      parts.push_back(count_text(springs->springs.size(), "spring") +
                      (scene.stretch->damping > 0 ? ", damped" : ""));
    if (const auto* bending = std::get_if<Bending>(&force))
      parts.push_back(count_text(bending->hinges.size(), "hinge") + ", " +
                      describe(bending->material));
  }
  if (scene.membrane) parts.push_back("a membrane");
  if (!scene.fabrics.empty()) parts.push_back(count_text(scene.fabrics.fabrics.size(), "fabric"));
  if (scene.air) parts.push_back(scene.air->wind.isZero(0) ? "still air" : "wind");
  if (!system.prescribed.empty())
    parts.push_back(count_text(system.prescribed.size(), "particle") + " with prescribed motion");
  for (const SceneObject& part : scene.objects) parts.push_back(describe(part));
  for (const StickyPatch& patch : scene.sticky) parts.push_back(describe(patch));
  for (const Filter& filter : system.filters)
    if (const auto* limiter = std::get_if<StrainLimiter>(&filter))
      parts.push_back(describe(*limiter));
  for (const Filter& filter : system.filters)
    if (const auto* collision = std::get_if<ObjectCollision>(&filter))
      parts.push_back(describe(*collision));
  for (const Filter& filter : system.filters)
    if (const auto* self = std::get_if<SelfCollision>(&filter)) parts.push_back(describe(*self));
  return parts;
}

}  // namespace foldproof
