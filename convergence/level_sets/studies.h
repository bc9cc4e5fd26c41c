// The studies of this room: how large are distances wrong, and what do they cost?
#pragma once

#include "convergence/study.h"

namespace foldproof {

Study octree_memory();         // octree-memory: an octree against a grid of the same error
Study level_sets_in_time();    // level-sets-in-time: between two frames of a body that deforms
Study level_set_cache();       // level-set-cache: level sets computed once for many runs
Study level_set_resolution();  // level-set-resolution: distance and normals of grids against their spacing
Study sharp_edges();           // sharp-edges: normals of samples next to a body's edges

}  // namespace foldproof
