// The studies of this room: how large are distances wrong, and what do they cost?
#pragma once

#include "convergence/study.h"

namespace foldproof {

Study octree_memory_study();       // octree-memory: an octree against a grid of the same error
Study level_sets_in_time_study();  // level-sets-in-time: between two frames of a body that deforms
Study level_set_cache_study();     // level-set-cache: level sets computed once for many runs
// level-set-resolution: distance and normals of grids against their spacing
Study level_set_resolution_study();
Study sharp_edges_study();  // sharp-edges: normals of samples next to a body's edges

}  // namespace foldproof
