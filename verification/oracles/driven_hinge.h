#pragma once

#include <functional>
#include <map>

#include "reference/types.h"
#include "verification/oracles/cloth.h"
#include "verification/oracles/definitions.h"

namespace foldproof::oracles {

/// The smallest piece of cloth on which an order study is meaningful: one hinge with springs on its
/// five edges, nonlinear and damped. It is not autonomous once a corner is prescribed or a force
/// depends on time. Corners x1..x4 are particles 0..3; any may be prescribed, the others are free.
struct DrivenHinge {
  // start x [m], v [m/s]; rest corners; ke, kd, theta0 and where their factors are evaluated
  HingeInput hinge;
  // rho, a third of each triangle's rest mass goes to each of its corners [kg/m^2], > 0
  double density = 0;
  double young = 0;                                               // Y [N/m]
  double spring_damping = 0;                                      // kd_s [N s/m]
  Vector3 gravity = Vector3::Zero();                              // [m/s^2]
  std::map<int, Motion> prescribed;                               // by corner 0..3
  std::function<Vector3(int particle, double t)> external_force;  // [N]; empty: none
};

/// Its masses, springs and hinge. Rest lengths and areas are those of the rest corners. A rest
/// triangle without area or a density that is not positive: InputError.
ClothDefinition driven_hinge(const DrivenHinge& problem);

/// The start as y for driven_hinge(problem): free corners' positions, then velocities.
std::vector<double> driven_hinge_start(const DrivenHinge& problem);

}  // namespace foldproof::oracles
