// A triangle membrane: stretch and shear of the sheet with its own stiffness along warp and weft.
// Not in BMF03, whose springs have the stiffness that the mesh gives them.
#pragma once

#include <vector>

#include "reference/forces/force.h"

namespace foldproof {

/// An orthotropic sheet, forces per length [N/m].
struct MembraneMaterial {
  double warp = 0, weft = 0;  // Young's moduli E1, E2 along warp and weft [N/m]
  double shear = 0;           // G [N/m]
  double poisson = 0;    // nu12: a strip along the warp that is strained by e narrows by nu12 e [1]
  double damping = 0;    // tau: stress of a strain rate over stress of a strain [s]
  double direction = 0;  // of the warp, from the first axis of the pattern or rest plane [rad]
};

/// St. Venant-Kirchhoff: with the rest triangle in its plane, warp along the first axis, F (3 x 2)
/// the derivative of the places by that plane, E = (F^T F - I)/2 and
///   S11 = C11 E11 + C12 E22   C11 = E1/(1 - nu12 nu21)   nu21 = nu12 E2/E1
///   S22 = C12 E11 + C22 E22   C22 = E2/(1 - nu12 nu21)
///   S12 = 2 G E12             C12 = nu12 C22
/// the energy is A/2 S:E and the forces its gradient: P = F S, three per triangle (as in Volino,
/// Magnenat-Thalmann and Faure 2009, A simple approach to nonlinear tensile stiffness, section 3).
/// Damping adds tau times S of dE/dt, linear in v. Energy counts as stretch.
/// of_triangle: M places in the materials; empty: all triangles have the first.
/// Throws InputError for a negative or NaN number, a Poisson ratio that makes C indefinite
/// (nu12 nu21 >= 1), and a mesh that is neither flat nor has a pattern.
CustomForce make_membrane(const TriangleMesh& mesh, const std::vector<MembraneMaterial>& materials,
                          const std::vector<int>& of_triangle = {});

}  // namespace foldproof
