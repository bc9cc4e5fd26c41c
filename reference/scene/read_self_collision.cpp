#include "reference/scene/read_self_collision.h"

#include <cstdio>

#include "reference/mesh/self_intersection.h"
#include "reference/scene/key_values.h"

namespace foldproof {

SelfCollisionSettings read_self_collision(const KeyTable& keys, const TriangleMesh& mesh) {
  SelfCollisionSettings settings;
  settings.thickness = positive(keys, "thickness");
  settings.stiffness = non_negative_or(keys, "stiffness", 0);
  settings.friction = non_negative_or(keys, "friction", 0);
  settings.rounds = int(count_or(keys, "rounds", settings.rounds));
  settings.untangle = keys.flag_or("untangle", settings.untangle);
  const double least = smallest_height(mesh.triangles, mesh.rest);
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

void reject_tangled_start(const KeyTable& keys, const Scene& scene) {
  if (scene.self_collision->untangle) return;
  const CrossingTriangles crossing = self_intersections(start_state(scene).x, scene.mesh.triangles);
  if (!crossing.empty())
    throw InputError(keys.where("untangle") + ": the cloth crosses itself at the start, in " +
                     list_triangles(crossing) +
                     "; with untangle = true it is run and pushed apart");
}

}  // namespace foldproof
