#include "reference/forces/gravity.h"

#include "reference/fast/vectors.h"

namespace foldproof {

void Gravity::add_elastic(const State&, PerParticle3& f) const {
  set(team, f, f + acceleration.lazyProduct(mass.transpose()));
}

double Gravity::energy(const State& s) const { return -acceleration.dot(s.x * mass); }

}  // namespace foldproof
