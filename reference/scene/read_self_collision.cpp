#include "reference/scene/read_self_collision.h"

#include <algorithm>
#include <cstdio>
#include <limits>

#include "reference/filters/cloth_pairs.h"
#include "reference/mesh/self_intersection.h"
#include "reference/scene/key_values.h"

namespace foldproof {

SelfCollisionSettings read_self_collision(const KeyTable& keys, const Scene& scene) {
  SelfCollisionSettings settings;
  settings.thickness = positive(keys, "thickness");
  for (const ClothFabric& fabric : scene.fabrics.fabrics)
    settings.thickness = std::max(settings.thickness, fabric.thickness);
  settings.stiffness = non_negative_or(keys, "stiffness", 0);
  settings.friction = non_negative_or(keys, "friction", 0);
  settings.rounds = int(count_or(keys, "rounds", settings.rounds));
  settings.untangle = keys.flag_or("untangle", settings.untangle);
  const double least = smallest_height(scene.mesh.triangles, scene.mesh.rest);
  if (!(settings.thickness < least / 2)) {
    char message[120];
    std::snprintf(
        message, sizeof message,
        ": 'thickness' is %.4g m; it must be less than half the least height of a triangle, %.4g m",
        settings.thickness, least / 2);
    throw InputError(keys.where("thickness") + message);
  }
  return settings;
}

void reject_touching_start(const KeyTable& keys, Scene& scene) {
  const PerParticle3 x = start_state(scene).x;
  const double least = 8 * std::numeric_limits<double>::epsilon() * x.cwiseAbs().maxCoeff();
  const std::vector<FeaturePair> touching = touching_pairs(make_cloth_tree(scene.mesh), x, least);
  if (touching.empty()) return;
  const auto [a, b, c, d] = touching.front().particles;
  char message[400];
  std::snprintf(message, sizeof message,
                ": layers of the cloth touch at the start, %zu pairs of features, the first at "
                "particles %d, %d, %d and %d: nearer than %.2g m, a few roundings of their places, "
                "nothing tells which lies on which side; start them farther apart, best by the "
                "thickness, or sew them by 'seams'",
                touching.size(), a, b, c, d, least);
  const size_t crossing = self_intersections(x, scene.mesh.triangles).size();
  if (crossing == 0) throw InputError(keys.where() + message);
  if (touching.size() > crossing) scene.warnings.push_back(keys.where() + message);
}

void reject_tangled_start(const KeyTable& keys, const Scene& scene) {
  if (scene.self_collision->untangle) return;
  const CrossingTriangles crossing = self_intersections(start_state(scene).x, scene.mesh.triangles);
  if (!crossing.empty())
    throw InputError(keys.where("untangle") + ": the cloth crosses itself at the start, in " +
                     list_triangles(crossing) +
                     "; with untangle = true it is run and pushed apart");
}

}  // namespace foldproof
