// Checks of the bending element (BMF03 section 4). One function a file, and their sum.
#pragma once

#include <vector>

#include "verification/verdict.h"

namespace foldproof {

std::vector<Check> bending_mode_checks();  // bending_mode_checks.cpp: the twelve motions of a hinge
std::vector<Check>
bending_angle_checks();  // bending_angle_checks.cpp: the angle's sine, extreme and lost shapes
std::vector<Check>
bending_energy_checks();  // bending_energy_checks.cpp: energies and work round closed paths
std::vector<Check> bending_damping_checks();  // bending_damping_checks.cpp: damping

std::vector<Check>
bending_alternative_checks();               // bending_alternative_checks.cpp: other models than the paper's
std::vector<Check> bending_shape_checks();  // bending_shape_checks.cpp: nonlinear damping, sculpted shapes

/// All of the above, and those of the forces as a whole.
std::vector<Check> bending_checks();

}  // namespace foldproof
