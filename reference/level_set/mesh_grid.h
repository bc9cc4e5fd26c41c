// The level set of a triangle mesh on a grid, in one call.
#pragma once

#include <memory>

#include "reference/fast/team.h"
#include "reference/level_set/fast_marching.h"
#include "reference/level_set/mesh_distance.h"

namespace foldproof {

/// Layout of a grid around a mesh, and how it is filled.
struct GridMethod {
  int cells;            // along the longest side of the mesh's bounds
  int margin;           // cells around the bounds
  double band;          // cells to each side of the surface with exact values
  MarchingOrder order;  // of the values beyond
};

/// Exact signed distance in the band, fast marching beyond it. The mesh must be closed, see
/// MeshDistance. The same bits for every team.
std::shared_ptr<const Grid> make_grid(const MeshDistance& mesh, const GridMethod& method,
                                      const Team& team = {});

}  // namespace foldproof
