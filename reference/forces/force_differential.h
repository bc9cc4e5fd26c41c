// The derivative of the forces with respect to the positions at one state, dF = K dx, for the
// methods that are implicit in the elastic forces too. The paper's own schemes never need it. K is
// symmetric where the forces derive from an energy; damping forces at given velocities, and bending
// with current weighting, do not.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "reference/types.h"

namespace foldproof {

/// exact: the derivative itself, indefinite where an element is compressed or folded the wrong way.
/// semidefinite: each element's matrix with its positive eigenvalues set to zero, so that -K is
/// positive semidefinite (Teran et al. 2005, section 6). Exact for elements that already are.
enum class Definiteness { exact, semidefinite };

using Vector12 = Eigen::Matrix<double, 12, 1>;
using Matrix12 = Eigen::Matrix<double, 12, 12>;

/// A spring: dF_b = block (dx_b - dx_a), dF_a = -dF_b.
struct PairStiffness {
  int a, b;
  Eigen::Matrix3d block;  // [N/m]
};

/// A hinge: its four particles' forces against their displacements, three rows and
/// columns per particle.
struct HingeStiffness {
  std::array<int, 4> particles;
  Matrix12 block;  // [N/m]
};

struct ForceDifferential {
  std::vector<PairStiffness> pairs;
  std::vector<HingeStiffness> hinges;
  std::vector<std::function<void(const PerParticle3& dx, PerParticle3& df)>> custom;
  bool symmetric = true;  // false if any block is unsymmetric

  /// df += K dx; both 3 x N, dx in m, df in N.
  void add_product(const PerParticle3& dx, PerParticle3& df) const;
};

/// The symmetric matrix with its positive eigenvalues set to zero.
Matrix12 negative_part(const Matrix12& matrix);

}  // namespace foldproof
