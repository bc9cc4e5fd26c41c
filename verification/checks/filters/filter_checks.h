// Checks of what corrects velocities: objects, cloth itself, strain limits. A function a file; the
// list of all is verification/checks.cpp.
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
std::vector<Check> impulse_checks();          // what impulses permit, leave alone and conserve
std::vector<Check> crossing_checks();         // how near two features of a cloth are
std::vector<Check> strain_limit_checks();     // one correction
std::vector<Check> strain_step_checks();      // steps, sweeps, colours, case files

}  // namespace foldproof
