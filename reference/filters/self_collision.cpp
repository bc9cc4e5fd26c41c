#include "reference/filters/self_collision.h"

namespace foldproof {

void SelfCollision::correct(const Span&, const State&, PerParticle3&, Work&) const {
  throw InputError("self-collision is not built yet");
}

}  // namespace foldproof
