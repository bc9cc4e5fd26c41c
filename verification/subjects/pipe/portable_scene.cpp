#include "verification/subjects/pipe/portable_scene.h"

#include <algorithm>

namespace foldproof {

namespace {

const PortableMaterial& material_of(const PortableScene& scene, int triangle) {
  if (scene.materials.empty()) return scene.material;
  return scene.materials[size_t(scene.material_of_triangle[size_t(triangle)])];
}

/// One behind the other.
double in_series(double one, double other) {
  return one + other > 0 ? 2 * one * other / (one + other) : 0;
}

bool any_moves(const PortableScene& scene) {
  const auto moves = [](const auto& obstacle) { return !obstacle.motion.keys.empty(); };
  return std::ranges::any_of(scene.planes, moves) || std::ranges::any_of(scene.boxes, moves) ||
         std::ranges::any_of(scene.spheres, moves) || std::ranges::any_of(scene.capsules, moves) ||
         std::ranges::any_of(scene.bodies, moves);
}

}  // namespace

PortableElements elements_of(const PortableScene& scene) {
  const std::vector<std::array<EdgeSide, 2>> sides = edge_sides(scene.mesh);
  PortableElements all;
  all.edge_stiffness = all.edge_damping = Eigen::VectorXd::Zero(Eigen::Index(sides.size()));
  for (size_t e = 0; e < sides.size(); ++e)
    for (const EdgeSide& side : sides[e]) {
      if (side.triangle < 0) continue;
      const PortableMaterial& m = material_of(scene, side.triangle);
      const double shape = side.area / (side.length * side.length);
      all.edge_stiffness[Eigen::Index(e)] += m.young * shape;
      all.edge_damping[Eigen::Index(e)] += m.stretch_damping * shape;
    }
  all.hinge_rigidity = all.hinge_damping =
      Eigen::VectorXd::Zero(Eigen::Index(scene.mesh.hinges.size()));
  for (size_t h = 0; h < scene.mesh.hinges.size(); ++h) {
    const Edge& edge = scene.mesh.edges[size_t(scene.mesh.hinges[h].edge)];
    const PortableMaterial &one = material_of(scene, edge.triangles[0]),
                           &other = material_of(scene, edge.triangles[1]);
    all.hinge_rigidity[Eigen::Index(h)] = in_series(one.bending_rigidity, other.bending_rigidity);
    all.hinge_damping[Eigen::Index(h)] = (one.bending_damping + other.bending_damping) / 2;
  }
  return all;
}

std::vector<std::string> needed_by(const PortableScene& scene) {
  const auto is_damped = [](const PortableMaterial& m) { return m.stretch_damping > 0; };
  const auto rubs = [](const PortableMaterial& m) { return m.friction.has_value(); };
  const std::pair<const char*, bool> parts[] = {
      {"held", !scene.held.empty()},
      {"masses", scene.own_masses},
      {"damping", is_damped(scene.material) || std::ranges::any_of(scene.materials, is_damped)},
      {"planes", !scene.planes.empty()},
      {"boxes", !scene.boxes.empty()},
      {"spheres", !scene.spheres.empty()},
      {"capsules", !scene.capsules.empty()},
      {"bodies", !scene.bodies.empty()},
      {"deforming_bodies",
       std::ranges::any_of(scene.bodies, [](const auto& body) { return !body.times.empty(); })},
      {"self_collision", scene.thickness > 0},
      {"layer_friction", scene.layer_friction > 0},
      {"moving_held", !scene.moving_held.times.empty()},
      {"moving_obstacles", any_moves(scene)},
      {"strain_limits", scene.strain_limits.has_value()},
      {"air", scene.air.has_value()},
      {"materials", !scene.materials.empty()},
      {"membrane", !scene.warp.empty()},
      {"material_friction", std::ranges::any_of(scene.materials, rubs)}};
  std::vector<std::string> needed;
  for (const auto& [capability, is_there] : parts)
    if (is_there) needed.emplace_back(capability);
  return needed;
}

}  // namespace foldproof
