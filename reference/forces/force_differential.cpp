#include "reference/forces/force_differential.h"

#include <Eigen/Eigenvalues>

namespace foldproof {

namespace {

void add_pairs(const std::vector<PairStiffness>& pairs, const PerParticle3& dx, PerParticle3& df) {
  for (const PairStiffness& p : pairs) {
    const Vector3 change = p.block * (dx.col(p.b) - dx.col(p.a));
    df.col(p.b) += change;
    df.col(p.a) -= change;
  }
}

void add_hinges(const std::vector<HingeStiffness>& hinges, const PerParticle3& dx, PerParticle3& df) {
  for (const HingeStiffness& h : hinges) {
    Vector12 moved;
    for (int k = 0; k < 4; ++k) moved.segment<3>(3 * k) = dx.col(h.particles[size_t(k)]);
    const Vector12 change =
        h.block.lazyProduct(moved);  // in place: Eigen's general product is for larger matrices
    for (int k = 0; k < 4; ++k) df.col(h.particles[size_t(k)]) += change.segment<3>(3 * k);
  }
}

}  // namespace

void ForceDifferential::add_product(const PerParticle3& dx, PerParticle3& df) const {
  add_pairs(pairs, dx, df);
  add_hinges(hinges, dx, df);
  for (const auto& add : custom) add(dx, df);
}

Matrix12 negative_part(const Matrix12& matrix) {
  const Eigen::SelfAdjointEigenSolver<Matrix12> modes(matrix);
  const Vector12 kept = modes.eigenvalues().cwiseMin(0.0);
  return modes.eigenvectors() * kept.asDiagonal() * modes.eigenvectors().transpose();
}

}  // namespace foldproof
