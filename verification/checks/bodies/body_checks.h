// Checks of bodies: which meshes are solids, how they are repaired and cached. One function per
// file; the list of all is verification/checks.cpp.
#pragma once

#include <vector>

#include "verification/verdict.h"

namespace foldproof {

std::vector<Check> closed_mesh_checks();  // meshes that are solids
std::vector<Check> repair_checks();       // ray parity, winding numbers, repair
std::vector<Check> mesh_body_checks();    // bodies of case files
std::vector<Check> content_checks();      // keys and validity of cached level sets

}  // namespace foldproof
