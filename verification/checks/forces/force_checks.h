// Checks of forces: gravity, springs, bending, sticking. One function per file; the list of all is
// verification/checks.cpp.
#pragma once

#include <vector>

#include "verification/verdict.h"

namespace foldproof {

// gravity, properties of all forces, bounds on stiffness
std::vector<Check> force_checks();
std::vector<Check> spring_checks();               // springs
std::vector<Check> bending_checks();              // forces, momentum (BMF03 section 4)
std::vector<Check> bending_mode_checks();         // the twelve motions of a hinge
std::vector<Check> buckling_spring_checks();      // Choi and Ko's
std::vector<Check> bending_alternative_checks();  // other models than the paper's
std::vector<Check> bending_angle_checks();        // the angle's sine, extreme and lost shapes
std::vector<Check> bending_energy_checks();       // energies and work around closed paths
std::vector<Check> bending_damping_checks();      // damping
std::vector<Check> bending_shape_checks();        // nonlinear damping, sculpted shapes
std::vector<Check> differential_checks();         // the derivative of the elastic forces
std::vector<Check> force_differential_checks();  // the derivative of all forces at given velocities
std::vector<Check> sticking_force_checks();      // forces against the oracle, conservation
std::vector<Check> sticking_motion_checks();     // carried cloth, and its lag
std::vector<Check> sticking_bond_checks();       // bonds form, break and are stored

}  // namespace foldproof
