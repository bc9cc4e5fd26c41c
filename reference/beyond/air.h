// Drag of the air on cloth. Not in BMF03: the usual quadratic law, triangle by triangle.
#pragma once

#include <vector>

#include "reference/forces/force.h"

namespace foldproof {

/// Still air, or a constant wind. Without added mass: the air that a broad sheet of light cloth
/// carries along may weigh several times the cloth, so that free fall of real cloth is too fast.
struct Air {
  double density = 1.2;            // rho [kg/m^3]
  Vector3 wind = Vector3::Zero();  // w [m/s]
  // C_n of a flow along the normal, over the triangle's area; a disc's is 1.17 (Hoerner,
  // Fluid-Dynamic Drag, 1965, 3-16) [1]
  double normal_drag = 1.17;
  double tangential_drag = 0.02;  // C_t of a flow along the surface, both faces together [1]
};

/// With u the velocity of the air relative to the triangle's centre, u_n and u_t its parts along
/// the normal and in the plane, A the triangle's present area [m^2]:
///   F = rho A/2 (C_n |u_n| u_n + C_t |u_t| u_t),
/// a third at each corner: linear and angular momentum change as by F at the centre. Written as
/// F = c (w - v) with the factors c of the velocity at which it is asked, so that it enters schemes
/// A, B and C as a damping force that is linear in v, with a symmetric matrix. Their order needs a
/// velocity for those factors that is extrapolated to the end of the step (CustomForce).
/// Throws InputError for a negative or NaN number.
CustomForce make_air(std::vector<Triangle> triangles, const Air& air);

}  // namespace foldproof
