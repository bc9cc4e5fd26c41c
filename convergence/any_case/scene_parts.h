// The parts that a scene names, or could name, one by one.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "reference/scene/scene.h"

namespace foldproof {

/// A part of a scene, and the same scene with it toggled.
struct ScenePart {
  std::string name;
  bool is_present;
  std::function<Scene(Scene)> toggled;  // without the part where it is present, else with it
};

/// All parts that the scene has: gravity, springs, bending, their damping, rest angles, held particles,
/// objects, their friction, points between particles, strain limits, self-collision, sticky patches. And
/// those that it lacks and whose numbers can be said without its author: strain limits of 10 % extension and
/// 0 % compression (Provot 1995), collision points on edges and triangles, self-collision with a thickness of
/// a quarter of the least height of a triangle, without stiffness or friction. Springs take their strain
/// limits with them, and a part its damping.
std::vector<ScenePart> parts_of(const Scene& scene);

}  // namespace foldproof
