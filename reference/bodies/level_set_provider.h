// Who makes the level sets of a case's bodies: the functions of this folder, or one that keeps
// what they made.
#pragma once

#include <functional>
#include <memory>

#include "reference/level_set/deforming.h"
#include "reference/bodies/repair.h"

namespace foldproof {

/// Each answers what the function of its name makes of the same arguments, bit for bit, and throws
/// what that throws.
struct LevelSetProvider {
  std::function<std::shared_ptr<const Grid>(const TriangleSoup&, const GridMethod&, Repair)>
      make_level_set;
  std::function<std::shared_ptr<const DeformingBody>(const MeshSequence&, const OctreeSettings&,
                                                     BetweenFrames)>
      make_deforming_body;
};

/// Those that compute whatever they are asked for.
LevelSetProvider computing_provider();

/// Those that ask `provider` once for the same thing, and hand out what they made to all who ask
/// again, in any thread. They and their copies share what they keep, as long as one of them lives.
LevelSetProvider memoizing_provider(const LevelSetProvider& provider);

/// The octree of one mesh: that of an animation of one frame.
std::shared_ptr<const Octree> make_octree(const LevelSetProvider& provider, const PerParticle3& x,
                                          const std::vector<Triangle>& triangles,
                                          const OctreeSettings& settings);

}  // namespace foldproof
