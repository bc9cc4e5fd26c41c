#include "reference/forces/sticking.h"

namespace foldproof {

void Sticking::add_elastic(const State&, PerParticle3&) const {
  throw InputError("sticking is not built yet");
}

double Sticking::energy(const State&) const { throw InputError("sticking is not built yet"); }

}  // namespace foldproof
