// For tests of forces: numbers without a pattern, a comparison, and bounds at a state.
#pragma once

#include <cmath>

#include "reference/forces/force.h"

namespace foldproof {

/// 3 x n numbers between -1 and 1, others for each seed.
inline PerParticle3 scattered(int n, double seed) {
  PerParticle3 numbers(3, n);
  for (Eigen::Index k = 0; k < numbers.size(); ++k)
    numbers.data()[k] = std::sin(seed + 7.3 * double(k) + 0.9 * double(k * k));
  return numbers;
}

/// Whether two matrices differ by at most this fraction of the second.
template <class One, class Other>
bool agree(const One& one, const Other& other, double fraction) {
  return (one - other).norm() <= fraction * other.norm();
}

/// Of a force that has shapes.
template <class F>
void add_stiffness_bound(const F& force, const State& s, PerParticle& rows) {
  force.add_stiffness_bound(s, force.shapes_at(s.x), rows);
}

}  // namespace foldproof
