// A smooth surface of cloth for rendering that does not cross itself where the cloth does not
// (after the collision-aware subdivision of BFA02).
#pragma once

#include "reference/mesh/subdivision.h"
#include "reference/types.h"

namespace foldproof {

/// A cloth's subdivision to be used for many frames.
struct ClothSmoother {
  Subdivision flat, smooth;  // by midpoints: the cloth itself; by Loop's rule

  /// levels: 1 to 8.
  ClothSmoother(const TriangleMesh& mesh, int levels);
};

struct SmoothedCloth {
  PerParticle3 x;       // 3 x N fine [m]
  PerParticle share;    // N fine: fraction of the way from flat to smooth, 0 to 1
  int rounds = 0;       // checks of the whole surface
  long pairs_left = 0;  // of triangles that still intersect, as in the cloth itself
};

/// Fine points start on the cloth's triangles and move all the way to the smooth surface. Where two
/// triangles then intersect (decided exactly), the shares of their points are halved, and set to 0
/// after ten halvings, until none intersect. Every round reduces a share, so it ends; all 0 is the
/// cloth.
/// Only the final surface is checked, not the motion to it, which may pass through layers closer
/// than the distance to the smooth surface. x: 3 x N [m], of the cloth.
SmoothedCloth smooth_cloth(const ClothSmoother& smoother, const PerParticle3& x);

}  // namespace foldproof
