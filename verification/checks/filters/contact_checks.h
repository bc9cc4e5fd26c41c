// Checks of cloth against objects. One function a file, and their sum.
#pragma once

#include <vector>

#include "verification/verdict.h"

namespace foldproof {

std::vector<Check> response_checks();         // response_checks.cpp: what one correction does to one point
std::vector<Check> object_response_checks();  // object_response_checks.cpp: the cruder responses
std::vector<Check> pinch_checks();            // pinch_checks.cpp: points between two objects, edges and faces
std::vector<Check> friction_checks();         // friction_checks.cpp: slopes, a belt, a turntable
std::vector<Check> capstan_checks();          // capstan_check.cpp: a strip round a drum
std::vector<Check> object_checks();           // object_checks.cpp: motion of objects, nothing tunnels

/// All of the above, in this order.
std::vector<Check> contact_checks();

}  // namespace foldproof
