#include "reference/bodies/makers.h"

namespace foldproof {

LevelSetMakers computing_makers() {
  return {make_level_set,
          [](const MeshSequence& sequence, const OctreeSettings& settings, BetweenFrames between) {
            return std::make_shared<const DeformingBody>(make_deforming_body(sequence, settings, between));
          }};
}

std::shared_ptr<const Octree> make_octree(const LevelSetMakers& makers, const PerParticle3& x,
                                          const std::vector<Triangle>& triangles,
                                          const OctreeSettings& settings) {
  const auto body = makers.make_deforming_body({triangles, {0}, {x}}, settings, BetweenFrames::blended);
  return {body, &body->frames.front().field};
}

}  // namespace foldproof
