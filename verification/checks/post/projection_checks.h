// Checks of the fold-preserving projection. One function a file, and their sum.
#pragma once

#include <vector>

#include "verification/verdict.h"

namespace foldproof {

std::vector<Check> depth_map_checks();  // depth_map_checks.cpp
std::vector<Check>
projection_exact_checks();  // projection_exact_checks.cpp: triangles against objects, without rounding

std::vector<Check> projection_cloth_checks();  // projection_cloth_checks.cpp: pinched and subdivided cloth
std::vector<Check> projection_mesh_checks();   // projection_mesh_checks.cpp: out of a triangle mesh

/// Maps, moves of points, triangles.
std::vector<Check> projection_checks();

}  // namespace foldproof
