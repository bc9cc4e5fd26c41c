// Matrix-free Newton matrix for the methods that are implicit in the elastic forces too.
#pragma once

#include "reference/forces/damping.h"
#include "reference/forces/force_differential.h"
#include "reference/types.h"

namespace foldproof {

/// M - s D - s^2 K, K the derivative of the forces with respect to the
/// positions. Symmetric if K is.
struct NewtonMatrix {
  const PerParticle& mass;          // N [kg]
  const PerParticle& inverse_mass;  // N [1/kg], 0 for prescribed particles
  const DampingOperator& damping;
  const ForceDifferential& stiffness;
  double s;  // the fraction of the step that multiplies the rate [s]
};

/// q = A p at free particles, 0 at prescribed ones; both 3 x N. Counts one product with D
/// and one with K.
void multiply(const NewtonMatrix& A, const PerParticle3& p, PerParticle3& q, Work& work);

}  // namespace foldproof
