#include "verification/specimens/random.h"

#include <cmath>

namespace foldproof {

double Random::log_uniform(double low, double high) {
  return std::exp(uniform(std::log(low), std::log(high)));
}

PerParticle3 Random::vectors(Eigen::Index count, double size) {
  PerParticle3 result(3, count);
  for (double& component : result.reshaped()) component = uniform(-size, size);
  return result;
}

}  // namespace foldproof
