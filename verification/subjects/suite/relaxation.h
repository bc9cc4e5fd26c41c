// Equilibrium of a scene, whatever the solver's scheme: its motion is stopped again and again.
#pragma once

#include "verification/subjects/suite/trial.h"

namespace foldproof::suite {

/// How a scene comes to rest under its weight.
struct Relaxation {
  PerParticle3 unstrained;  // positions without elastic energy, from which the weight does its work
  double length;            // of what hangs [m]
  double enough;            // two rounds that move it by less end it, over the length [1]
  double glance;            // between two looks at its kinetic energy [s]
  double stored = 0;        // elastic energy of the start, at most [J]
};

struct Relaxed {
  PerParticle3 x;
  double last_move;  // the largest in the last two rounds [m]
  double dt;         // of the steps that were short enough [s]
};

/// Equilibrium by kinetic damping: the motion is stopped whenever its kinetic energy is largest,
/// until two rounds move it little, or 24 times; in shorter steps where it gains energy otherwise.
/// Throws FailedWithoutNumber if the shortest steps that are tried gain energy, too.
Relaxed relaxed(Trial& trial, PortableScene scene, const Relaxation& relaxation);

}  // namespace foldproof::suite
