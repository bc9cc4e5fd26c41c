// Closed meshes: the conditions under which a mesh separates inside from outside, and where
// it violates them.
#pragma once

#include <vector>

#include "reference/mesh/triangle_mesh.h"
#include "reference/mesh/triangle_soup.h"

namespace foldproof {

/// The connected piece (by shared edges) that each triangle belongs to: M numbers from 0, in the
/// order of the pieces' first triangles.
std::vector<int> pieces_of(const TriangleMesh& mesh);

int count_of_pieces(const TriangleMesh& mesh);

/// The volume that the triangles enclose, positive where normals point outward [m^3].
double enclosed_volume(const PerParticle3& x, const std::vector<Triangle>& triangles);

/// The mesh of a solid: each point of space is inside once or not at all. It may have several
/// pieces, side by side or nested; around a cavity the normals point into the cavity. Refuses
/// everything that make_triangle_mesh refuses, including neighbours of opposite orientation
/// (flipped triangles), and holes, triangles that intersect, and pieces that are inside out. The
/// InputError names file and line, or triangle, the place, and the count.
TriangleMesh make_closed_mesh(TriangleSoup soup);

}  // namespace foldproof
