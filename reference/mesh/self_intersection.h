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

/// How many pairs of triangles overlap in the plane of these directions (perpendicular, of length
/// 1), by more than `least` [m] along the normal of every side. In doubles, for flat meshes: the
/// exact test takes a hundred times as long on coplanar triangles. x: 3 x N [m].
std::size_t overlaps_in_plane(const PerParticle3& x, const std::vector<Triangle>& triangles,
                              const Vector3& first, const Vector3& second, double least);

}  // namespace foldproof
