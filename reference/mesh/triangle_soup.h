// Triangles without connectivity.
#pragma once

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

}  // namespace foldproof
