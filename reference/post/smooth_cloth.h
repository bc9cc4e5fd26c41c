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
  PerParticle share;    // N fine: of the way from the flat place to the smooth one, 0 to 1
  int rounds = 0;       // of checking the whole surface
  long pairs_left = 0;  // of triangles that intersect all the same: those of the cloth itself
};

/// Fine points start on the cloth's triangles and go all of their way to the smooth
/// surface. Where two triangles then intersect (exactly decided), their points' shares are
/// halved, and taken as 0 after ten times, until none do. Every round lessens a share, so
/// that it ends; all 0 is the cloth.
/// The surface at the end is judged, not the way there: it may pass through layers that are thinner
/// than the way to the smooth surface is long. x: 3 x N [m], of the cloth.
SmoothedCloth smooth_cloth(const ClothSmoother& smoother, const PerParticle3& x);

}  // namespace foldproof
