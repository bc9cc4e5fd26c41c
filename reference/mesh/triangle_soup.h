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

}  // namespace foldproof
