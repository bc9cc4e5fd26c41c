// Checks of what is done to a run afterwards: the fold-preserving projection, smoothing. One
// function per file; the list of all is verification/checks.cpp.
#pragma once

#include <vector>

#include "verification/verdict.h"

namespace foldproof {

std::vector<Check> projection_checks();        // moves of points
std::vector<Check> depth_map_checks();         // maps of depth
std::vector<Check> projection_exact_checks();  // triangles against objects, without rounding
std::vector<Check> projection_cloth_checks();  // pinched and subdivided cloth
std::vector<Check> projection_mesh_checks();   // out of a triangle mesh
std::vector<Check> smooth_cloth_checks();      // smooth surfaces without crossings

}  // namespace foldproof
