#include "reference/filters/strain_limit.h"

namespace foldproof {

void StrainLimiter::correct(const Span&, const State&, PerParticle3&, Work&) const {
  throw InputError("strain limits are not built yet");
}

}  // namespace foldproof
