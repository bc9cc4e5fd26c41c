// Checks of the reference's meshes: what is built of triangles, what is refused. One function a file, and
// their sum.
#pragma once

#include <vector>

#include "verification/verdict.h"

namespace foldproof {

std::vector<Check> mesh_refusal_checks();  // mesh_refusal_checks.cpp

/// Refusals and all other checks of meshes.
std::vector<Check> mesh_checks();

}  // namespace foldproof
