// Post-processing: moves cloth points inside or next to an object along its normal to the distance
// given by a depth map, so that folds survive (BMF03 section 5.3).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "reference/level_set/object.h"
#include "reference/post/depth_map.h"
#include "reference/types.h"

namespace foldproof {

/// Treatment of points inside two or more objects. The paper does not move them: moving out of one
/// object, they would go deeper into the other.
enum class PinchedPoints { left_alone, projected };

struct FoldProjection {
  std::string map;  // a name of depth_maps()
  DepthBand band;   // m
  PinchedPoints pinched;
  double tolerance;  // a point has arrived once f <= phi <= f + tolerance [m]
  int max_moves;     // of one point
};

/// Outcome for one point.
enum class ProjectionOutcome {
  // bitwise unchanged: it is farther out than tau, or already at the mapped distance
  untouched,
  moved,    // it is at the mapped distance, within the tolerance
  pinched,  // not moved, bitwise unchanged
  // left where phi came nearest to f, for instance between objects with too little clearance
  unfinished
};

struct ProjectedCloth {
  PerParticle3 x;                           // 3 x N [m]
  PerParticle before;                       // N, signed distance to the union of the objects [m]
  PerParticle after;                        // N [m]
  std::vector<ProjectionOutcome> outcomes;  // N
  long object_queries = 0;

  int count(ProjectionOutcome fate) const;
};

/// Projects the points x (3 x N [m]) of the cloth at `time` [s]. phi is the distance to the union
/// of the objects, the minimum over them. A point moves by (f + tolerance/2 - phi) N, with phi and
/// N queried again after each move, since an interpolated phi, or the phi of a union, need not
/// increase uniformly along N. Points that arrived are never on the inner side of f: a point
/// projected onto the surface is not inside, not even by rounding. Throws InputError for an invalid
/// band, tolerance or cap.
ProjectedCloth project_folds(std::span<const Object> objects, const PerParticle3& x, double time,
                             const FoldProjection& projection);

}  // namespace foldproof
