// Triangles of a mesh that meet where they should not.
#pragma once

#include <utility>
#include <vector>

#include "reference/mesh/box_tree.h"
#include "reference/mesh/triangle_mesh.h"

namespace foldproof {

/// Do two triangles have a point in common beyond the vertices and the edge that they share by
/// number? Touching counts, and so does lying in one plane and overlapping. Exact, see
/// mesh/exact_sign.h. Both must have area and differ in a vertex.
bool intersect(const PerParticle3& x, const Triangle& s, const Triangle& t);

/// All pairs (s < t) of triangles that intersect, in rising order. x: 3 x N [m].
std::vector<std::pair<int, int>> self_intersections(const PerParticle3& x,
                                                    const std::vector<Triangle>& triangles);

}  // namespace foldproof
