#include "verification/specimens/differences.h"

#include <fmt/format.h>

#include "verification/evidence.h"

namespace foldproof {

double largest_difference(const PerParticle3& a, const PerParticle3& b) {
  Worst worst;
  for (Eigen::Index i = 0; i < a.cols(); ++i) worst.observe((a.col(i) - b.col(i)).norm());
  return worst.value();
}

double count_differing_entries(const PerParticle3& a, const PerParticle3& b) {
  return double((a.array() != b.array()).count());
}

double extent(const PerParticle3& x) {
  const Vector3 low = x.rowwise().minCoeff(), high = x.rowwise().maxCoeff();
  return (high - low).norm() / 2 + (high + low).norm() / 2;
}

std::string smallest_defect(double bound, const std::string& scale) {
  return fmt::format("The smallest defect that this notices is {:.1e} of the {}.", bound * epsilon,
                     scale);
}

double largest_speed(const PerParticle3& v) {
  return largest_difference(v, PerParticle3::Zero(3, v.cols()));
}

}  // namespace foldproof
