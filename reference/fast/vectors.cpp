#include "reference/fast/vectors.h"

namespace foldproof {

namespace {

// Particles per block in the sums of an iteration.
constexpr Eigen::Index block_of_products = 512;

double squared_norm_in_blocks(const Team& team, Eigen::Index block, const PerParticle3& r,
                              const PerParticle& inverse_mass) {
  return sum_of_blocks(team, r.cols(), block, [&](Eigen::Index first, Eigen::Index count) {
    const auto part = r.middleCols(first, count);
    return part.colwise().squaredNorm().dot(inverse_mass.segment(first, count).transpose());
  });
}

}  // namespace

PerParticle3 moved(const Team& team, const PerParticle3& x, double h, const PerParticle3& v) {
  PerParticle3 result;
  set(team, result, x + h * v);
  return result;
}

PerParticle3 kicked(const Team& team, const PerParticle3& v, double s, const PerParticle3& f,
                    const PerParticle& inverse_mass) {
  PerParticle3 result;
  set(team, result, v + s * f * inverse_mass.asDiagonal());
  return result;
}

void clear_prescribed(const PerParticle& inverse_mass, PerParticle3& q) {
  for (Eigen::Index i = 0; i < q.cols(); ++i)
    if (inverse_mass[i] == 0) q.col(i).setZero();
}

double dot(const Team& team, const PerParticle3& p, const PerParticle3& q) {
  const auto of_block = [&](Eigen::Index first, Eigen::Index count) {
    return p.middleCols(first, count).cwiseProduct(q.middleCols(first, count)).sum();
  };
  return sum_of_blocks(team, p.cols(), block_of_products, of_block);
}

double squared_norm(const Team& team, const PerParticle3& r, const PerParticle& inverse_mass) {
  return squared_norm_in_blocks(team, block_of_products, r, inverse_mass);
}

double first_squared_norm(const Team& team, const PerParticle3& r,
                          const PerParticle& inverse_mass) {
  return squared_norm_in_blocks(team, block_of_sums, r, inverse_mass);
}

double squared_momentum(const Team& team, const PerParticle3& v, const PerParticle& mass,
                        const PerParticle& inverse_mass) {
  const auto of_block = [&](Eigen::Index first, Eigen::Index count) {
    double sum = 0;
    for (Eigen::Index i = first; i < first + count; ++i)
      if (inverse_mass[i] != 0) sum += mass[i] * v.col(i).squaredNorm();
    return sum;
  };
  return sum_of_blocks(team, mass.size(), block_of_sums, of_block);
}

}  // namespace foldproof
