// Checks of level sets: of triangle meshes, on grids. One function a file, and their sum.
#pragma once

#include <vector>

#include "verification/verdict.h"

namespace foldproof {

std::vector<Check> mesh_distance_checks();  // mesh_distance_checks.cpp
std::vector<Check> grid_checks();           // grid_checks.cpp
std::vector<Check> marching_checks();       // marching_checks.cpp
std::vector<Check> closed_mesh_checks();    // closed_mesh_checks.cpp
std::vector<Check> mesh_body_checks();      // mesh_body_checks.cpp: bodies of case files
std::vector<Check> repair_checks();         // repair_checks.cpp: ray parity, winding numbers, repair
std::vector<Check> content_checks();        // content_checks.cpp: keys and soundness of what is kept

/// All of them.
std::vector<Check> level_set_checks();

}  // namespace foldproof
