#include "reference/forces/force_differential.h"

#include "reference/forces/symmetric_modes.h"

namespace foldproof {

namespace {

void add_pairs(const std::vector<PairStiffness>& pairs, const PerParticle3& dx, PerParticle3& df) {
  for (const PairStiffness& p : pairs) {
    const Vector3 change = p.block * (dx.col(p.b) - dx.col(p.a));
    df.col(p.b) += change;
    df.col(p.a) -= change;
  }
}

void add_hinges(const std::vector<HingeStiffness>& hinges, const PerParticle3& dx,
                PerParticle3& df) {
  for (const HingeStiffness& h : hinges) {
    Vector12 moved;
    for (int k = 0; k < 4; ++k) moved.segment<3>(3 * k) = dx.col(h.particles[size_t(k)]);
    // in place: Eigen's general product is made for larger matrices
    const Vector12 change = h.block.lazyProduct(moved);
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
  const SymmetricModes modes = symmetric_modes(matrix);
  const Eigen::Index negative = (modes.values.array() < 0).count();  // the first: they ascend
  Matrix12 kept = Matrix12::Zero();
  for (Eigen::Index k = 0; k < negative; ++k) {
    const Vector12 mode = modes.vectors.col(k);
    kept += modes.values[k] * mode * mode.transpose();
  }
  return kept;
}

}  // namespace foldproof
