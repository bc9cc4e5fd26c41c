// Checks of meshes. One function per file; the list of all is verification/checks.cpp.
#pragma once

#include <vector>

#include "verification/verdict.h"

namespace foldproof {

std::vector<Check> mesh_checks();            // meshes built from triangles
std::vector<Check> mesh_rejection_checks();  // meshes that are refused
std::vector<Check> seam_checks();            // panels that are sewn together
std::vector<Check> split_fan_checks();       // vertices of several fans that are split

}  // namespace foldproof
