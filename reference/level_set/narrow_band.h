// Exact signed distance at the nodes next to a triangle mesh.
#pragma once

#include "reference/fast/team.h"
#include "reference/level_set/fast_marching.h"
#include "reference/level_set/mesh_distance.h"

namespace foldproof {

/// All nodes closer to the mesh than `cells` (at least 1) spacings, with their signed distance as
/// MeshDistance gives it. One cell separates inside from outside; second-order marching needs at
/// least two. Throws InputError for fewer. The same bits for every team.
Seeds narrow_band(const MeshDistance& mesh, const Lattice& lattice, double cells,
                  const Team& team = {});

}  // namespace foldproof
