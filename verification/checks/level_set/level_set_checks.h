// Checks of level sets: exact distances, grids, octrees, bodies that deform. One function per file;
// the list of all is verification/checks.cpp.
#pragma once

#include <vector>

#include "verification/verdict.h"

namespace foldproof {

std::vector<Check> mesh_distance_checks();     // the exact distance to a mesh
std::vector<Check> grid_checks();              // values between nodes
std::vector<Check> marching_checks();          // fast marching
std::vector<Check> octree_checks();            // adaptively sampled distance of one body
std::vector<Check> octree_union_checks();      // several bodies on one tree
std::vector<Check> deforming_checks();         // level sets at frames and between them
std::vector<Check> level_set_thread_checks();  // level sets made on several threads

}  // namespace foldproof
