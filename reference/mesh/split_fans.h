// Vertices that connect parts of a mesh in a single point: each fan of triangles gets
// its own vertex.
#pragma once

#include <vector>

#include "reference/mesh/triangle_soup.h"

namespace foldproof {

/// Fraction of the way from a split vertex to the middle of its fan: separates fans that touched in
/// a point, so that self-collision can start from them.
constexpr double split_share = 1e-3;

struct SplitMesh {
  TriangleMesh mesh;         // N' >= N particles
  std::vector<int> copy_of;  // N': the vertex of the soup behind each particle or copy
};

/// Splits every vertex whose triangles form more than one fan. The fan of its first triangle keeps
/// its number; the others get copies, numbered after the N vertices of the soup in the order of
/// their first triangles. Triangles keep their numbers. Each of those particles, the first fan's
/// too, is moved by split_share of the way to the mean of the midpoints of the sides opposite it;
/// no other vertex moves. A fan all around a vertex of a flat sheet stays where it is. Throws
/// InputError for anything that make_triangle_mesh refuses, except several fans. An edge of three
/// triangles is not split: nothing tells which two stay joined.
SplitMesh split_fans(TriangleSoup soup);

}  // namespace foldproof
