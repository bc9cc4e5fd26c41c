// Triangles without connectivity.
#pragma once

#include <string>
#include <vector>

#include "reference/mesh/triangle_mesh.h"

namespace foldproof {

struct TriangleSoup {
  PerParticle3 rest;                // 3 x N [m]
  std::vector<Triangle> triangles;  // M, indices in range
  MeshOrigin origin;
};

/// The soup without the vertices that no triangle uses. A body needs none of them; as cloth they
/// would have no mass, and are refused.
TriangleSoup without_unused_vertices(TriangleSoup soup);

/// The numbers of a soup's triangles, ascending: a surface, and what is no part of one.
struct SortedTriangles {
  std::vector<int> sound;
  std::vector<int> without_area;  // as has_area says; two corners may be one
  std::vector<int> repeated;      // with the three corners of an earlier one, in any order
};
SortedTriangles sorted_triangles(const TriangleSoup& soup);

/// "FILE:5: a face without area, the first of 2; remove it", for both kinds; "" if all are sound.
std::string flaws_in_words(const SortedTriangles& sorted, const MeshOrigin& origin);

}  // namespace foldproof
