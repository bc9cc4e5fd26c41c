// Random numbers, identical on every machine.
#pragma once

#include <random>

#include "reference/types.h"
#include "verification/seeds.h"

namespace foldproof {

/// Uniform numbers, the same on every machine for the same seed and seed shift.
class Random {
 public:
  explicit Random(unsigned seed) : bits_(shifted_seed(seed)) {}

  double uniform(double low, double high) {
    return low + (high - low) * (double(bits_() >> 11) * 0x1p-53);
  }
  double log_uniform(double low, double high);            // uniform in the logarithm; low > 0
  PerParticle3 vectors(Eigen::Index count, double size);  // 3 x count, components in [-size, size]

 private:
  std::mt19937_64 bits_;
};

}  // namespace foldproof
