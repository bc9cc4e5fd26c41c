// Cloth against itself (BMF03 section 5, after Bridson, Fedkiw and Anderson 2002).
#pragma once

#include "reference/filters/cloth_pairs.h"
#include "reference/level_set/object.h"
#include "reference/types.h"

namespace foldproof {

/// How cloth is kept from itself. The case names it, or it costs nothing.
struct SelfCollisionSettings {
  double thickness = 0;  // s: layers nearer than this push each other apart [m], > 0
  double stiffness = 0;  // k: of that push, per pair of features and metre of overlap [N/m]
  double friction = 0;   // mu, Coulomb's coefficient between layers [1]
  int rounds = 8;        // of impulses against crossings, before colliding parts move as rigid zones
  bool untangle = true;  // a start that crosses itself is run, and said to do so; false: it is refused
};

/// The filter. It comes last: objects first, then cloth against itself.
struct SelfCollision {
  SelfCollisionSettings settings;
  ClothTree tree;
  PerParticle inverse_mass;  // N [1/kg], 0 for prescribed particles

  void correct(const Span& span, const State& s, PerParticle3& v, Work& work) const;
};

}  // namespace foldproof
