// Checks of forces: gravity, springs, bending, sticking. A function a file; the list of all is
// verification/checks.cpp.
#pragma once

#include <vector>

#include "verification/verdict.h"

namespace foldproof {

// gravity, what all forces together promise, bounds on stiffness
std::vector<Check> force_checks();
std::vector<Check> spring_checks();               // springs
std::vector<Check> bending_checks();              // forces, momentum (BMF03 section 4)
std::vector<Check> bending_mode_checks();         // the twelve motions of a hinge
std::vector<Check> bending_alternative_checks();  // other models than the paper's
std::vector<Check> bending_angle_checks();        // the angle's sine, extreme and lost shapes
std::vector<Check> bending_energy_checks();       // energies and work round closed paths
std::vector<Check> bending_damping_checks();      // damping
std::vector<Check> bending_shape_checks();        // nonlinear damping, sculpted shapes
std::vector<Check> differential_checks();         // the derivative of the elastic forces
std::vector<Check> force_differential_checks();  // the derivative of all forces at given velocities
std::vector<Check> sticking_force_checks();      // forces against the oracle, what they keep
std::vector<Check> sticking_motion_checks();     // what is carried, and how it lags
std::vector<Check> sticking_bond_checks();       // what forms, breaks and is remembered

}  // namespace foldproof
