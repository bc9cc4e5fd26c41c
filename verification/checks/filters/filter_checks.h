// Checks of the velocity filters: objects, self-collision, strain limits. One function per file;
// the list of all is verification/checks.cpp.
#pragma once

#include <vector>

#include "verification/verdict.h"

namespace foldproof {

std::vector<Check> object_checks();           // motion of objects, nothing tunnels
std::vector<Check> response_checks();         // one correction of one point
std::vector<Check> object_response_checks();  // the cruder responses
std::vector<Check> pinch_checks();            // points between two objects, edges and faces
std::vector<Check> friction_checks();         // slopes, a belt, a turntable
std::vector<Check> capstan_checks();          // a strip round a drum
std::vector<Check> repulsion_checks();        // layers within the thickness
std::vector<Check> impact_checks();           // motion without crossings, rigid zones
std::vector<Check> untangling_checks();       // cloth that starts crossing itself
std::vector<Check> impulse_checks();          // impulses: limits, no effect, conservation
std::vector<Check> crossing_checks();         // distance between two features of a cloth
std::vector<Check> strain_limit_checks();     // one correction
std::vector<Check> strain_step_checks();      // steps, sweeps, colours, case files

}  // namespace foldproof
