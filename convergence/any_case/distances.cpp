#include "convergence/any_case/distances.h"

#include <algorithm>
#include <cmath>

#include "verification/evidence.h"

namespace foldproof {

double longest_side(const PerParticle3& x) {
  return (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).maxCoeff();
}

double mean_square_root(const PerParticle3& u, const PerParticle& mass) {
  const Eigen::VectorXd squares = u.colwise().squaredNorm().transpose();
  return std::sqrt(squares.dot(mass.matrix()) / mass.sum());
}

double largest_difference(const std::vector<PerParticle3>& a, const std::vector<PerParticle3>& b,
                          const PerParticle& mass) {
  Worst worst;
  for (size_t k = 0; k < std::min(a.size(), b.size()); ++k)
    worst.observe(mean_square_root(a[k] - b[k], mass));
  return worst.value();
}

double largest_motion(const std::vector<PerParticle3>& x, const PerParticle& mass) {
  Worst worst;
  for (const PerParticle3& frame : x) worst.observe(mean_square_root(frame - x.front(), mass));
  return worst.value();
}

}  // namespace foldproof
