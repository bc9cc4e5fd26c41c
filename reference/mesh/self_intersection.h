// Self-intersections of a triangle mesh.
#pragma once

#include <utility>
#include <vector>

#include "reference/mesh/box_tree.h"
#include "reference/mesh/triangle_mesh.h"

namespace foldproof {

/// True if two triangles have a point in common other than the vertices and the edge that they
/// share by index. Touching counts, as does coplanar overlap. Exact, see mesh/exact_sign.h. Both
/// must have nonzero area and differ in at least one vertex.
bool intersect(const PerParticle3& x, const Triangle& s, const Triangle& t);

/// All pairs (s < t) of triangles that intersect, in ascending order. x: 3 x N [m].
std::vector<std::pair<int, int>> self_intersections(const PerParticle3& x,
                                                    const std::vector<Triangle>& triangles);

}  // namespace foldproof
