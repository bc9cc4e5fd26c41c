#include "reference/bodies/level_set_provider.h"

namespace foldproof {

LevelSetProvider computing_provider(const Team& team) {
  return {[=](const TriangleSoup& soup, const GridMethod& method, Repair repair) {
            return make_level_set(soup, method, repair, team);
          },
          [=](const MeshSequence& sequence, const OctreeSettings& settings, BetweenFrames between) {
            return std::make_shared<const DeformingBody>(
                make_deforming_body(sequence, settings, between, team));
          }};
}

std::shared_ptr<const Octree> make_octree(const LevelSetProvider& provider,
                                          const MeshSequence& mesh,
                                          const OctreeSettings& settings) {
  const auto body = provider.make_deforming_body(mesh, settings, BetweenFrames::blended);
  return {body, &body->frames.front().field};
}

}  // namespace foldproof
