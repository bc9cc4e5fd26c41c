// Level sets for the bodies of a case: computed, or loaded from elsewhere.
#pragma once

#include <functional>
#include <memory>

#include "reference/fast/team.h"
#include "reference/level_set/deforming.h"
#include "reference/bodies/repair.h"

namespace foldproof {

/// Each member returns, bit for bit, the result of the function of the same name, and throws the
/// same exceptions.
struct LevelSetProvider {
  std::function<std::shared_ptr<const Grid>(const TriangleSoup&, const GridMethod&, Repair)>
      make_level_set;
  std::function<std::shared_ptr<const DeformingBody>(const MeshSequence&, const OctreeSettings&,
                                                     BetweenFrames)>
      make_deforming_body;
};

/// Computes every request; the loops run on the team.
LevelSetProvider computing_provider(const Team& team = {});

/// The octree of a sequence of one frame.
std::shared_ptr<const Octree> make_octree(const LevelSetProvider& provider,
                                          const MeshSequence& mesh, const OctreeSettings& settings);

}  // namespace foldproof
