// The displacements that a sheet's rest is sought over, and the energy's Hessian over them.
#pragma once

#include <Eigen/SparseCholesky>
#include <array>
#include <vector>

#include "verification/specimens/probe.h"

namespace foldproof {

using SparseMatrix = Eigen::SparseMatrix<double>;
using SparseFactors = Eigen::SimplicialLDLT<SparseMatrix>;

/// A coordinate of a particle moves by `by` times an unknown.
struct Freedom {
  int unknown = -1;  // -1: held
  double by = 1;     // 1
};

struct Freedoms {
  std::vector<std::array<Freedom, 3>> of;  // of each particle, along x, y, z
  std::vector<double> share;  // of the force on each particle, that counts; 0 for images of others
  int count = 0;              // of unknowns

  /// Forces against the unknowns.
  Eigen::VectorXd gather(const PerParticle3& forces) const;

  PerParticle3 moved(PerParticle3 x, const Eigen::VectorXd& by) const;
};

/// All coordinates of the particles that the scene does not prescribe.
Freedoms freedoms_of(const Scene& scene);

/// The derivative of the energy's gradient by the unknowns. It is the reference's.
class Hessian {
 public:
  Hessian(const Scene& scene, const Freedoms& freedoms);

  /// Plus `mass_over` [1/s^2] times the masses.
  SparseMatrix at(const PerParticle3& x, Definiteness definiteness, double mass_over) const;

 private:
  System system_;
  const Freedoms& freedoms_;
  PerParticle mass_;
};

bool positive_pivots(const SparseFactors& factors);

/// What a sheet settles under.
struct Settling {
  const Probe& probe;
  const Hessian& hessian;
  const Freedoms& freedoms;
  Eigen::VectorXd load;   // on the unknowns, besides the sheet's own forces
  Eigen::VectorXd scale;  // of a force on each unknown
  double tolerance = 0;   // of a force over its scale [1]
  double longest = 0;     // displacement of a step [m]
};

struct Settled {
  PerParticle3 x;
  double unbalanced = 0;  // largest force on an unknown over its scale [1]
  int steps = 0;
};

/// Follows the forces from x, without inertia: steps of backward Euler that forget their velocity,
/// no longer than `longest`, which grow to Newton's. Unfinished after 600 steps.
Settled settle(const Settling& settling, PerParticle3 x);

struct Equilibrium {
  PerParticle3 x;     // 3 x N [m]
  double unbalanced;  // largest force on a free particle, over its weight [1]
  int steps;
  // all pivots of the energy's Hessian are positive: a minimum; a turn about the vertical, which
  // costs a sheet that hangs from one particle nothing, does not count
  bool stable;
};

/// Follows the forces from the scene's start, without inertia: steps of backward Euler that forget
/// their velocity, no longer than twice the mesh's smallest height, which grow to Newton's. Forces
/// are the subject's; their derivative is the reference's, and decides the way and the stability
/// only. Unfinished after 600 steps. The scene has gravity, and no objects, limits or damping.
Equilibrium equilibrium_of(const Subject& subject, const Scene& scene);

/// A flat sheet of equilateral triangles of this edge [m], with rows along x, whose mesh has the
/// rigidity D [J] and whose springs have Young's modulus Y [N/m]. Its density, 0.2 kg/m^2, only
/// sets the pace of a search for rest.
Scene equilateral_sheet(double rigidity, double young, double edge, int columns, int rows);

}  // namespace foldproof
