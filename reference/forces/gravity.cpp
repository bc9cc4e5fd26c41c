#include "reference/forces/gravity.h"

namespace foldproof {

void Gravity::add_elastic(const State&, PerParticle3& f) const {
  f += acceleration * mass.transpose();
}

double Gravity::energy(const State& s) const { return -acceleration.dot(s.x * mass); }

}  // namespace foldproof
