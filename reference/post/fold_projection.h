// After the simulation: points of the cloth that are inside an object, or next to it, are moved
// along its normal to where a depth map wants them, so that folds survive (BMF03 section 5.3).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "reference/level_set/object.h"
#include "reference/post/depth_map.h"
#include "reference/types.h"

namespace foldproof {

/// What becomes of points inside two or more objects. The paper leaves them alone: on their way out
/// of one object they would go deeper into the other.
enum class PinchedPoints { left_alone, projected };

struct FoldProjection {
  std::string map;  // a name of depth_maps()
  DepthBand band;   // m
  PinchedPoints pinched;
  double tolerance;  // a point has arrived once f <= phi <= f + tolerance [m]
  int max_moves;     // of one point
};

/// What became of a point.
enum class ProjectionOutcome {
  // not a bit of it changed: it is farther out than tau, or as far out as the map wants it
  untouched,
  moved,    // it is where the map wants it, to the tolerance
  pinched,  // left alone, not a bit of it changed
  // left at the place met on its way whose phi was nearest to f, as between objects that
  // leave it no room
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

/// Projects the points x (3 x N [m]) of the cloth at `time` [s]. phi is that of the union of
/// the objects, the min over them. A point moves by (f + tolerance/2 - phi) N, with phi and N
/// asked anew after each move, since a phi that is interpolated, or the union's, need not rise
/// evenly along N. Arrived points are never on the inner side of f: what is brought to the
/// surface is not inside, not even by a rounding. Throws InputError for a band, a tolerance or
/// a cap that means nothing.
ProjectedCloth project_folds(std::span<const Object> objects, const PerParticle3& x, double time,
                             const FoldProjection& projection);

}  // namespace foldproof
