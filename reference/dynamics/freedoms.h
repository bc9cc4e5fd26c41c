// The displacements over which a rest is sought, and the energy's Hessian over them.
#pragma once

#include <Eigen/SparseCholesky>
#include <array>
#include <span>
#include <vector>

#include "reference/dynamics/system.h"
#include "reference/forces/force_differential.h"

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

/// All coordinates of the particles that the system does not prescribe.
Freedoms freedoms_of(const System& system);

/// A stiffness between two particles that is not an elastic one: of a contact.
struct AddedStiffness {
  int a, b;
  Eigen::Matrix3d block;  // of the energy's Hessian at (a, b) [N/m]
};

/// The derivative of the energy's gradient by the unknowns. The freedoms must outlive it.
class Hessian {
 public:
  Hessian(const System& system, const Freedoms& freedoms)
      : forces_(system.forces), mass_(system.mass), freedoms_(freedoms) {}

  /// At a state, plus `mass_over` [1/s^2] times the masses, and what is added.
  SparseMatrix at(const State& s, Definiteness definiteness, double mass_over,
                  std::span<const AddedStiffness> added = {}) const;

 private:
  std::vector<Force> forces_;
  PerParticle mass_;
  const Freedoms& freedoms_;
};

bool positive_pivots(const SparseFactors& factors);

/// A vibration: the square of its angular frequency [1/s^2], and its shape.
struct Mode {
  double eigenvalue = 0;
  Eigen::VectorXd shape = {};
};

/// The smallest eigenvalue of K u = lambda M u, M the positive diagonal of `mass`, and its u: below
/// 0 at a saddle. By inverse iteration; the shift below the spectrum is found by the pivots' signs
/// (Sylvester's law of inertia). Relative error about 1e-6 of the largest of |lambda| and `scale`
/// [1/s^2] > 0.
Mode slowest_mode(const SparseMatrix& K, const Eigen::VectorXd& mass, double scale);

}  // namespace foldproof
