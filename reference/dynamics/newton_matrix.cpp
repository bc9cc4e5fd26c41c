#include "reference/dynamics/newton_matrix.h"

namespace foldproof {

void multiply(const NewtonMatrix& A, const PerParticle3& p, PerParticle3& q, Work& work) {
  PerParticle3 change = PerParticle3::Zero(3, p.cols());
  A.stiffness.add_product(p, change);
  change *= A.s;
  A.damping.add_product(p, change);
  ++work.damping_products, ++work.stiffness_products;
  q = p * A.mass.asDiagonal() - A.s * change;
  for (Eigen::Index i = 0; i < q.cols(); ++i)
    if (A.inverse_mass[i] == 0) q.col(i).setZero();
}

}  // namespace foldproof
