// Sheets of a subject's forces at rest, by the way of `foldproof settle`.
#pragma once

#include "reference/dynamics/settle.h"
#include "verification/specimens/probe.h"

namespace foldproof {

/// What a sheet settles under.
struct SheetSettling {
  const Probe& probe;
  const Hessian& hessian;
  const Freedoms& freedoms;
  Eigen::VectorXd load;   // on the unknowns, besides the sheet's own forces
  Eigen::VectorXd scale;  // of a force on each unknown
  double tolerance = 0;   // of a force over its scale [1]
  double longest = 0;     // displacement of a step [m]
};

/// By settle() of dynamics/settle.h. Unfinished after 600 steps.
Settled settle(const SheetSettling& settling, PerParticle3 x);

struct Equilibrium {
  PerParticle3 x;     // 3 x N [m]
  double unbalanced;  // largest force on a free particle, over its weight [1]
  int steps;
  // all pivots of the energy's Hessian are positive: a minimum; a turn about the vertical, which
  // costs a sheet that hangs from one particle nothing, does not count
  bool stable;
};

/// Follows the forces from the scene's start, in steps no longer than twice the mesh's smallest
/// height. Forces are the subject's; their derivative is the reference's, and decides the way and
/// the stability only. Unfinished after 600 steps. The scene has gravity, and no objects, limits or
/// damping.
Equilibrium equilibrium_of(const Subject& subject, const Scene& scene);

/// A flat sheet of equilateral triangles of this edge [m], with rows along x, whose mesh has the
/// rigidity D [J] and whose springs have Young's modulus Y [N/m]. Its density, 0.2 kg/m^2, only
/// sets the pace of a search for rest.
Scene equilateral_sheet(double rigidity, double young, double edge, int columns, int rows);

}  // namespace foldproof
