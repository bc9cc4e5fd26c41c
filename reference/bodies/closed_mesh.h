// What a mesh must be to part inside from outside, and where it is not.
#pragma once

#include <vector>

#include "reference/mesh/triangle_mesh.h"
#include "reference/mesh/triangle_soup.h"

namespace foldproof {

/// The piece of surface that each triangle belongs to, pieces hanging together by edges: M numbers
/// from 0, in the order of the pieces' first triangles.
std::vector<int> pieces_of(const TriangleMesh& mesh);

/// The volume that the triangles enclose, positive where normals point outward [m^3].
double enclosed_volume(const PerParticle3& x, const std::vector<Triangle>& triangles);

/// The mesh of a solid: each point of space is inside once or not at all. It may be of several
/// pieces, one beside or within the other, those around a cavity with their normals into it.
/// Refuses (InputError that names file and line, or triangle, the place, and how many there are):
/// all that make_triangle_mesh refuses, neighbours of opposite orientation (flipped triangles)
/// among it; holes; triangles that intersect; pieces that are inside out.
TriangleMesh make_closed_mesh(TriangleSoup soup);

}  // namespace foldproof
